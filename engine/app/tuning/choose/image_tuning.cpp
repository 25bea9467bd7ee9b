// SPDX-License-Identifier: MIT
#include "engine/app/tuning/choose/image_tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "engine/app/tuning/measure/timing.h"
#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "render/quality/quality.h"

namespace catena::app::tuning {
namespace {

constexpr double kErrorsS = 60, kTimesS = 6;  // seconds: maximum for measuring errors, approximate for measuring times
constexpr std::uint32_t kFloorWidth = 256;    // pixels: width of the image in which the discretization error is measured
constexpr int kRounds = 5;                    // timed rounds
constexpr double kOwn = std::numbers::sqrt2;  // factor on the reference's own error: smallest error that can be measured
constexpr double kHolds = 1.15;               // factor on a time target: the current setting stays while it is within this
constexpr double kAsQuick = 1.1;              // factor on a time: a setting with fewer bytes may take this much longer

/// A small copy of the packet with the view of one eye.
render::FramePacket small(render::FramePacket packet) {
  packet = packet.first_view();
  packet.background[3] = 0;
  const double scale = std::min(1.0, double(kFloorWidth) / packet.width);
  packet.width = std::max(16u, static_cast<std::uint32_t>(packet.width * scale));
  packet.height = std::max(16u, static_cast<std::uint32_t>(packet.height * scale));
  return packet;
}

}  // namespace

Result<render::QualityLevelOptions> detect_quality_level_options(render::Renderer& renderer, const render::FramePacket& packet) {
  CATENA_CHECK(renderer.draw(packet, render::balanced_settings()));
  return render::QualityLevelOptions{renderer.can_draw_fast(packet), std::ranges::any_of(packet.volumes, &render::VolumeItem::is_shaded)};
}

std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind) {
  std::vector<render::RenderSettings> all;
  const auto each_format = [&all](const render::RenderSettings& settings) {
    all.push_back(settings);
    if (settings.fast || settings.texel_format != render::TexelFormat::automatic) return;
    for (const render::TexelFormat format : {render::TexelFormat::r16f, render::TexelFormat::r32f}) {
      all.push_back(settings);
      all.back().texel_format = format;
    }
  };
  // coarse settings may use the shading by the cell's gradient, which the quality levels omit
  if (kind.can_draw_fast && kind.is_shaded)
    for (const double step : {8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0}) all.push_back(render::fast_level(step, 4, -1, -1));
  std::ranges::for_each(render::quality_levels(kind), each_format);
  each_format(render::reference_settings());
  return all;
}

std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind, const render::FramePacket& packet) {
  // automatic texels have 32 bits where a grid carries a surface (render/passes/pass.h)
  const bool surfaces = !packet.isosurfaces.empty() || !packet.slices.empty();
  const auto labels = [](const auto& item) {
    return item.grid->interpolation() == field::Interpolation::nearest ||
           (item.color_by && item.color_by->grid->interpolation() == field::Interpolation::nearest);
  };
  const bool fewer = surfaces && packet.slices.empty() &&
                     std::ranges::all_of(packet.isosurfaces, [](const auto& item) { return item.opacity < 1; }) &&
                     std::ranges::none_of(packet.isosurfaces, labels) && std::ranges::none_of(packet.volumes, labels);
  std::vector<render::RenderSettings> all = candidate_image_settings(kind);
  const render::RenderSettings reference = all.back();
  all.pop_back();
  std::erase_if(all, [&](const render::RenderSettings& s) {
    if (s.fast || s.texel_format == render::TexelFormat::automatic) return false;
    return s.texel_format == render::TexelFormat::r16f ? !fewer : surfaces;
  });
  all.push_back(reference);
  return all;
}

Result<ImageCurve> measure_image_curve(render::Renderer& renderer, const render::FramePacket& packet,
                                       const render::QualityLevelOptions& kind, const std::function<void(double)>& at) {
  ImageCurve made;
  Curve& curve = made.curve;
  curve.id = "eye-plan";
  curve.category = "eye";
  curve.title = "Rendering settings of the image";
  curve.description = fmt::format("The candidate settings, measured on the image itself, {}x{}.", packet.width, packet.height);
  curve.error_name = "error of the image (RMSE, 1/255)";
  curve.time_name = "ms per image";
  curve.bytes_name = "bytes on the device";
  at(0);
  CATENA_TRY(const tuning::ImageDiscretizationError floor, tuning::estimate_image_discretization_error(renderer, small(packet)));
  curve.discretization_error = floor.error;
  curve.discretization_error_method = floor.method;
  at(0.1);
  const std::vector<render::RenderSettings> all = candidate_image_settings(kind, packet);
  const double enough =
      std::max(kOwn * render::kMinReportedRmse, std::isfinite(curve.discretization_error) ? 0.5 * curve.discretization_error : 0);
  const std::int64_t start = now_ns();
  const auto share = [&](std::size_t done) { return double(done) / double(all.size()); };
  std::size_t count = 0;
  // errors: of the settings below the resolvable error only one is measured (one for each texel format)
  double best = std::numeric_limits<double>::infinity();
  const auto should_continue = [&](double last) {
    at(0.1 + 0.5 * share(count));
    if (count > 0) best = std::min(best, last);
    const bool sibling = count > 0 && count < all.size() && !all[count].fast && all[count].texel_format != render::TexelFormat::automatic;
    const bool more = count == 0 || ((best > enough || sibling) && 1e-3 * ms_since(start) < kErrorsS);
    count += more;
    return more;
  };
  CATENA_TRY(const render::MeasuredSettings errors, render::measure_rmse(renderer, packet, all, should_continue));
  curve.reference = "converged rays on a regular subset of the pixels";
  // the rounding to 8 bits also limits the resolvable error; most of an error below sqrt(2) times the larger limit is the reference's own
  curve.reference_error = kOwn * std::max(errors.reference_rmse, render::kMinReportedRmse);
  std::vector<tuning::TimedRun> repeats;
  for (std::size_t i = 0; i < errors.rmse.size(); ++i) {
    tuning::Point point;
    point.setting = render::describe(all[i]);
    point.error = errors.rmse[i];
    curve.points.push_back(point);
    made.settings.push_back(all[i]);
    repeats.push_back([&, i]() -> Result<double> {
      at(0.6 + 0.4 * share(i));
      // a change of the texel format uploads the grids first, which does not count
      const render::RenderSettings& last = all[i > 0 ? i - 1 : errors.rmse.size() - 1];
      if (all[i].texel_format != last.texel_format) CATENA_CHECK(renderer.draw(packet, all[i]));
      CATENA_TRY(const double ms, render::measure_render_ms(renderer, packet, all[i]));
      curve.points[i].bytes = static_cast<double>(renderer.stats().gpu_bytes);
      return ms;
    });
  }
  CATENA_CHECK(tuning::time_points(curve, repeats, kTimesS, kRounds));
  at(1);
  curve.front = tuning::pareto_front(curve.points, curve.cost);
  return made;
}

std::optional<ImageCurve> to_image_curve(const Curve& curve, const render::QualityLevelOptions& kind) {
  const std::vector<render::RenderSettings> all = candidate_image_settings(kind);
  ImageCurve made{curve, {}};
  for (const tuning::Point& point : curve.points) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& s) { return render::describe(s) == point.setting; });
    if (found == all.end() || !(point.error >= 0 && point.error <= 255) || !std::isfinite(point.time.median)) return std::nullopt;
    made.settings.push_back(*found);
  }
  if (made.settings.empty()) return std::nullopt;
  return made;
}

ImageTuning::ImageTuning(ImageCurve curve, const scene::TuningTargets& targets)
    : curve_(std::move(curve)), targets_(targets), times_({}, 1) {
  std::vector<double> costs;
  for (const tuning::Point& point : curve_.curve.points) costs.push_back(point.time.median);
  times_ = render::TimeModel(std::move(costs), 1);
  choose_setting();
}

void ImageTuning::set_targets(const scene::TuningTargets& targets) {
  targets_ = targets;
  choose_setting();
}

void ImageTuning::choose_setting() {
  // the curve scaled to the times observed in rendering
  Curve expected = curve_.curve;
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    tuning::Timing& time = expected.points[i].time;
    const double factor = expected_ms(static_cast<int>(i)) / time.median;
    time.lower_quartile *= factor, time.median *= factor, time.upper_quartile *= factor;
  }
  picked_ = tuning::pick_point(expected, {targets_.max_image_error, targets_.max_image_ms});
  current_ = picked_.point = prefer_fewer_bytes(std::max(0, picked_.point));
}

/// Finds a setting with the same rays in another texel format that takes fewer bytes, with sufficient accuracy and about the same time.
int ImageTuning::prefer_fewer_bytes(int point) const {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const std::vector<tuning::Point>& points = curve_.curve.points;
  const double resolvable_error = tuning::min_resolvable_error(curve_.curve);
  const double maximum =
      std::max({resolvable_error, points[at(point)].error, picked_.meets_target ? targets_.max_image_error.value_or(0) : 0});
  int best = point;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const render::RenderSettings &a = curve_.settings[at(i)], &b = curve_.settings[at(point)];
    if (a.fast || b.fast || a.step_voxels != b.step_voxels || a.termination != b.termination) continue;
    if (points[at(i)].error <= maximum && points[at(i)].bytes < points[at(best)].bytes && expected_ms(i) <= kAsQuick * expected_ms(point) &&
        (!targets_.max_image_ms || !picked_.meets_target || expected_ms(i) <= *targets_.max_image_ms))
      best = i;
  }
  return best;
}

void ImageTuning::record_frame_time(double ms) {
  times_.add_measurement(static_cast<std::size_t>(current_), ms);
  const int before = current_;
  const tuning::PickedPoint was = picked_;
  choose_setting();
  // hysteresis: the setting stays while it meets the target and no other is much faster
  const double resolvable_error = tuning::min_resolvable_error(curve_.curve),
               error = std::max(resolvable_error, curve_.curve.points[static_cast<std::size_t>(before)].error);
  const bool stays = targets_.max_image_ms
                         ? expected_ms(before) <= kHolds * *targets_.max_image_ms && expected_ms(before) * kHolds >= expected_ms(current_)
                         : error <= std::max(resolvable_error, targets_.max_image_error.value_or(0)) &&
                               expected_ms(before) <= kHolds * expected_ms(current_);
  if (!stays) return;
  current_ = before;
  picked_ = was;
}

std::vector<double> ImageTuning::error_breakpoints() const {
  const Curve& c = curve_.curve;
  const double resolvable_error = tuning::min_resolvable_error(c);
  std::vector<double> errors;
  for (const int i : tuning::pareto_front(c.points, c.cost)) {
    errors.push_back(std::max(resolvable_error, c.points[static_cast<std::size_t>(i)].error));
    if (errors.back() <= resolvable_error) break;
  }
  return errors;
}

std::string ImageTuning::summary() const {
  std::string text = fmt::format("quality {}={}: {}; expected: error {:.2g}/255 in {:.3g} ms", targets_.max_image_error ? "error" : "time",
                                 to_text(targets_.max_image_error ? *targets_.max_image_error : *targets_.max_image_ms),
                                 render::describe(settings()), expected_error(), expected_ms());
  const Curve& c = curve_.curve;
  const double bytes = c.points[static_cast<std::size_t>(current_)].bytes;
  if (std::isfinite(bytes)) text += fmt::format(", {} on the device", format_bytes(bytes));
  const bool by_data = std::isfinite(c.discretization_error) && c.discretization_error >= tuning::min_resolvable_error(c);
  if (picked_.at_floor)
    text += fmt::format(" (limited to {} of {:.2g}/255)", by_data ? "the discretization error" : "the error of the reference",
                        tuning::min_resolvable_error(c));
  if (!picked_.meets_target)
    text +=
        targets_.max_image_error ? " (the target is not reached: most accurate setting)" : " (the target is not reached: fastest setting)";
  return text;
}

}  // namespace catena::app::tuning
