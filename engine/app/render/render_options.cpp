// SPDX-License-Identifier: MIT
#include "engine/app/render/render_options.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/csv.h"
#include "engine/base/numbers.h"
#include "render/frame/camera.h"

namespace catena::app {

Result<render::CameraPath> read_head_path(const std::string& path) {
  CATENA_TRY(const std::vector<ProbePathRow> rows, read_probe_path(path));
  std::vector<render::CameraKey> keys;
  for (const ProbePathRow& row : rows) keys.push_back({row.t_s, row.position, Vec3(0.0), std::nullopt, std::nullopt});
  return render::CameraPath(std::move(keys));
}

Result<CameraMotion> CameraMotion::make(const RenderOptions& o, double probe_path_s) {
  CameraMotion motion;
  if (!std::isfinite(o.orbit_deg)) return Error{"--orbit: expected a finite angle in degrees"};
  if (!(std::fabs(o.elevation_deg) <= 90)) return Error{"--elevation: expected an angle from -90 to 90 degrees"};
  if (!(o.zoom >= 1e-3 && o.zoom <= 1e6)) return Error{"--zoom: expected a factor from 0.001 to 1000000"};
  if (!o.view.empty()) {
    motion.camera_direction_ = render::axis_direction(o.view);
    if (!motion.camera_direction_)
      return Error{"--view " + o.view + ": +x, -x, +y, -y, +z, -z (the viewing direction) or iso was expected"};
  }
  if (!o.camera.empty()) {
    if (motion.camera_direction_ || o.fit) return Error{"--camera " + o.camera + ": excludes --view and --fit"};
    if (!o.head_path.empty()) return Error{"--head " + o.head_path + ": excludes --camera"};
    CATENA_TRY(motion.path_, render::read_camera_path(o.camera));
  }
  if (!o.head_path.empty()) {
    if (o.stereo.screen.empty()) return Error{"--head " + o.head_path + ": a display screen was expected (--screen)"};
    CATENA_TRY(motion.head_, read_head_path(o.head_path));
  }
  motion.fit_ = o.fit;
  motion.orbit_deg_ = o.orbit_deg;
  motion.elevation_deg_ = o.elevation_deg;
  motion.zoom_ = o.zoom;
  const auto duration_s = [](const std::optional<render::CameraPath>& path) { return path ? path->duration_s() : 0.0; };
  const double by_path = std::max({duration_s(motion.path_), duration_s(motion.head_), probe_path_s}) * o.fps + 1;
  if (o.frames == 0 && by_path > kMaxFrames)
    return Error{(!o.camera.empty()      ? o.camera
                  : !o.head_path.empty() ? o.head_path
                                         : o.probe) +
                 ": at " + std::to_string(o.fps) + " frames per second there are more than 100000 frames; --frames N was expected"};
  motion.frames_ = o.frames > 0 ? o.frames : std::max(1, static_cast<int>(std::lround(by_path)));
  return motion;
}

render::View CameraMotion::view_at(const render::View& base, const Bounds& bounds, double aspect, int frame) const {
  render::View view = base;
  const auto along = [&](const render::CameraPath& path) {
    return path.at(view, path.start_s() + (frames_ > 1 ? path.duration_s() * frame / (frames_ - 1) : 0));
  };
  if (path_) view = along(*path_);
  if (camera_direction_) {
    view = render::fit_view(bounds, aspect, *camera_direction_, base.fovy_deg);
    view.orthographic = base.orthographic;
  } else if (fit_) {
    view = render::refit_view(view, bounds, aspect);
  }
  view.window = base.window;
  view = render::zoom_view(view, zoom_);
  view = render::orbit_view(view, orbit_deg_ * frame / frames_, elevation_deg_);
  if (head_) view.position = along(*head_).position;
  return view;
}

Result<std::vector<int>> parse_steps(const std::string& words) {
  std::vector<int> steps;
  if (words.empty()) return steps;
  std::vector<double> numbers;
  std::stringstream parts(words);
  for (std::string part; std::getline(parts, part, ':');) {
    const auto number = parse_double(part);
    constexpr double kMaximum = 1e6;
    if (!number || *number != std::floor(*number) || std::fabs(*number) > kMaximum) numbers.clear();
    if (!number) break;
    numbers.push_back(*number);
  }
  const double stride = numbers.size() == 3 ? numbers[2] : 1;
  if (numbers.size() < 2 || numbers.size() > 3 || numbers[0] < 0 || numbers[1] < numbers[0] || stride < 1 ||
      (numbers[1] - numbers[0]) / stride >= kMaxFrames)
    return Error{"--steps " + words + ": FIRST:LAST or FIRST:LAST:STRIDE was expected, whole numbers from 0"};
  for (double step = numbers[0]; step <= numbers[1]; step += stride) steps.push_back(static_cast<int>(step));
  return steps;
}

bool is_fixed_quality(std::string_view words) { return !words.empty() && !scene::image_targets(words).has_image_targets(); }

namespace {

render::RenderSettings with_finest_pages(render::RenderSettings settings) {
  settings.shows_finest_pages = true;
  return settings;
}

}  // namespace

Result<Quality> parse_quality(const std::string& words) {
  using Kind = render::QualityGoal::Kind;
  if (words == "draft") return Quality{render::draft_settings(), {}};
  if (words == "balanced") return Quality{render::balanced_settings(), {}};
  if (words == "reference") return Quality{with_finest_pages(render::reference_settings()), {}};
  for (const auto& [prefix, kind] : {std::pair{"error=", Kind::error}, std::pair{"time=", Kind::time}}) {
    if (!words.starts_with(prefix)) continue;
    const auto value = parse_double(words.substr(std::string_view(prefix).size()));
    const render::RenderSettings balanced = render::balanced_settings();
    if (value && std::isfinite(*value) && *value > 0)
      return Quality{kind == Kind::error ? with_finest_pages(balanced) : balanced, render::QualityGoal{kind, *value}};
    return Error{"--quality " + words + ": expected a positive number of " + (kind == Kind::error ? "1/255" : "milliseconds")};
  }
  if (words.starts_with("step=")) {
    const auto step = parse_double(words.substr(5));
    if (step && std::isfinite(*step) && *step >= 0.01 && *step <= 100) {
      render::RenderSettings settings;
      settings.step_voxels = *step;
      return Quality{with_finest_pages(settings), {}};
    }
    return Error{"--quality " + words + ": expected a step of 0.01 to 100 voxels"};
  }
  return Error{"--quality " + words + ": expected draft, balanced, reference, time=MS, error=E or step=VOXELS"};
}

}  // namespace catena::app
