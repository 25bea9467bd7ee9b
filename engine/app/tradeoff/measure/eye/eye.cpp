#include "engine/app/tradeoff/measure/eye/eye.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/app/tradeoff/measure/floor.h"
#include "engine/app/tradeoff/measure/number.h"
#include "engine/base/clock.h"
#include "render/extract/extract.h"
#include "render/quality/quality.h"
#include "render/quality/refinement.h"

namespace catena::app::tradeoff {
namespace {

constexpr double kSettled = 0.3;  // 1/255: a step that changes less is short enough

render::RenderSettings converged(double step) {
  render::RenderSettings s = render::converged_rung(step);
  s.texels = render::TexelFormat::r32f;
  return s;
}

/// Halves the step until the picture settles, or the time is over.
Outcome find_truth(Eye& eye, double seconds) {
  const std::int64_t start = now_ns();
  double step = eye.rays ? 0.5 : 1;
  CATENA_TRY(eye.truth, picture_of(*eye.renderer, eye.packet, converged(step)));
  while (eye.rays) {
    const std::int64_t begin = now_ns();
    CATENA_TRY(render::Picture finer, picture_of(*eye.renderer, eye.packet, converged(step / 2)));
    eye.truth_error = render::measure_error(eye.truth, finer).rmse;
    eye.truth = std::move(finer);
    step /= 2;
    if (eye.truth_error < kSettled || step < 0.04 || 1e-3 * (ms_since(start) + 2 * ms_since(begin)) > seconds) break;
  }
  eye.truth_step = step;
  if (!eye.rays) return Done{};
  // surfaces and layers are met where they are, however far apart samples would be
  render::RenderSettings coarse = render::exact_rung(4);
  coarse.jitter = true;
  CATENA_TRY(const render::Picture picture, picture_of(*eye.renderer, eye.packet, coarse));
  eye.rays = !eye.packet.volumes.empty() || eye.truth_error > 0 || render::measure_error(picture, eye.truth).rmse > 0;
  if (!eye.rays) eye.truth_error = kNotMeasured;
  return Done{};
}

/// The same packet on coarser grids; false where one of them cannot be subsampled.
bool on_level(render::FramePacket& packet, std::map<const field::ScalarGrid*, Levels<field::ScalarGrid>>& levels, int level) {
  const auto put = [&](std::shared_ptr<const field::ScalarGrid>& grid) {
    if (!grid) return true;
    auto found = levels.find(grid.get());
    if (found == levels.end()) {
      if (grid->interpolation() != field::Interpolation::linear) return false;
      const auto made = make_levels(*grid);
      if (!made) return false;
      found = levels.emplace(grid.get(), *made).first;
    }
    grid = found->second.at[level];
    return true;
  };
  bool all = true;
  for (render::VolumeItem& item : packet.volumes) all = put(item.grid) && (!item.color_by || put(item.color_by->grid)) && all;
  for (render::IsosurfaceItem& item : packet.isosurfaces) all = put(item.grid) && (!item.color_by || put(item.color_by->grid)) && all;
  for (render::SliceItem& item : packet.slices) all = put(item.grid) && all;
  return all;
}

}  // namespace

Result<PictureFloor> picture_floor(render::Renderer& renderer, const render::FramePacket& packet) {
  if (!draws_grids(packet)) return PictureFloor{kNotMeasured, "No grid is drawn: the data leave nothing open."};
  std::map<const field::ScalarGrid*, Levels<field::ScalarGrid>> levels;
  render::Picture pictures[3];
  for (int level = 0; level < 3; ++level) {
    render::FramePacket coarse = packet;
    if (!on_level(coarse, levels, level))
      return PictureFloor{
          kNotMeasured,
          "The data's own error is not known: a grid has fewer than nine voxels along an axis, too many to be copied, or is a label map."};
    CATENA_TRY(pictures[level], picture_of(renderer, coarse, converged(0.5 / (1 << level))));
  }
  const double at_2h = render::measure_error(pictures[1], pictures[0]).rmse, at_4h = render::measure_error(pictures[2], pictures[0]).rmse;
  const Extrapolated e = from_differences(at_2h, at_4h);
  return PictureFloor{e.error,
                      fmt::format("from the pictures of every 2nd voxel (off by {}) and every 4th ({}); {}", number_text(at_2h, 3),
                                  number_text(at_4h, 3), order_words(e)),
                      e.settled};
}

bool draws_grids(const render::FramePacket& packet) {
  return !packet.volumes.empty() || !packet.isosurfaces.empty() || !packet.slices.empty();
}

Point point_of(const Tried& t, const render::PictureError& error, const render::RenderStats& stats) {
  return {t.setting,
          t.write,
          t.series,
          error.rmse,
          kNotMeasured,
          {},
          static_cast<double>(stats.gpu_bytes),
          {error.p999, 100 * error.kept, 100 * error.least_kept}};
}

Result<render::Picture> picture_of(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings) {
  CATENA_CHECK(renderer.draw(packet, settings));
  return renderer.read_back();
}

Repeat drawing_of(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings) {
  return [&renderer, &packet, settings]() -> Result<double> {
    const auto now = renderer.device().info().is_cpu() ? processor_ns : now_ns;
    const std::int64_t start = now();
    CATENA_CHECK(renderer.draw(packet, settings));
    return 1e-6 * static_cast<double>(now() - start);
  };
}

bool needs_others(const LastDrawn& last, const render::FramePacket& packet, const render::RenderSettings& settings) {
  if (!last.settings || last.width != packet.width || last.height != packet.height) return true;
  const render::RenderSettings& before = *last.settings;
  if (settings.texels != before.texels || settings.layout != before.layout || settings.fast.has_value() != before.fast.has_value())
    return true;
  return settings.fast && (settings.fast->smooth_gradients != before.fast->smooth_gradients ||
                           settings.fast->spacing != before.fast->spacing || settings.fast->most_bytes != before.fast->most_bytes);
}

Repeat drawing_in_turns(render::Renderer& renderer, const render::FramePacket& packet, const render::RenderSettings& settings,
                        std::shared_ptr<LastDrawn> last) {
  return [draw = drawing_of(renderer, packet, settings), &packet, settings, last = std::move(last)]() -> Result<double> {
    if (needs_others(*last, packet, settings)) CATENA_CHECK(draw());
    *last = {settings, packet.width, packet.height};
    return draw();
  };
}

Outcome open_eye(Subject& subject) {
  const Effort& effort = subject.effort;
  CATENA_TRY(render::FramePacket packet, render::make_frame(subject.scene, effort.width, effort.height));
  if (!packet.eyes.empty()) packet.view = packet.eyes.front();
  packet.eyes.clear();
  packet.packing = render::Packing::single;
  packet.overlay = {};
  packet.cursors.clear();
  packet.background[3] = 0;
  if (!draws_grids(packet) && packet.meshes.empty() && packet.tubes.empty() && packet.balls.empty() && packet.glyphs.empty()) {
    subject.left_out.emplace_back("The eye: the scene draws nothing.");
    return Done{};
  }
  auto eye = std::make_unique<Eye>();
  auto renderer = render::Renderer::create({});
  if (!renderer) {
    subject.left_out.push_back("The eye: " + renderer.error().message + ".");
    return Done{};
  }
  eye->renderer = std::move(*renderer);
  eye->packet = std::move(packet);
  eye->rays = render::draws_rays(eye->packet);
  const auto work = [&]() -> Outcome {
    CATENA_CHECK(find_truth(*eye, effort.eye_s));
    CATENA_TRY(const PictureFloor floor, picture_floor(*eye->renderer, eye->packet));
    eye->floor = floor.error;
    eye->floor_from = floor.from;
    eye->floor_settled = floor.settled;
    CATENA_CHECK(eye->renderer->draw(eye->packet, render::balanced_settings()));
    return Done{};
  };
  if (const Outcome done = work(); !done) {
    subject.left_out.push_back("The eye: " + done.error().message + ".");
    return Done{};
  }
  eye->fast = eye->renderer->draws_fast(eye->packet);
  subject.eye = std::move(eye);
  return Done{};
}

Outcome measure_settings(Subject& subject, const std::vector<Tried>& tried, Curve& curve) {
  Eye& eye = *subject.eye;
  std::vector<Repeat> repeats;
  std::set<std::string> too_long;
  const auto last = std::make_shared<LastDrawn>();
  for (const Tried& t : tried) {
    if (too_long.contains(t.series)) continue;
    const Repeat draw = drawing_of(*eye.renderer, eye.packet, t.settings);
    const std::int64_t start = now_ns();
    CATENA_CHECK(draw());
    const double seconds = 1e-3 * ms_since(start);
    CATENA_TRY(const render::Picture picture, eye.renderer->read_back());
    const render::PictureError error = render::measure_error(picture, eye.truth);
    curve.points.push_back(point_of(t, error, eye.renderer->stats()));
    repeats.push_back(drawing_in_turns(*eye.renderer, eye.packet, t.settings, last));
    if (seconds > 0.2 * subject.effort.eye_s) too_long.insert(t.series);
  }
  return time_points(curve, repeats, subject.effort.eye_s, 15);
}

Curve eye_curve(const Subject& subject, const std::string& id, const std::string& title, const std::string& what) {
  Eye& eye = *subject.eye;
  Curve curve;
  curve.id = "eye-" + id;
  curve.title = title;
  curve.what = what;
  curve.error_name = "error of the picture (RMSE, 1/255)";
  curve.time_name = eye.renderer->device().info().is_cpu() ? "ms of processor a picture" : "ms a picture";
  curve.more = {"99.9 %, 1/255", "thin parts kept, %", "of the worst thin part, %"};
  const bool by_rounding = !(eye.truth_error > render::kLeastTold);
  curve.reference_error = by_rounding ? render::kLeastTold : eye.truth_error;
  if (by_rounding) curve.told_name = "what rounding to 8 bits hides";
  const std::string least = fmt::format("smaller errors than {}/255{} cannot be told", number_text(curve.reference_error),
                                        by_rounding ? ", which rounding to 8 bits hides," : "");
  curve.reference = eye.rays
                        ? fmt::format(
                              "the picture of exact rays with steps of {:g} voxel and 32-bit texels; it differs from one with steps of "
                              "{:g} voxel by {}/255; {}",
                              eye.truth_step, 2 * eye.truth_step, number_text(eye.truth_error), least)
                        : "the picture as it is: nothing in it is sampled along rays; " + least;
  curve.floor = eye.floor;
  if (!eye.floor_settled) curve.floor_name += ", at least";
  curve.floor_from = eye.floor_from;
  return curve;
}

}  // namespace catena::app::tradeoff
