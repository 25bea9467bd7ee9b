// SPDX-License-Identifier: MIT
#include "engine/app/render/frames.h"

#include <cmath>
#include <csignal>

#include "engine/app/cli/command.h"
#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"
#include "render/extract/extract_internal.h"
#include "render/extract/plane_views.h"

namespace catena::app {

Result<render::FramePacket> Frames::packet(int frame) {
  if (!steps_.empty()) {
    scene::set_step(scene_, steps_[static_cast<std::size_t>(frame) % steps_.size()]);
  }
  scene_.animation_phase = options_.animation_phase + static_cast<double>(frame) / motion_.frames();
  probe_.seek(scene_, options_.play_probe && motion_.frames() > 1 ? static_cast<double>(frame) / (motion_.frames() - 1) : 1);
  CATENA_TRY(render::FramePacket packet, render::make_frame(scene_, size_.width, size_.height));
  // the first frame is extracted by every shard, for the view and the settings
  const auto first = static_cast<int>(shard.first_item()), next = frame < first ? first : frame + static_cast<int>(shard.count);
  if (!steps_.empty() && next < motion_.frames())
    field::prefetch(scene::prefetch_requests(scene_, steps_[static_cast<std::size_t>(next) % steps_.size()]));
  // the camera is fixed while the probe moves or time steps change
  if (!base_view_ || (!options_.play_probe && steps_.empty())) base_view_ = packet.view, base_bounds_ = render::packet_bounds(packet);
  const render::View view = motion_.view_at(*base_view_, base_bounds_, static_cast<double>(size_.width) / size_.height, frame);
  render::set_view(scene_, view, packet);
  CATENA_CHECK(render::check_screen_view(packet, scene_.stereo));
  if (!options_.layout.empty()) CATENA_CHECK(add_planes(packet));
  return packet;
}

Outcome Frames::add_planes(render::FramePacket& packet) {
  scene::OrthogonalViews views = scene_.orthogonal_views.value_or(scene::OrthogonalViews{});
  if (!options_.focus.empty()) {
    views.focus.emplace(0.0);
    for (int i = 0; i < 3; ++i) {
      const auto number = parse_double(options_.focus[static_cast<std::size_t>(i)]);
      if (!number || !std::isfinite(*number)) return Error{"--focus: three finite numbers X Y Z were expected"};
      (*views.focus)[i] = *number;
    }
  }
  CATENA_TRY(const render::OrthoPlanes planes, render::find_ortho_planes(scene_));
  Bounds box;
  for (const Vec3& corner : planes.corners) box.extend(corner);
  if (views.focus && !box.contains(*views.focus))
    return Error{std::string(options_.focus.empty() ? "orthogonal_views" : "--focus") +
                 ": the point is outside of the field; a point inside was expected"};
  return render::add_plane_views(scene_, planes, views, packet);
}

Result<double> Frames::draw(int frame, Outputs* outputs) {
  if (!interrupt_) interrupt_.emplace(std::vector{SIGINT, SIGTERM, SIGHUP});
  const std::int64_t start = now_ns();
  CATENA_TRY(const render::FramePacket next, packet(frame));
  const double extract_ms = ms_since(start);
  if (path) {
    CATENA_TRY(const double ms, draw_path(next, outputs, frame));
    return extract_ms + ms;
  }
  Outcome stopped = Done{};
  bool interrupted = false;
  const std::function<Outcome(const render::Band&)> take = [&](const render::Band& band) -> Outcome {
    interrupted = interrupt_->is_requested();
    if (interrupted) return Error{"interrupted"};
    if (band.height == 0) {
      if (progress != nullptr) progress->update(++tiles_done_);
      return Done{};
    }
    if (first_ms == 0) first_ms = ms_since_process_start();
    return stopped = outputs->write(band);
  };
  if (outputs != nullptr) CATENA_CHECK(outputs->begin_frame(frame));
  render::RenderSettings drawn = settings;
  drawn.smooth_edges = smooth_edges && plan.count() == 1;
  const auto ms = render::render_tiled(*renderer, next, drawn, plan, channels,
                                       outputs != nullptr ? take : std::function<Outcome(const render::Band&)>());
  CATENA_CHECK(stopped);
  if (interrupted || interrupt_->is_requested()) throw MachineFailure{"interrupted: no incomplete file was kept"};
  if (!ms) throw MachineFailure{ms.error().message};
  if (const auto coarser = renderer->stats().downsampled_grids; needs_full_resolution && !coarser.empty())
    return Error{"--shard: the resolution of time steps would differ between shards; " + coarser.front().message() +
                     "; more GPU memory or smaller data was expected",
                 true};
  if (outputs != nullptr) CATENA_CHECK(outputs->end_frame());
  return extract_ms + ms->wall_ms;
}

Result<double> Frames::draw_path(const render::FramePacket& packet, Outputs* outputs, int frame) {
  const std::int64_t start = now_ns();
  ProgressLine line("path tracing", 1);
  const auto picture = render_path(*renderer, packet, *path, channels, [&](double done) {
    line.update(done);
    return !interrupt_->is_requested();
  });
  if (!picture) {
    if (picture.error().system_failure) throw MachineFailure{picture.error().message};
    return picture.error();
  }
  if (!*picture) throw MachineFailure{"interrupted: no incomplete file was kept"};
  if (path_summary.empty())
    for (const std::string& note : (*picture)->notes) print_message("note: " + note);
  path_summary = (*picture)->summary;
  if (outputs == nullptr) return ms_since(start);
  if (first_ms == 0) first_ms = ms_since_process_start();
  CATENA_CHECK(outputs->begin_frame(frame));
  CATENA_CHECK(outputs->write((*picture)->band));
  CATENA_CHECK(outputs->end_frame());
  return ms_since(start);
}

Frames::Sample Frames::sample_of(const render::FramePacket& packet) const {
  const bool fits_one_image = std::max(plan.samples_x(), plan.samples_y()) <= renderer->max_image_side() &&
                              std::uint64_t(plan.samples_x()) * plan.samples_y() <= render::kMaxUntiledSamples;
  if (plan.antialias == 1 && (plan.count() == 1 || fits_one_image)) return {packet};
  const render::TileArea middle = plan.area(plan.columns() / 2, plan.rows() / 2);
  return {render::make_tile_packet(packet, plan, middle),
          double(middle.render_width) * middle.render_height / (double(plan.samples_x()) * plan.samples_y())};
}

}  // namespace catena::app
