#include "engine/app/tradeoff/measure/eye/eye.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/app/tradeoff/measure/floor.h"
#include "engine/base/clock.h"
#include "render/extract/extract.h"
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
  return PictureFloor{e.error, fmt::format("from the pictures of every 2nd voxel (off by {:.3g}) and every 4th ({:.3g}); {}", at_2h, at_4h,
                                           order_words(e))};
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
  eye->rays = render::draws_rays(eye->packet) || !eye->packet.isosurfaces.empty();
  const auto work = [&]() -> Outcome {
    CATENA_CHECK(find_truth(*eye, effort.eye_s));
    CATENA_TRY(const PictureFloor floor, picture_floor(*eye->renderer, eye->packet));
    eye->floor = floor.error;
    eye->floor_from = floor.from;
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
  std::vector<render::RenderSettings> drawn;
  for (const Tried& t : tried) {
    if (too_long.contains(t.series)) continue;
    const Repeat draw = drawing_of(*eye.renderer, eye.packet, t.settings);
    const std::int64_t start = now_ns();
    CATENA_CHECK(draw());
    const double seconds = 1e-3 * ms_since(start);
    CATENA_TRY(const render::Picture picture, eye.renderer->read_back());
    const render::PictureError error = render::measure_error(picture, eye.truth);
    curve.points.push_back(point_of(t, error, eye.renderer->stats()));
    drawn.push_back(t.settings);
    repeats.push_back(draw);
    if (seconds > 0.2 * subject.effort.eye_s) too_long.insert(t.series);
  }
  // voxels of another format than the picture's before are put on the device first, which does not count
  const std::vector<Repeat> bare = repeats;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const render::RenderSettings& before = drawn[(i + drawn.size() - 1) % drawn.size()];
    if (drawn[i].texels == before.texels && drawn[i].layout == before.layout) continue;
    repeats[i] = [draw = bare[i]]() -> Result<double> {
      CATENA_CHECK(draw());
      return draw();
    };
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
  curve.reference =
      eye.rays ? fmt::format("the exact rays with steps of {:g} voxel, 32-bit texels (twice the step: so much away)", eye.truth_step)
               : "the picture as it is: nothing in it is drawn by rays";
  curve.reference_error = eye.truth_error;
  curve.floor = eye.floor;
  curve.floor_from = eye.floor_from;
  return curve;
}

}  // namespace catena::app::tradeoff
