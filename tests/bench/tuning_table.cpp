// SPDX-License-Identifier: MIT
/// Plans against an exhaustive sweep: for five fields and six targets each (two errors and a time, for images and for haptics) the plan's
/// expected and the observed values, and the cost of the chosen setting compared with the cheapest of the sweep that is as accurate.
///   tuning_table DIR > TABLE.csv       DIR: the folder of the data files (carotid_flow.vdb ...)
/// Images are compared with converged images over all pixels, haptics on another motion than that of the tuning curve; times of the chosen
/// setting and of the sweep are from one run, alternating. Columns: field, target, setting, stated error, observed error, their ratio,
/// stated time, observed time, their ratio, cost divided by the cheapest's, cheapest; ms and 1/255, or us and world units.
#include <fmt/core.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "engine/app/tuning/choose/tune.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/haptics/streamline.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "engine/base/numbers.h"
#include "engine/scene/prepare.h"
#include "haptics/build/build_program.h"
#include "haptics/constraints/streamline/online_streamline.h"
#include "render/extract/extract.h"
#include "render/quality/quality.h"

namespace {

using namespace catena;
using namespace catena::app;

struct Case {
  const char *name, *flow, *scalar, *look;
};

template <class T>
T get(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}
void need(const Outcome& outcome) {
  if (!outcome) fmt::print(stderr, "{}\n", outcome.error().message), std::exit(1);
}

/// A seed away from the ends of the flow: of random positions the one with the longest line.
Vec3 seed_in(const field::VectorField& flow) {
  std::mt19937 random(3);
  const Bounds box = flow.world_bounds();
  Vec3 best = box.center();
  double longest = -1;
  for (int k = 0; k < 40; ++k) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = box.lo[i] + (0.25 + 0.5 * double(random() >> 8) / 16777216.0) * (box.hi[i] - box.lo[i]);
    const auto line = flow::trace({&flow, false, 0}, p, {.length = flow.domain_length()});
    if (!line) continue;
    const double way = (*line)->knots().back().s - (*line)->knots().front().s;
    if (way > longest) longest = way, best = p;
  }
  return best;
}

scene::Scene scene_of(const Case& c, const std::string& folder, int level = 0) {
  std::string scalar = c.scalar;
  const std::size_t nodes = scalar.find("64");
  if (level > 0 && nodes != std::string::npos) {
    scalar.replace(nodes, 2, std::to_string((64 >> level) + 1));
  } else if (level > 0) {
    scalar.insert(scalar.rfind('}'), fmt::format(", \"level_of_detail\": {}", level));
  }
  std::string files = fmt::format("{{\"flow\": {}, \"s\": {}}}", c.flow, scalar);
  for (std::size_t at; (at = files.find("DIR")) != std::string::npos;) files.replace(at, 3, folder);
  scene::Scene bare = get(scene::parse_scene("{\"fields\": " + files + "}", c.name));
  const json::Node nowhere;
  const Vec3 seed = seed_in(*get(scene::resolve_field(bare, "flow", nowhere)).vector);
  const std::string text = fmt::format(
      R"({{"fields": {}, "chain": [{{"name": "curve", "type": "streamline", "field": "flow", "seed": [{}, {}, {}]}}], "volumes": [{{"field": "s", {}}}]}})",
      files, seed.x, seed.y, seed.z, c.look);
  scene::Scene scene = get(scene::parse_scene(text, c.name));
  need(scene::prepare(scene));
  return scene;
}

/// Prints the row of a chosen point. `time`: observed time; the cheapest point has an error of at most `goal`.
void row(const std::string& field, const std::string& target, const tuning::Point& chosen, double stated_error, double stated_time,
         double time, const std::vector<tuning::Point>& sweep, double goal) {
  const tuning::Point* best = nullptr;
  for (const tuning::Point& point : sweep)
    if (point.error <= goal && (best == nullptr || point.time.median < best->time.median)) best = &point;
  fmt::print("{},{},\"{}\",{:.3g},{:.3g},{:.2f},{:.3g},{:.3g},{:.2f},{:.2f},\"{}\"\n", field, target, chosen.setting, stated_error,
             chosen.error, chosen.error / stated_error, stated_time, time, time / stated_time,
             best == nullptr ? NAN : chosen.time.median / best->time.median, best == nullptr ? "none" : best->setting);
  std::fflush(stdout);
}

std::vector<render::RenderSettings> all_settings(bool fast, bool shaded) {
  std::vector<render::RenderSettings> all;
  if (fast)
    for (const double step : {8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.5, 0.35, 0.25})
      for (const bool smooth : shaded ? std::vector{true, false} : std::vector{false}) {
        all.push_back(render::fast_level(step, 4, -1, -1, smooth));
        for (const double half : {12.0, 6.0, 3.0, 1.5}) all.push_back(render::fast_level(step, 4, half, -1, smooth));
        all.push_back(render::fast_level(step, 2, 0, -1, smooth));
        for (const double full : {12.0, 6.0, 3.0, 1.5}) all.push_back(render::fast_level(step, 2, 0, full, smooth));
        all.push_back(render::fast_level(step, 1, 0, -1, smooth));
      }
  for (const double step : {4.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.5, 0.35, 0.25}) all.push_back(render::exact_level(step));
  return all;
}

/// `coarser`: the scene on coarser levels of its grid, which are part of the sweep.
void eye_rows(const Case& c, scene::Scene& scene, std::vector<scene::Scene>& coarser) {
  const auto renderer = get(render::Renderer::create({}));
  const render::FramePacket packet = get(render::make_frame(scene, 400, 300));
  render::FramePacket clear = packet;
  clear.background[3] = 0;
  const tuning::ImageCurve curve =
      get(tuning::measure_image_curve(*renderer, packet, get(tuning::detect_quality_level_options(*renderer, packet)), [](double) {}));
  const double resolvable = tuning::min_resolvable_error(curve.curve);
  need(renderer->draw(packet, render::balanced_settings()));
  const auto sweep = all_settings(renderer->can_draw_fast(packet), packet.volumes.front().is_shaded);
  const auto truth = get(tuning::render_image(*renderer, clear, render::converged_level(0.125)));
  std::vector<render::FramePacket> levels;
  std::vector<std::unique_ptr<render::Renderer>> renderers;  // one per level, so that grids are uploaded once
  for (scene::Scene& coarse : coarser) {
    levels.push_back(get(render::make_frame(coarse, 400, 300)));
    renderers.push_back(get(render::Renderer::create({})));
    levels.back().view = packet.view;
    const auto grid = levels.back().volumes.front().grid;
    // opacities refer to the voxels of the full grid
    levels.back().volumes = packet.volumes;
    levels.back().volumes.front().grid = grid;
  }
  const auto error_of = [&](render::Renderer& by, render::FramePacket drawn, const render::RenderSettings& s) {
    drawn.background[3] = 0;
    return render::measure_error(get(tuning::render_image(by, drawn, s)), truth,
                                 {packet.background[0], packet.background[1], packet.background[2]})
        .rmse;
  };
  std::vector<scene::TuningTargets> wanted(3);
  wanted[0].max_image_error = std::max(1.0, 1.5 * resolvable);
  wanted[1].max_image_error = 4 * *wanted[0].max_image_error;
  double fast = 1e9, slow = 0;
  for (const tuning::Point& p : curve.curve.points) fast = std::min(fast, p.time.median), slow = std::max(slow, p.time.median);
  wanted[2].max_image_ms = std::sqrt(fast * slow);
  std::vector<tuning::ImageTuning> plans;
  tuning::Curve times;
  std::vector<tuning::TimedRun> repeats;
  const auto add = [&](render::Renderer& by, const render::FramePacket& drawn, const render::RenderSettings& s,
                       const std::string& on = "") {
    tuning::Point p;
    p.setting = render::describe(s) + on;
    p.error = error_of(by, drawn, s);
    times.points.push_back(p);
    repeats.push_back([&by, &drawn, s] { return render::measure_render_ms(by, drawn, s); });
  };
  for (const auto& s : sweep) add(*renderer, packet, s);
  for (std::size_t k = 0; k < levels.size(); ++k)
    for (const auto& s : sweep) add(*renderers[k], levels[k], s, fmt::format(", level {}", k + 1));
  const std::size_t swept = times.points.size();
  for (const scene::TuningTargets& plan : wanted) plans.emplace_back(curve, plan), add(*renderer, packet, plans.back().settings());
  need(tuning::time_points(times, repeats, 10, 5));
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const tuning::Point& chosen = times.points[swept + k];
    const double goal = std::max({resolvable, wanted[k].max_image_error.value_or(chosen.error)});
    row(c.name,
        wanted[k].max_image_error
            ? fmt::format("error={:.3g}{}", *wanted[k].max_image_error, *wanted[k].max_image_error < resolvable ? " (floor)" : "")
            : fmt::format("time={:.3g}", *wanted[k].max_image_ms),
        chosen, plans[k].expected_error(), plans[k].expected_ms(), chosen.time.median, times.points, goal);
  }
}

void hand_rows(const Case& c, scene::Scene scene) {
  tuning::Workload subject{std::move(scene), tuning::select_effort("quick"), {}, {}, 1000, {}, {}};
  need(tuning::add_haptics(subject, {}));
  const auto curves = get(tuning::measure_tick_curves(subject));
  for (const std::string& s : subject.skipped) fmt::print(stderr, "{}: {}\n", c.name, s);
  const auto found = tuning::to_tick_curves(subject.scene, curves, 1000);
  if (!found || found->links.empty()) return;
  const tuning::LinkCurve& link = found->links.front();
  const double resolvable = tuning::min_resolvable_error(link.curve) * link.length;
  std::vector<scene::TuningTargets> wanted(3);
  wanted[0].max_proxy_error = std::max(1e-4 * link.length, 1.5 * resolvable);
  wanted[1].max_proxy_error = std::max(1e-9 * link.length, 1.5 * resolvable);
  scene::TuningTargets quickest;
  quickest.max_tick_us = 1e-9;
  const tuning::TickTuning cheap(*found, quickest);
  wanted[2].max_tick_us = 1.6 * cheap.expected_us();
  // another motion: slower, with an offset
  const tuning::NamedLink own = tuning::find_links(subject.scene, "streamline").front();
  const auto along = tuning::motion_along_streamline(subject.scene, own, 1);
  tuning::ProbeMotion motion = *along;
  const double beside = 0.002 * link.length;
  motion.position_at = [along, beside](double t) {
    return along->position_at(0.9 * t) + beside * Vec3(std::sin(9 * t), std::cos(7 * t), std::sin(5 * t));
  };
  const auto path = motion.samples(1000);
  const field::VectorFieldPtr field = tuning::find_link_field(subject.scene, own.node).vector;
  const Vec3 seed = *get(json::get_optional_vec3(own.node, "seed"));
  const auto line =
      get(flow::trace({field.get(), false, 0}, seed, {.length = 10.2 * link.length, .tolerance = 1e-13, .hermite_tolerance = 1e-13}));
  const flow::NearestOnCurve nearest(line);
  std::vector<haptics::HapticProgram> programs;
  tuning::Curve times;
  const auto add = [&](haptics::HapticProgram program, const std::string& words) {
    programs.push_back(tuning::without_widgets(program));
    double far2 = 0;
    tuning::run_ticks(programs.back(), path,
                      [&](const HapticState& out) { far2 = std::max(far2, nearest.find_exact(out.links[0].proxy).distance2); });
    tuning::Point p;
    p.setting = words;
    p.error = std::sqrt(far2);
    times.points.push_back(p);
  };
  const auto online = [&](flow::Method method, double tolerance) {
    return tuning::isolate_link(*subject.program, own.name, haptics::make_online_streamline({field, false, 0, method, tolerance, seed}));
  };
  using flow::Method;
  add(*subject.program, "selected");
  // excludes fixed steps, which no plan chooses: their error grows with the hand's speed and path
  for (const Method m : {Method::rkf34, Method::dp54})
    for (double digits = 2; digits <= 13; digits += 0.5)
      add(online(m, std::pow(10.0, -digits)), fmt::format("{} 1e-{}", flow::to_string(m), digits));
  const std::size_t swept = times.points.size();
  std::vector<tuning::TickTuning> plans;
  for (const scene::TuningTargets& plan : wanted) {
    plans.emplace_back(*found, plan);
    const tuning::TunedLink& planned = plans.back().links().front();
    for (const auto& s : tuning::streamline_settings(own.node))
      if (s.label == planned.setting) add(s.is_selected ? *subject.program : online(*s.method, s.tolerance.value_or(1e-9)), s.label);
  }
  std::vector<tuning::TimedRun> repeats;
  for (const haptics::HapticProgram& program : programs) repeats.push_back(tuning::make_tick_run(program, path));
  need(tuning::time_points(times, repeats, 5, 15));
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const tuning::Point& chosen = times.points[swept + k];
    const double goal = std::max(resolvable, wanted[k].max_proxy_error.value_or(chosen.error));
    row(c.name,
        wanted[k].max_proxy_error ? fmt::format("max_proxy_error={:.3g}", *wanted[k].max_proxy_error)
                                  : fmt::format("max_tick_us={:.3g}", *wanted[k].max_tick_us),
        chosen, std::max(plans[k].error_anywhere(), 1e-300), plans[k].expected_us(), 1e-3 * chosen.time.median, times.points, goal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fmt::print(stderr, "usage: tuning_table DIR [FIELD]\n"), 2;
  const Case cases[] = {
      {"helix and ball", R"({"analytic": "helix"})", R"({"analytic": "sphere", "resolution": 64})",
       R"("color": "viridis", "range": [0.2, 2], "opacity": [[0.2, 0.6], [2, 0]])"},
      {"abc", R"({"file": "DIR/synth_abc.vdb", "grid": "velocity"})", R"({"file": "DIR/synth_abc.vdb", "grid": "speed"})",
       R"("color": "viridis", "range": [0, 3.5], "opacity": [[1, 0], [3.4, 0.3]], "shade": true)"},
      {"carotid", R"({"file": "DIR/carotid_flow.vdb", "grid": "velocity"})", R"({"file": "DIR/carotid_flow.vdb", "grid": "density"})",
       R"("color": "viridis", "range": [0, 580], "opacity": [[100, 0], [500, 0.7]])"},
      {"combustor", R"({"file": "DIR/combustor_cfd.vdb", "grid": "velocity"})", R"({"file": "DIR/combustor_cfd.vdb", "grid": "density"})",
       R"("color": "viridis", "range": [0.2, 0.7], "opacity": [[0.3, 0.1], [0.7, 0.0]])"},
      {"weather", R"({"file": "DIR/weather_uvt.vdb", "grid": "wind"})", R"({"file": "DIR/weather_uvt.vdb", "grid": "temperature"})",
       R"("color": "viridis", "range": [190, 310], "opacity": [[200, 0.0], [310, 0.1]], "shade": true)"}};
  fmt::print(
      "field,target,setting,stated_error,observed_error,error_ratio,stated_time,observed_time,time_ratio,cost_by_cheapest,cheapest\n");
  for (const Case& c : cases) {
    if (argc > 2 && std::string(argv[2]) != c.name) continue;
    scene::Scene scene = scene_of(c, argv[1]);
    std::vector<scene::Scene> coarser;
    for (const int level : {1, 2}) coarser.push_back(scene_of(c, argv[1], level));
    eye_rows(c, scene, coarser);
    hand_rows(c, std::move(scene));
  }
  return 0;
}
