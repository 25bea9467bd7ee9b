// SPDX-License-Identifier: MIT
/// `catena tradeoff SCENE`: the discretization error, the Pareto front, the choice of a setting, interleaved timing, the report, and
/// the command.

#include <cmath>
#include <filesystem>
#include <map>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/haptics/streamline.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "engine/app/tuning/measure/timing.h"
#include "engine/app/tuning/measure/workload.h"
#include "engine/app/tuning/report/report.h"
#include "engine/base/json.h"
#include "engine/field/analytic/analytic.h"
#include "engine/geometry/flow/curve.h"
#include "render/quality/refinement.h"
#include "tests/engine/app/program_runs.h"
#include "tests/support/results.h"

namespace tradeoff_measure_test {

using namespace catena;
using namespace catena::app::tuning;
using test::has;
using test::Table;

double squared_difference(double a, double b) { return (a - b) * (a - b); }
double squared_difference(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

/// The root mean square of grid - formula on a lattice that coincides with no voxels.
template <class Grid, class Formula>
double true_error(const Grid& grid, const Formula& formula) {
  field::Cursor a, b;
  const field::Box& box = grid.index_box();
  double sum = 0, count = 0;
  for (double z = box.lo.z + 0.21; z < box.hi.z; z += 1.37)
    for (double y = box.lo.y + 0.13; y < box.hi.y; y += 1.37)
      for (double x = box.lo.x + 0.17; x < box.hi.x; x += 1.37) {
        const Vec3 p = grid.mapping().world_from_index({x, y, z});
        sum += squared_difference(grid.sample(p, a).value, formula.sample(p, b).value);
        ++count;
      }
  return std::sqrt(sum / count);
}

/// `estimate` of a formula's grid with linear and with cubic interpolation.
template <class Formula, class Estimate>
void expect_within_a_factor_of_two(const Formula& formula, const Estimate& estimate) {
  const auto grid = field::sample_on_grid(formula, 41, -2, 2);
  for (const auto& read : {grid, grid->as_cubic().value()}) {
    SCOPED_TRACE(read == grid ? "linear" : "cubic");
    const auto floor = test::value_of(estimate(read));
    const double truth = true_error(*read, formula);
    EXPECT_GT(floor.at_h.error, truth / 2);
    EXPECT_LT(floor.at_h.error, truth * 2);
    EXPECT_GT(floor.at_4h, floor.at_2h);
  }
}

TEST(TradeoffDiscretizationError, IsWithinAFactorOfTwoForScalarAndVectorFormulas) {
  for (const char* name : {"gaussian", "torus", "tanh", "sphere", "lamb-oseen", "abc"}) {
    SCOPED_TRACE(name);
    const auto formula = field::make_analytic(name);
    ASSERT_TRUE(formula);
    if (formula->scalar)
      expect_within_a_factor_of_two(*formula->scalar, [](const auto& read) { return estimate_interpolation_error({read, nullptr}); });
    else
      expect_within_a_factor_of_two(*formula->vector, [](const auto& read) { return estimate_interpolation_error({nullptr, read}); });
  }
}

/// The distance of a streamline from that of the formula, estimated from the grid alone by differences of streamlines.
TEST(TradeoffDiscretizationError, IsWithinAFactorOfTwoForAStreamline) {
  const auto formula = field::make_analytic("abc");
  ASSERT_TRUE(formula);
  const auto grid = field::sample_on_grid(*formula->vector, 65, -2, 2);
  const auto levels = make_resolution_levels(*grid);
  ASSERT_TRUE(levels);
  const Vec3 seed(0.3, 0.2, -0.4);
  const auto far = [&](const field::VectorField& field, const field::VectorField& from) {
    const auto line = flow::trace({&field, false, 0}, seed, {.length = 1}), truth = flow::trace({&from, false, 0}, seed, {.length = 1.1});
    EXPECT_TRUE(line && truth);
    const flow::NearestOnCurve nearest(*truth);
    double max_distance2 = 0;
    for (double s = -1; s <= 1; s += 0.01) max_distance2 = std::max(max_distance2, nearest.find((*line)->position(s)).distance2);
    return std::sqrt(max_distance2);
  };
  const double truth = far(*levels->grids[0], *formula->vector);
  const ExtrapolatedError e =
      extrapolate_from_differences(far(*levels->grids[1], *levels->grids[0]), far(*levels->grids[2], *levels->grids[0]));
  EXPECT_GT(e.error, truth / 2);
  EXPECT_LT(e.error, truth * 2);
  EXPECT_NEAR(e.order, 2, 0.7);
  EXPECT_TRUE(e.is_converged);
}

Point made(double error, double time, double spread = 0.01) {
  Point p;
  p.error = error;
  p.time = {time, time - spread, time + spread, 9};
  return p;
}

Curve choose(std::vector<Point> points, double discretization_error = kNotMeasured, double reference_error = kNotMeasured,
             int current = -1) {
  Curve curve;
  curve.points = std::move(points);
  curve.discretization_error = discretization_error;
  curve.reference_error = reference_error;
  curve.current = current;
  choose_setting(curve);
  return curve;
}

TEST(TradeoffDiscretizationError, ReportsDifferencesThatDoNotConverge) {
  const ExtrapolatedError e = extrapolate_from_differences(3, 3.5);
  EXPECT_FALSE(e.is_converged);
  EXPECT_DOUBLE_EQ(e.error, 1);  // with order 2, a lower bound
  EXPECT_DOUBLE_EQ(extrapolate_from_differences(3, 15).error, 1);
  EXPECT_DOUBLE_EQ(extrapolate_from_errors(4, 16).error, 1);
  EXPECT_EQ(describe_order(e).rfind("at least 1: a third of the difference with every 2nd voxel", 0), 0u) << describe_order(e);
  Curve curve = choose({made(8, 1), made(2, 5), made(0.9, 10), made(0.1, 20)}, 1);
  curve.discretization_error_name += ", at least";
  choose_setting(curve);
  EXPECT_TRUE(has(curve.choice_reason, "is not above the discretization error, at least 1;"));
}

TEST(TradeoffDiscretizationError, CoarserGridsHaveTheSameDomain) {
  const auto formula = field::make_analytic("linear");
  ASSERT_TRUE(formula);
  const auto grid = field::sample_on_grid(*formula->scalar, 20, -2, 2);
  const auto levels = test::value_of(make_resolution_levels(*grid));
  for (const auto& level : levels.grids) {
    EXPECT_LT(max_abs(level->world_bounds().lo - levels.grids[0]->world_bounds().lo), 1e-12);
    EXPECT_LT(max_abs(level->world_bounds().hi - levels.grids[0]->world_bounds().hi), 1e-12);
    EXPECT_LT(true_error(*level, *formula->scalar), 1e-6);
  }
  EXPECT_EQ(levels.grids[2]->index_box().hi.x, 4);
  EXPECT_FALSE(make_resolution_levels(*field::sample_on_grid(*formula->scalar, 8, -2, 2)));
}

TEST(TradeoffParetoChoice, TheFrontHasTheNonDominatedPoints) {
  const std::vector<Point> points{made(1, 10), made(5, 2), made(5, 3), made(7, 4), made(0.5, 30), made(kNotMeasured, 0.1), made(1, 11)};
  EXPECT_EQ(pareto_front(points, CostKind::time), (std::vector<int>{1, 0, 4}));
  EXPECT_TRUE(pareto_front({}, CostKind::time).empty());
}

TEST(TradeoffParetoChoice, TakesTheCheapestBelowTheDiscretizationError) {
  const std::vector<Point> points{made(8, 1), made(2, 5), made(0.9, 10), made(0.1, 20)};
  EXPECT_EQ(choose(points, 1).chosen, 2);
  const Curve curve = choose(points, 1, 3);  // errors below the reference's error do not count
  EXPECT_EQ(curve.chosen, 1);
  EXPECT_TRUE(has(curve.choice_reason, "the error of the reference"));
  EXPECT_TRUE(has(choose(points, 0.01).choice_reason, "No setting reaches"));
}

TEST(TradeoffParetoChoice, ErrorsBelowTheReferencesAreEqual) {
  const Curve unresolved = choose({made(100, 1), made(0.5, 1.5), made(0.2, 100)}, kNotMeasured, 1);
  EXPECT_EQ(unresolved.chosen, 1);
  EXPECT_EQ(unresolved.front, (std::vector<int>{0, 1})) << "what costs more shows nothing";
  EXPECT_TRUE(has(unresolved.choice_reason, "not above the error of the reference, 1;"));
  // Ratios of errors below the reference's error are not reported.
  const Curve ratios = choose({made(100, 1), made(2, 1.5), made(0.01, 100)}, kNotMeasured, 1);
  EXPECT_EQ(ratios.chosen, 1);
  EXPECT_TRUE(has(ratios.choice_reason, "has 2 times less error. Errors below 1 cannot be resolved."));
  // With all errors below the reference's, the scene's setting is kept.
  const Curve flat = choose({made(0.1, 2), made(0.9, 2), made(0.4, 2)}, kNotMeasured, 1, 1);
  EXPECT_EQ(flat.chosen, 1);
  EXPECT_TRUE(flat.is_flat);
  EXPECT_TRUE(has(flat.choice_reason, "No setting has a larger error than the error of the reference, 1"));
}

TEST(TradeoffParetoChoice, TheReasonForBytesDoesNotSayCheap) {
  Curve curve;
  curve.cost = CostKind::bytes;
  curve.points = {made(8, 1), made(0.9, 1), made(0.1, 1)};
  for (std::size_t i = 0; i < 3; ++i) curve.points[i].bytes = 100.0 * double(i + 1);
  curve.discretization_error = 1;
  choose_setting(curve);
  EXPECT_EQ(curve.chosen, 1);
  EXPECT_TRUE(has(curve.choice_reason, "fewest bytes"));
  EXPECT_EQ(curve.choice_reason.find("cheap"), std::string::npos) << curve.choice_reason;
}

TEST(TradeoffParetoChoice, ReasonsHaveNumbersInTheFormatOfScenes) { EXPECT_TRUE(has(choose({made(1.5e-6, 1)}).choice_reason, " 1.5e-6.")); }

/// The advice names keys that must be removed because a scene cannot have them together with the setting.
TEST(TradeoffAdvice, NamesTheKeysToReplace) {
  const auto advice = [](const std::string& text, const std::string& words) -> std::string {
    auto node = json::parse(text, "s.json");
    EXPECT_TRUE(node);
    const NamedLink link{"curve", *node};
    for (const StreamlineSetting& s : streamline_settings(link.node))
      if (s.label == words) return s.config_text(link);
    return "none";
  };
  EXPECT_EQ(advice("{}", "selected"), "\"follow\": \"selected\"");
  EXPECT_EQ(advice(R"({"method": "rkf34", "tolerance": 2e-6})", "selected"),
            "`\"follow\": \"selected\"` in place of `\"method\"` and `\"tolerance\"` in the link \"curve\"");
  EXPECT_EQ(advice(R"({"method": "rk4"})", "selected"), "`\"follow\": \"selected\"` in place of `\"method\"` in the link \"curve\"");
  EXPECT_EQ(advice(R"({"follow": "selected"})", "rk4"), "`\"method\": \"rk4\"` in place of `\"follow\"` in the link \"curve\"");
  EXPECT_EQ(advice(R"({"method": "rk4"})", "rk3"), "\"method\": \"rk3\"");
  EXPECT_EQ(advice(R"({"tolerance": 2e-6})", "rkf34, tolerance 2e-6"), "\"method\": \"rkf34\", \"tolerance\": 2e-6");
}

TEST(TradeoffParetoChoice, EqualTimesWithinNoiseAreDecidedByWork) {
  std::vector<Point> points{made(0.5, 10, 2), made(0.4, 9.5, 2), made(0.3, 10.5, 2)};
  for (std::size_t i = 0; i < 3; ++i) points[i].work = i == 2 ? 7 : 8;
  EXPECT_EQ(choose(points, 1).chosen, 2);
}

TEST(TradeoffParetoChoice, TakesTheKneeOrTheScenesSetting) {
  const Curve knee = choose({made(100, 1), made(1, 1.5), made(0.5, 100)});
  EXPECT_EQ(knee.chosen, 1);
  // The reason compares the knee with both neighbors.
  EXPECT_TRUE(has(knee.choice_reason, "costs 1.5 times less and has 1e+02 times the error"));
  EXPECT_TRUE(has(knee.choice_reason, "costs 67 times as much and has 2 times less error"));
  // A straight line has no knee.
  EXPECT_EQ(choose({made(8, 1), made(4, 2), made(2, 4), made(1, 8)}, kNotMeasured, kNotMeasured, 2).chosen, 2);
  const Curve equal = choose({made(0, 1), made(0, 2)});
  EXPECT_EQ(equal.chosen, 0);
  EXPECT_TRUE(has(equal.choice_reason, "No setting changes"));
}

TEST(TradeoffTiming, ALateRunHasFewerRepeats) {
  const Effort& whole = select_effort("quick");
  EXPECT_EQ(reduce_if_late(whole, 0, 0).rendering_s, whole.rendering_s);
  EXPECT_EQ(reduce_if_late(whole, 0.4 * whole.total_s, 0.5).rendering_s, whole.rendering_s) << "early";
  EXPECT_NEAR(reduce_if_late(whole, 0.75 * whole.total_s, 0.5).rendering_s, 0.5 * whole.rendering_s, 1e-9);
  EXPECT_NEAR(reduce_if_late(whole, 0.75 * whole.total_s, 0.5).haptics_s, 0.5 * whole.haptics_s, 1e-9);
  EXPECT_GT(reduce_if_late(whole, 9 * whole.total_s, 0.9).rendering_s, 0) << "each is measured at least";
  EXPECT_LT(reduce_if_late(whole, 9 * whole.total_s, 0.9).rendering_s, 0.1 * whole.rendering_s);
}

TEST(TradeoffTiming, InterleavesTheSettings) {
  std::string order;
  const auto times = test::value_of(time_interleaved(
      {[&]() -> Result<double> { return order += 'a', 1.0; }, [&]() -> Result<double> { return order += 'b', 2.0; }}, 1000, 3));
  EXPECT_EQ(order, "abbaabba");  // the first round is a warm-up
  EXPECT_EQ((times)[1].median, 2);
  EXPECT_EQ((times)[0].repeats, 3);
  const Timing t = compute_timing({5, 1, 4, 2, 3});
  EXPECT_EQ(t.lower_quartile, 2);
  EXPECT_EQ(t.median, 3);
  EXPECT_EQ(t.upper_quartile, 4);
  EXPECT_FALSE(time_interleaved({[]() -> Result<double> { return Error{"no"}; }}, 0, 3));
}

TEST(TradeoffTiming, ChangedResourcesNeedAWarmUp) {
  render::FramePacket packet;
  packet.width = 64, packet.height = 48;
  const auto after = [&](const render::RenderSettings& before, const render::RenderSettings& now) {
    return needs_warmup({before, 64, 48}, packet, now);
  };
  const render::RenderSettings exact = render::exact_level(1), fast = render::fast_level(1, 1, 0, -1);
  EXPECT_TRUE(needs_warmup({}, packet, exact));
  EXPECT_FALSE(after(exact, exact));
  EXPECT_FALSE(after(exact, render::exact_level(0.25)));
  EXPECT_FALSE(after(fast, render::fast_level(2, 1, 0, -1)));
  EXPECT_TRUE(after(exact, fast));
  EXPECT_TRUE(after(fast, exact));
  EXPECT_TRUE(after(fast, render::fast_level(1, 1, 0, -1, true)));
  render::RenderSettings wide = exact;
  wide.texel_format = render::TexelFormat::r32f;
  EXPECT_TRUE(after(exact, wide));
  packet.width = 128;
  EXPECT_TRUE(after(exact, exact));
}

TEST(TradeoffReport, ReadsBackAsWritten) {
  Report report;
  report.source = "a \"scene\".json";
  report.metadata = {{"processor", "x<y>"}};
  report.skipped = {"The eye: none."};
  Curve curve;
  curve.id = "hand-x";
  curve.category = "hand";
  curve.title = "Q & A's";
  curve.error_name = "error";
  curve.time_name = "ns";
  curve.extra_columns = {"b"};
  curve.discretization_error = 0.125;
  curve.points = {made(0.1, 3), made(1e-300, 4)};
  curve.points[0].setting = "one, \"1\"";
  curve.points[0].config_text = "`a<b` in place of `c`";
  for (Point& p : curve.points) p.extra_values = {7};
  choose_setting(curve);
  report.curves = {curve};
  const test::TemporaryFolder folder;
  test::write_file(folder / "tradeoff.json", to_json(report));
  EXPECT_TRUE(is_report(folder / "tradeoff.json"));
  const auto back = test::value_of(read_report(folder / "tradeoff.json"));
  EXPECT_EQ(to_json(back), to_json(report));
  const std::string page = to_html(back, &back, {{}});
  for (const char* part :
       {"Q &amp; A", "<td><code>a&lt;b</code> in place of <code>c</code></td>", "time of the other report", "gnuplot is not installed"})
    EXPECT_TRUE(has(page, part));
  EXPECT_EQ(page.find("http"), std::string::npos);  // the page needs no network
  // Only terms that the page uses are explained.
  EXPECT_NE(page.find("<dt>front</dt>"), std::string::npos);
  EXPECT_EQ(page.find("<dt>flicker</dt>"), std::string::npos);
  // Quotes in texts do not end gnuplot's strings.
  EXPECT_EQ(plot_script(curve, nullptr, "p").files, std::vector<std::string>{"p0.svg"});
}

constexpr const char* kScene = R"({"fields": {"flow": {"analytic": "helix"}, "ball": {"analytic": "sphere", "resolution": 24}},
  "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, -1.2]},
            {"name": "skin", "type": "isosurface", "field": "ball", "level": 1, "free": "above", "release": 0.3}],
  "volumes": [{"field": "ball", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}],
  "workspace": {"metres_per_unit": 0.05}})";

/// Measures some curves of a source in the folder, into its folder "out".
test::ProgramResult measure(const test::TemporaryFolder& folder, const std::string& source, const std::string& curves) {
  return test::run_ok({"tradeoff", folder / source, "-o", folder / "out", "--effort", "quick", "--only", curves});
}

TEST(TradeoffScene, IsMeasuredAndCompared) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  measure(folder, "s.json", "interpolation,streamline,isosurface,chain length");
  const Table line = Table::read(folder / "out/hand-streamline-curve.csv");
  std::map<std::string, double> error;
  for (std::size_t row = 0; row < line.rows(); ++row) error[line.text(row, "setting")] = line.number(row, "error");
  EXPECT_GT(error.at("linear"), 1e-5);
  EXPECT_LT(error.at("rk4"), 1e-8);
  EXPECT_LT(error.at("selected"), 1e-9);
  const Table skin = Table::read(folder / "out/hand-isosurface-skin.csv");
  EXPECT_LT(skin.number(0, "error"), 1e-10);
  EXPECT_EQ(Table::read(folder / "out/hand-chain.csv").rows(), 2u);
  EXPECT_TRUE(has(test::read_file(folder / "out/report.html"), "(chosen)"));

  // A report compared with itself is written without a measurement.
  const std::string report = folder / "out/tradeoff.json";
  test::run_ok({"tradeoff", report, "-o", folder / "again", "--compare", report});
  const std::string before = test::read_file(report);
  EXPECT_EQ(test::read_file(folder / "again/tradeoff.json"), before);
  EXPECT_TRUE(has(test::read_file(folder / "again/report.html"), "time of the other report"));
  test::run_refused({"tradeoff", report, "-o", folder / "out"});
  EXPECT_EQ(test::read_file(report), before);
}

TEST(TradeoffScene, OneServoRateIsChosen) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  const auto run = measure(folder, "s.json", "servo rate");
  std::string chosen[2];
  for (const int k : {0, 1}) {
    const Table table = Table::read(folder / (k == 0 ? "out/hand-rate-force.csv" : "out/hand-rate-stability.csv"));
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (table.text(row, "chosen") == "1") chosen[k] = table.text(row, "setting");
  }
  EXPECT_NE(chosen[0], "");
  EXPECT_EQ(chosen[0], chosen[1]);
  // If no rate stands out, the report does not require one.
  const bool even = has(run.out, "no setting stands out");
  EXPECT_FALSE(even && has(run.out, "the force needs")) << run.out;
  EXPECT_TRUE(has(test::read_file(folder / "out/report.html"), "The reference is a servo at 10 kHz; it differs from one at 20 kHz by "));
  test::write_file(folder / "eye.json", R"({"fields": {"ball": {"analytic": "sphere"}}, "volumes": [{"field": "ball"}]})");
  test::run_refused({"tradeoff", folder / "eye.json", "-o", folder / "none", "--effort", "quick", "--only", "servo rate"},
                    "there is nothing to measure");
  EXPECT_FALSE(test::exists(folder / "none"));
}

TEST(TradeoffScene, QualityIsOmittedWithoutSamplingAlongRays) {
  const test::TemporaryFolder folder;
  for (const char* opacity : {"1", "0.5"}) {
    test::write_file(folder / "s.json", std::string(R"({"fields": {"ball": {"analytic": "sphere", "resolution": 24}},
      "isosurfaces": [{"field": "ball", "level": 1, "opacity": )") +
                                            opacity + "}]}");
    const auto run = measure(folder, "s.json", "interpolation,quality,step");
    if (has(run.out, "not measured: Rendering:")) GTEST_SKIP() << run.out;
    for (const std::string name : {"Quality", "Step"})
      EXPECT_TRUE(has(run.out, name + ": nothing in the image is sampled along rays, so that --quality has no effect.")) << opacity;
  }
}

/// Cubic interpolation is not recommended where a volume would lose its fast rays.
TEST(TradeoffScene, CubicInterpolationIsNotRecommendedForAVolume) {
  const test::TemporaryFolder folder;
  test::run_ok({"generate", "gaussian", "-o", folder / "g.vdb", "--resolution", "24"});
  for (const bool volume : {false, true}) {
    test::write_file(folder / "s.json",
                     std::string(R"({"fields": {"g": {"file": "g.vdb"}}, )") +
                         (volume ? R"("volumes": [{"field": "g"}]})" : R"("isosurfaces": [{"field": "g", "level": 0.5}]})"));
    const auto run = measure(folder, "s.json", "cells");
    EXPECT_EQ(bool(has(run.out, "a cubic volume has no fast rays")), volume) << run.out;
    EXPECT_TRUE(has(run.out, volume ? ": linear. " : ": cubic. "));
  }
}

TEST(TradeoffScene, ImagesOfADataFileAreMeasured) {
  const test::TemporaryFolder folder;
  test::run_ok({"generate", "gaussian", "-o", folder / "g.vdb", "--resolution", "24"});
  const auto run = measure(folder, "g.vdb", "memory budget");
  EXPECT_TRUE(has(run.out, "not measured: Haptics:"));
  if (has(run.out, "not measured: Rendering:")) GTEST_SKIP() << run.out;
  const Table budget = Table::read(folder / "out/eye-budget.csv");
  EXPECT_LT(budget.number(0, "error"), 3);
}

TEST(TradeoffScene, BadInputIsOneLineAndNothingIsWritten) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  test::write_file(folder / "bad.json", R"({"curves": 3})");
  const auto report_of = [](const std::string& id, const std::string& part, int times = 1) {
    Curve curve;
    curve.category = part;
    Report report;
    for (int k = 0; k < times; ++k) report.curves.push_back(curve), report.curves.back().id = k > 0 ? id + std::to_string(k) : id;
    return to_json(report);
  };
  test::write_file(folder / "away.json", report_of("../../away", "eye"));  // a table outside the folder
  test::write_file(folder / "nose.json", report_of("x", "nose"));
  test::write_file(folder / "many.json", report_of("x", "eye", 3000));
  test::write_file(folder / "worse.json", R"({"catena_tradeoff": 1, "source": "s", "left_out": [], "curves": [{"id": 4}]})");
  const std::string out = folder / "out", scene = folder / "s.json";
  const auto refused = [&](const test::Words& words) {
    test::run_refused(test::joined(test::joined({"tradeoff"}, words), {"-o", out}));
    EXPECT_FALSE(std::filesystem::exists(out)) << words.back();
  };
  for (const char* name : {"none.json", "none.vdb", "bad.json", "worse.json", "away.json", "nose.json", "many.json"})
    refused({folder / name});
  for (const char* name : {"bad.json", "worse.json", "none.json"}) refused({scene, "--compare", folder / name});
  refused({scene, "--probe", folder / "none.csv"});
  for (const auto& [option, value] : {std::pair{"--effort", "slow"}, {"--only", "luck"}, {"--figure", "2"}})
    refused({scene, option, value});
}

}  // namespace tradeoff_measure_test
