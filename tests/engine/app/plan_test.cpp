/// Plans: the choice on curves with known answers, the servo of pictures, links and their texts, the store against damage and malice, and
/// the commands from the outside.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "engine/app/plan/make_plan.h"
#include "engine/app/tradeoff/report/report.h"
#include "engine/app/viewer/shell/live_plan.h"
#include "render/quality/quality.h"
#include "tests/support/program.h"
#include "tests/support/support.h"

namespace plan_test {

using namespace catena;
using namespace catena::app::plan;
using app::tradeoff::pick;
using app::tradeoff::Picked;
using app::tradeoff::Point;

Point made(double error, double time, const std::string& setting = "", double spread = 0.01) {
  Point p;
  p.setting = setting;
  p.error = error;
  p.time = {time, time * (1 - spread), time * (1 + spread), 9};
  return p;
}

Curve four() {
  Curve curve;
  curve.id = "eye-plan";
  curve.part = "eye";
  curve.points = {made(8, 1), made(2, 5), made(0.9, 10), made(0.1, 20), made(3, 12)};
  return curve;
}

TEST(PlanChoice, TakesTheCheapestThatMeetsTheError) {
  const Curve curve = four();
  EXPECT_EQ(pick(curve, {10.0, {}}).point, 0);
  EXPECT_EQ(pick(curve, {2.0, {}}).point, 1);
  EXPECT_EQ(pick(curve, {1.0, {}}).point, 2);
  EXPECT_TRUE(pick(curve, {1.0, {}}).reached);
  const Picked none = pick(curve, {0.01, {}});
  EXPECT_EQ(none.point, 3);
  EXPECT_FALSE(none.reached);
  EXPECT_EQ(pick(Curve(), {1.0, {}}).point, -1);
}

TEST(PlanChoice, NeverAsksForMoreThanTheDataHold) {
  Curve curve = four();
  curve.floor = 2.5;
  const Picked picked = pick(curve, {0.5, {}});
  EXPECT_EQ(picked.point, 1);
  EXPECT_TRUE(picked.floored && picked.reached);
  // nor does time buy it
  EXPECT_EQ(pick(curve, {{}, 100.0}).point, 1);
  EXPECT_FALSE(pick(curve, {4.0, {}}).floored);
  curve.floor = app::tradeoff::kNotMeasured, curve.reference_error = 1;
  EXPECT_EQ(pick(curve, {0.5, {}}).point, 2);
}

TEST(PlanChoice, TakesTheLeastErrorWithinTheTime) {
  const Curve curve = four();
  EXPECT_EQ(pick(curve, {{}, 11.0}).point, 2);
  EXPECT_EQ(pick(curve, {{}, 1.0}).point, 0);
  const Picked none = pick(curve, {{}, 0.5});
  EXPECT_EQ(none.point, 0);
  EXPECT_FALSE(none.reached);
}

EyeCurve eye() {
  EyeCurve made_curve{four(), {}};
  made_curve.curve.points.pop_back();
  for (const double step : {4.0, 2.0, 1.0, 0.5}) made_curve.settings.push_back(render::exact_rung(step));
  return made_curve;
}

scene::Plan wants(const char* words) {
  const auto plan = scene::parse_plan(words);
  EXPECT_TRUE(plan) << words;
  return plan ? *plan : scene::Plan();
}

TEST(PlanOfTheEye, AdaptsWhereTimesDiffer) {
  EyePlan plan(eye(), wants("time=11"));
  EXPECT_EQ(plan.settings().step_voxels, 1);
  EXPECT_EQ(plan.expected_ms(), 10);
  // the machine has become three times as slow
  for (int k = 0; k < 20; ++k) plan.drawn(3 * four().points[static_cast<std::size_t>(plan.now())].time.median);
  EXPECT_EQ(plan.settings().step_voxels, 4);
  EXPECT_NEAR(plan.expected_ms(), 3, 1);
  // and quick again
  for (int k = 0; k < 40; ++k) plan.drawn(four().points[static_cast<std::size_t>(plan.now())].time.median);
  EXPECT_LE(plan.settings().step_voxels, 2);
}

TEST(PlanOfTheEye, KeepsItsErrorWhateverTheTimes) {
  EyePlan plan(eye(), wants("error=1"));
  for (int k = 0; k < 20; ++k) {
    plan.drawn(k % 2 ? 300 : 1);
    EXPECT_LE(plan.expected_error(), 1);
  }
  plan.want(wants("error=0.01"));
  EXPECT_NE(plan.sentence().find("none is as exact"), std::string::npos) << plan.sentence();
}

TEST(PlanOfTheEye, SettingsComeFromTheProgramAlone) {
  const render::LadderKind kind{true, false};
  const std::vector<render::RenderSettings> all = eye_settings(kind);
  Curve curve;
  for (const auto& settings : all) curve.points.push_back(made(1, 1, render::describe(settings)));
  const auto back = eye_curve(curve, kind);
  ASSERT_TRUE(back);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(render::describe(back->settings[i]), render::describe(all[i]));
  curve.points[1].error = 1e308;  // no picture is so far off
  EXPECT_FALSE(eye_curve(curve, kind));
  curve.points[1].error = 1;
  curve.points[1].setting = "fast, step -1";
  EXPECT_FALSE(eye_curve(curve, kind));
}

TEST(PlanOfTheEye, OfTwoFormatsOfVoxelsTakesTheOneOfFewerBytes) {
  EyeCurve made_curve;
  const auto add = [&](double error, double time, double bytes, render::TexelFormat texels) {
    made_curve.settings.push_back(render::exact_rung(1));
    made_curve.settings.back().texels = texels;
    made_curve.curve.points.push_back(made(error, time, render::describe(made_curve.settings.back())));
    made_curve.curve.points.back().bytes = bytes;
  };
  add(0.5, 10, 4e6, render::TexelFormat::automatic);
  add(0.8, 10.3, 2e6, render::TexelFormat::r16f);
  made_curve.curve.floor = 0.4;
  const auto texels = [&](const char* words) { return EyePlan(made_curve, wants(words)).settings().texels; };
  EXPECT_EQ(texels("error=1"), render::TexelFormat::r16f);
  EXPECT_EQ(texels("error=0.6"), render::TexelFormat::automatic);  // too coarse
  EXPECT_EQ(texels("time=20"), render::TexelFormat::automatic);    // the least error
  EXPECT_NE(EyePlan(made_curve, wants("error=1")).sentence().find("16 bits a voxel; expected: error 0.8/255 in 10.3 ms, 1.91 MiB"),
            std::string::npos)
      << EyePlan(made_curve, wants("error=1")).sentence();
  made_curve.curve.points[1].time = {14, 13.9, 14.1, 9};
  EXPECT_EQ(texels("error=1"), render::TexelFormat::automatic);  // much slower
}

TEST(PlanOfTheEye, OffersFormatsOfVoxelsWhereRaysReadThem) {
  using render::TexelFormat;
  const auto grid = field::make_scalar_grid("g", {}, {8, 8, 8}, std::vector<float>(512, 1));
  const auto labels = grid->interpolated(field::Interpolation::nearest);
  const auto offered = [](const render::FramePacket& packet) {
    std::set<TexelFormat> formats;
    auto all = eye_settings({false, false}, packet);
    all.pop_back();  // the reference has 32 bits
    for (const render::RenderSettings& s : all) formats.insert(s.texels);
    return formats;
  };
  const std::set<TexelFormat> one{TexelFormat::automatic};
  render::FramePacket packet;
  packet.volumes.emplace_back().grid = grid;
  EXPECT_EQ(offered(packet), (std::set{TexelFormat::automatic, TexelFormat::r32f}));
  packet.isosurfaces.emplace_back().grid = grid;
  packet.isosurfaces[0].opacity = 0.5;  // its voxels have 32 bits by themselves
  EXPECT_EQ(offered(packet), (std::set{TexelFormat::automatic, TexelFormat::r16f}));
  packet.isosurfaces[0].opacity = 1;  // no rays see it
  EXPECT_EQ(offered(packet), one);
  packet.isosurfaces[0].opacity = 0.5;
  packet.volumes[0].grid = labels;  // a label that is rounded is another one
  EXPECT_EQ(offered(packet), one);
  // fast rays keep words of their own
  for (const render::RenderSettings& s : eye_settings({true, true}))
    if (s.fast) {
      EXPECT_EQ(s.texels, TexelFormat::automatic);
    }
}

LinkCurve link(const std::string& name, double length, std::vector<Point> points) {
  LinkCurve one;
  one.link = name;
  one.length = length;
  for (Point& p : points) one.keys.push_back({{"method", "\"" + p.setting + "\""}});
  one.curve.points = std::move(points);
  return one;
}

HandCurves two_links() {
  return {{link("a", 2, {made(1e-2, 300, "euler"), made(1e-4, 500, "rk2"), made(1e-8, 1500, "rk4")}),
           link("b", 1, {made(1e-3, 300, "euler"), made(1e-5, 600, "rk2"), made(1e-9, 1100, "rk4")})},
          400,
          100};
}

TEST(PlanOfTheHand, TakesForEachLinkTheCheapest) {
  const HandPlan plan(two_links(), wants("hand_error=1e-3"));
  ASSERT_EQ(plan.links().size(), 2u);
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "euler");
  EXPECT_DOUBLE_EQ(plan.expected_error(), 1e-3);
  EXPECT_DOUBLE_EQ(plan.expected_us(), 1e-3 * (400 + 400 + 200));
  EXPECT_FALSE(HandPlan(two_links(), wants("hand_error=1e-12")).reached());
}

TEST(PlanOfTheHand, SpendsTheTimeOnTheWorstLink) {
  const HandPlan plan(two_links(), wants("hand_time=1.31"));
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "rk2");
  const HandPlan poor(two_links(), wants("hand_time=0.01"));
  EXPECT_FALSE(poor.reached());
  EXPECT_EQ(poor.links()[0].setting, "euler");
  const std::vector<double> stops = plan.stops();
  EXPECT_TRUE(std::is_sorted(stops.rbegin(), stops.rend()));
  EXPECT_EQ(stops.size(), 5u);
}

TEST(PlanOfTheHand, SaysWhereALineIsFarOff) {
  HandCurves curves = two_links();
  for (LinkCurve& one : curves.links)
    for (Point& p : one.curve.points) p.more = {0, 0, NAN};
  curves.links[0].curve.points[1].more[2] = 0.5;  // L is 2: 1 somewhere, where 2e-4 is expected
  const HandPlan near(curves, wants("hand_error=1e-3"));
  EXPECT_EQ(near.links()[0].setting, "rk2");
  EXPECT_NEAR(near.expected_error(), 1e-3, 1e-12);  // of b
  EXPECT_EQ(near.error_anywhere(), 1);
  EXPECT_NE(
      near.sentence().find("(far along the line of a, small errors have grown: there up to 1, so that hand_error is kept near its seed"),
      std::string::npos)
      << near.sentence();
  curves.links[0].curve.points[1].more[2] = 2e-4;  // much the same everywhere
  const HandPlan alike(curves, wants("hand_error=1e-3"));
  EXPECT_EQ(alike.error_anywhere(), alike.expected_error());
  EXPECT_EQ(alike.sentence().find("far along"), std::string::npos) << alike.sentence();
}

TEST(PlanOfTheHand, GoesIntoTheTextAndLeavesWhatIsStated) {
  const HandPlan plan(two_links(), wants("hand_error=1e-3"));
  const auto text = plan.apply(R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a"}]})", "s.json");
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(*text, R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a", "method": "rk2"}]})");
}

/// Two links on one field, with linear cells and with cubic ones, and one on another field that states its cells.
HandCurves with_cells() {
  HandCurves curves = two_links();
  for (LinkCurve& linear : curves.links) linear.field = "flow", linear.curve.floor = 1e-4;
  for (std::size_t i = 0; i < 2; ++i) {
    LinkCurve cubic = curves.links[i];
    cubic.cubic = true;
    cubic.curve.floor = 1e-6;
    for (Point& p : cubic.curve.points) p.time.median *= 3;
    curves.links.push_back(cubic);
  }
  LinkCurve other = curves.links[0];
  other.link = "c", other.field = "stated";
  curves.links.push_back(other);
  return curves;
}

TEST(PlanOfTheHand, CellsAreCubicOnlyBelowWhatLinearOnesHold) {
  EXPECT_TRUE(HandPlan(with_cells(), wants("hand_error=1e-3")).cubic_fields().empty());
  const HandPlan fine(with_cells(), wants("hand_error=1e-5"));
  EXPECT_EQ(fine.cubic_fields(), std::vector<std::string>{"flow"});
  ASSERT_EQ(fine.links().size(), 3u);
  EXPECT_FALSE(fine.links()[0].floored);  // 1e-6 L is below it
  EXPECT_TRUE(fine.links()[2].floored);   // the stated field's cells stay
  EXPECT_NE(fine.sentence().find("field flow cubic"), std::string::npos) << fine.sentence();
  // where cubic cells are no better: noise
  HandCurves noisy = with_cells();
  for (LinkCurve& link : noisy.links)
    if (link.cubic) link.curve.floor = 0.8e-4;
  EXPECT_TRUE(HandPlan(noisy, wants("hand_error=1e-5")).cubic_fields().empty());
  // a time that linear cells keep and cubic ones do not
  EXPECT_TRUE(HandPlan(with_cells(), wants("hand_time=2.0")).cubic_fields().empty());
  EXPECT_FALSE(HandPlan(with_cells(), wants("hand_time=20")).cubic_fields().empty());
}

TEST(PlanOfTheHand, CellsGoIntoTheTextUnlessTheyAreStated) {
  const HandPlan plan(with_cells(), wants("hand_error=1e-5"));
  const auto open = plan.apply(R"({"fields": {"flow": {"file": "a.vdb"}}})", "s.json");
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(*open, R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "cubic"}}})");
  const std::string stated = R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "linear"}}})";
  EXPECT_EQ(*plan.apply(stated, "s.json"), stated);
}

TEST(PlanSlider, GoesFromTheFastestToTheMostExact) {
  app::LivePlan live;
  live.eye.emplace(eye(), wants("error=2"));
  live.hand.emplace(two_links(), wants("hand_error=1"));
  EXPECT_EQ(live.at(0).error, 8);
  EXPECT_DOUBLE_EQ(*live.at(1).error, 0.1);
  EXPECT_GT(*live.at(0).hand_error, *live.at(1).hand_error);
  EXPECT_NEAR(live.place(), 1.0 / 3, 1e-12);
  // what a place wants is chosen
  live.eye->want(live.at(2.0 / 3));
  EXPECT_EQ(live.eye->settings().step_voxels, 1);
  EXPECT_TRUE(live.follow(wants("error=0.1")));
  EXPECT_FALSE(live.follow(wants("error=0.1")));
  EXPECT_EQ(live.place(), 1);
  // a place stays where it was put, also where what is chosen is better than what it wants
  for (const double place : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    live.follow(live.at(place));
    EXPECT_NEAR(live.place(), place, 1e-12);
  }
  live.follow(wants("error=7.9"));
  EXPECT_NEAR(live.place(), 1.0 / 3, 1e-12);
}

TEST(PlanStore, KeepsCurvesAndBelievesNoOther) {
  const test::TemporaryFolder folder;
  const CurveStore store(folder / "plans");
  const auto always = [](const std::vector<Curve>&) { return true; };
  std::string told;
  EXPECT_FALSE(store.find("k", always, told));
  EXPECT_TRUE(told.empty());  // nothing there is nothing to tell
  Curve curve = four();
  curve.floor = 0.5;
  ASSERT_TRUE(store.keep("k", "/a/s.json", {curve}));
  const auto back = store.find("k", always, told);
  ASSERT_TRUE(back && told.empty()) << told;
  EXPECT_EQ(back->front().points.size(), curve.points.size());
  EXPECT_EQ(back->front().points[2].time.median, 10);
  EXPECT_EQ(back->front().floor, 0.5);

  const std::string good = test::read_file(store.path_of("k"));
  const auto refused = [&](const std::string& text, const std::string& why) {
    test::write_file(store.path_of("k"), text);
    told.clear();
    EXPECT_FALSE(store.find("k", always, told)) << text.substr(0, 80);
    EXPECT_NE(told.find(why), std::string::npos) << told;
    EXPECT_NE(told.find("measured anew"), std::string::npos);
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 0);
  };
  refused("", "damaged");
  refused(good.substr(0, good.size() / 2), "damaged");
  refused("[" + std::string(100000, '['), "damaged");
  refused(R"({"curves": []})", "damaged");
  refused(std::string(5u << 20, ' '), "larger");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  refused(with(R"("median": 10)", R"("median": -10)"), "no measurement");
  refused(with(R"("median": 10)", R"("median": 0)"), "no measurement");
  refused(with(R"("error": 8)", R"("error": -8)"), "no measurement");
  test::write_file(store.path_of("other"), good);
  EXPECT_FALSE(store.find("other", always, told));
  EXPECT_NE(told.find("another scene or machine"), std::string::npos) << told;
  std::filesystem::remove(store.path_of("k"));
  ASSERT_EQ(::mkfifo(store.path_of("k").c_str(), 0600), 0);  // is not waited for
  EXPECT_FALSE(store.find("k", always, told));
  // a file in the folder's place: nothing is kept, and that is all
  test::write_file(folder / "file", "x");
  EXPECT_FALSE(CurveStore(folder / "file").keep("k", "s", {curve}));
}

TEST(PlanStore, KeysFollowWhatDeterminesCurves) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "d.raw", "1234");
  scene::Scene scene;
  scene.path = folder / "s.json";
  scene.files = {folder / "d.raw"};
  const auto key = [&](const char* text) { return CurveKey("eye").add(scene, text).text(); };
  const std::string before = key(R"({"a": 1, "plan": {"error": 2}})");
  EXPECT_EQ(key(R"({"a": 1,  "plan": {"error": 3}, "quality": "draft"})"), before);  // what is wanted changes no curve
  EXPECT_NE(key(R"({"a": 2})"), before);
  EXPECT_NE(CurveKey("hand").add(scene, R"({"a": 1})").text(), before);
  test::write_file(folder / "d.raw", "1235");
  EXPECT_NE(key(R"({"a": 1})"), before);
}

constexpr const char* kScene = R"({"fields": {"flow": {"analytic": "helix"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, -1.2]%s}],
  "workspace": {"metres_per_unit": 0.05}%s})";

/// The program with a cache of its own.
class PlanProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    before_ = cache != nullptr ? cache : "";
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    std::string csv = "t,x,y,z\n";
    for (int k = 0; k < 300; ++k) csv += fmt::format("{},{},{},{}\n", 1e-3 * k, 0.6 + 1e-4 * k, 1e-3 * k, -1.2);
    test::write_file(folder_ / "p.csv", csv);
  }
  void TearDown() override {
    if (before_.empty())
      ::unsetenv("XDG_CACHE_HOME");
    else
      ::setenv("XDG_CACHE_HOME", before_.c_str(), 1);
  }
  std::string scene(const std::string& link = "", const std::string& more = "") const {
    std::string text = kScene;
    text.replace(text.find("%s"), 2, link);
    text.replace(text.find("%s"), 2, more);
    test::write_file(folder_ / "s.json", text);
    return folder_ / "s.json";
  }
  test::ProgramResult replay(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"replay", folder_ / "s.json", "--probe", folder_ / "p.csv", "-o", folder_ / "out.csv"};
    all.insert(all.end(), more.begin(), more.end());
    return test::run_catena(all);
  }
  std::string only_file() const {
    std::string path;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache/catena/plans")) {
      EXPECT_TRUE(path.empty());
      path = entry.path().string();
    }
    return path;
  }
  test::TemporaryFolder folder_;
  std::string before_;
};

TEST_F(PlanProgram, MeasuresOnceAndSaysWhatIsExpectedAndObserved) {
  scene("", R"(, "plan": {"hand_error": 1e-6})");
  const auto first = replay({});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("plan hand_error=1e-06: curve "), std::string::npos) << first.out;
  EXPECT_LT(first.out.find("expected: error"), first.out.find("observed: error")) << first.out;
  const std::string kept = test::read_file(only_file());
  // another wish goes by the same curves; so does the page of tradeoff
  const auto second = replay({"--plan", "hand_error=1e-2"});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(test::read_file(only_file()), kept);
  EXPECT_TRUE(app::tradeoff::is_report(only_file()));
  // damage costs a sentence
  test::write_file(only_file(), kept.substr(0, 1000));
  const auto third = replay({});
  ASSERT_EQ(third.exit_code, 0) << third.err;
  EXPECT_NE(third.out.find("it is damaged; it is not believed, and measured anew"), std::string::npos) << third.out;
  EXPECT_TRUE(app::tradeoff::read_report(only_file()));
}

TEST_F(PlanProgram, LeavesWhatTheSceneStates) {
  scene(R"(, "method": "rk4")");
  const auto pinned = replay({"--plan", "hand_error=1"});
  ASSERT_EQ(pinned.exit_code, 0) << pinned.err;
  EXPECT_NE(pinned.out.find("the hand stays as it is"), std::string::npos) << pinned.out;
  scene(R"(, "method": "dp54")");
  const auto half = replay({"--plan", "hand_error=1e-5"});
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_NE(half.out.find("curve dp54, tolerance 1e-"), std::string::npos) << half.out;
  scene(R"(, "tolerance": 2e-6, "follow": "online")");
  const auto tolerance = replay({"--plan", "hand_error=1e-13"});
  ASSERT_EQ(tolerance.exit_code, 0) << tolerance.err;
  EXPECT_EQ(tolerance.out.find("selected"), std::string::npos) << tolerance.out;
  EXPECT_EQ(tolerance.out.find("1e-07"), std::string::npos) << tolerance.out;
}

TEST_F(PlanProgram, ARecordingRepeatsToTheBitWhateverTheCacheSays) {
  const std::string path = scene("", R"(, "plan": {"hand_error": 1e-2})");
  const std::string log = folder_ / "r.catlog";
  const auto felt = test::run_catena({"feel", path, "--device", "simulated", "--seconds", "0.3", "--realtime", "off", "--record", log});
  ASSERT_EQ(felt.exit_code, 0) << felt.err;
  EXPECT_NE(felt.out.find("plan hand_error=0.01: curve "), std::string::npos) << felt.out;
  EXPECT_NE(felt.out.find("observed: error"), std::string::npos) << felt.out;
  const auto repeats = [&](const std::vector<std::string>& words) {
    const auto run = test::run_catena(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("all equal to the bit"), std::string::npos) << run.out;
  };
  // a cache that lies: every setting is exact, and what was quick is slow
  std::string lies = test::read_file(only_file());
  for (std::size_t at = 0; (at = lies.find("\"error\": ", at)) != std::string::npos; at += 9)
    if (const auto end = lies.find_first_of(",}", at); lies[at + 9] != 'n') lies.replace(at + 9, end - at - 9, "1e-15");
  for (std::size_t at = 0; (at = lies.find("\"median\": ", at)) != std::string::npos; at += 10) lies.insert(at + 10, "9");
  test::write_file(only_file(), lies);
  ASSERT_TRUE(app::tradeoff::read_report(only_file()));
  repeats({"replay", "--log", log});
  repeats({"replay", path, "--log", log});
  std::filesystem::remove_all(folder_ / "cache");
  repeats({"replay", "--log", log});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));  // nothing is measured
  EXPECT_EQ(test::run_catena({"replay", "--log", log, "--plan", "hand_error=1"}).exit_code, 2);
}

TEST_F(PlanProgram, ASampledFieldBecomesCubicWhereThatIsNearerToTheTruth) {
  ASSERT_EQ(test::run_catena({"generate", "lamb-oseen", "--resolution", "25", "-o", folder_ / "g.vdb"}).exit_code, 0);
  const auto scene_with = [&](const char* name, const std::string& field) {
    test::write_file(folder_ / name, R"({"fields": {"flow": )" + field + R"(}, "workspace": {"metres_per_unit": 0.05},
      "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, 0]}], "plan": {"hand_error": 1e-4}})");
    return folder_ / name;
  };
  const auto last_proxy = [&](const std::string& scene) {
    const auto run = test::run_catena({"replay", scene, "--probe", folder_ / "p.csv", "-o", folder_ / "out.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const test::Table table = test::Table::read(folder_ / "out.csv");
    const auto last = [&](const char* column) { return table.number(table.rows() - 1, column); };
    return std::pair(run.out, Vec3{last("curve_x"), last("curve_y"), last("curve_z")});
  };
  const auto [exact, truth] = last_proxy(scene_with("exact.json", R"({"analytic": "lamb-oseen"})"));
  const auto [stated, linear] = last_proxy(scene_with("stated.json", R"({"file": "g.vdb", "interpolation": "linear"})"));
  const std::string open = scene_with("open.json", R"({"file": "g.vdb"})");
  const auto [planned, cubic] = last_proxy(open);
  EXPECT_EQ(exact.find("cubic"), std::string::npos) << exact;
  EXPECT_EQ(stated.find("cubic"), std::string::npos) << stated;
  EXPECT_NE(planned.find("field flow cubic"), std::string::npos) << planned;
  EXPECT_LT(norm(cubic - truth), 0.2 * norm(linear - truth));
  // before the first tick, and in the recording
  const std::string log = folder_ / "r.catlog";
  const auto felt = test::run_catena({"feel", open, "--device", "simulated", "--seconds", "0.2", "--realtime", "off", "--record", log});
  ASSERT_EQ(felt.exit_code, 0) << felt.err;
  std::filesystem::remove_all(folder_ / "cache");
  for (const auto& words : {std::vector<std::string>{"replay", "--log", log}, {"replay", open, "--log", log}}) {
    const auto again = test::run_catena(words);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.out.find("all equal to the bit"), std::string::npos) << again.out;
  }
}

TEST_F(PlanProgram, BadWishesAreOneLine) {
  const std::string path = scene();
  for (const char* words :
       {"x=3", "error", "error=", "error=0", "error=nan", "error=2,time=3", "hand_error=1,hand_time=1", "error=2,error=2", ","}) {
    const auto run = replay({"--plan", words});
    EXPECT_EQ(run.exit_code, 2) << words;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(test::exists(folder_ / "out.csv"));
  }
  const auto eye = replay({"--plan", "error=2"});
  EXPECT_EQ(eye.exit_code, 2);
  EXPECT_NE(eye.err.find("nothing is drawn here"), std::string::npos) << eye.err;
  for (const char* plan : {R"({"erorr": 2})", R"({"error": 2, "time": 3})", "{}", R"({"error": 0})", "3", R"({"hand_time": "x"})"}) {
    scene("", std::string(", \"plan\": ") + plan);
    const auto run = replay({});
    EXPECT_EQ(run.exit_code, 2) << plan;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  EXPECT_EQ(test::run_catena({"render", path, "-o", folder_ / "x.png", "--plan", "error=2", "--quality", "draft"}).exit_code, 2);
  EXPECT_EQ(test::run_catena({"view", path, "--plan", "error=2", "--quality", "draft"}).exit_code, 2);
}

TEST_F(PlanProgram, PicturesAreDrawnByPlan) {
  test::write_file(folder_ / "v.json", R"({"fields": {"ball": {"analytic": "sphere", "resolution": 24}},
    "volumes": [{"field": "ball", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}]})");
  const auto draw = [&](const std::string& plan) {
    return test::run_catena({"render", folder_ / "v.json", "-o", folder_ / "v.png", "--size", "96x72", "--plan", plan});
  };
  const auto first = draw("error=3");
  if (first.exit_code == 1) GTEST_SKIP() << first.err;
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("plan error=3: "), std::string::npos) << first.out;
  EXPECT_LT(first.out.find("expected: error"), first.out.find("observed: error")) << first.out;
  const std::string kept = test::read_file(only_file());
  EXPECT_EQ(draw("time=10000").exit_code, 0);
  EXPECT_EQ(test::read_file(only_file()), kept);
  // a stated quality stays
  test::write_file(folder_ / "v.json", R"({"fields": {"ball": {"analytic": "sphere", "resolution": 24}}, "quality": "draft",
    "volumes": [{"field": "ball", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}]})");
  EXPECT_NE(draw("error=3").out.find("the picture stays as it is"), std::string::npos);
}

}  // namespace plan_test
