// SPDX-License-Identifier: MIT
/// Image tuning: the choice of render settings from measured curves of error against time.
///   error=E  the cheapest setting whose error is at most E, or at most the discretization error if that is larger
///   time=T   the setting of least error within T milliseconds
/// Errors are root mean squares over the covered pixels, in 1/255, against converged rays, measured on the image itself; times are those of
/// rendering it (render/quality). Exact rays can read voxels of 16 or 32 bits: of two settings of equal error and similar time, the one
/// with fewer bytes is chosen. Fast rays use their own packed format, whatever the voxels. In a sequence of frames each measured time
/// updates the expected times of all settings (TimeModel), so that the next frame may use another setting. Frame thread.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/store/curve_cache.h"
#include "render/passes/renderer.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {

/// Returns which ray casting methods can render the packet. Renders it once to find out; an Error if that fails.
Result<render::QualityLevelOptions> detect_quality_level_options(render::Renderer& renderer, const render::FramePacket& packet);
/// Returns all settings a tuning can choose from: the quality levels of refinement.h up to the reference, exact rays with each texel
/// format.
std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind);
/// Returns those of them that differ on this packet. Label maps, and grids rendered without rays (opaque surfaces, slices), are never
/// stored in fewer bits.
std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind, const render::FramePacket& packet);

/// A curve together with the render settings of its points.
struct ImageCurve {
  Curve curve;                                   ///< Error in 1/255, time in ms.
  std::vector<render::RenderSettings> settings;  ///< One per point.
};

/// Measures the image with settings from the cheapest on, until a more exact one could not be distinguished from the reference image. `at`
/// receives the progress, 0 to 1. An Error if rendering fails.
Result<ImageCurve> measure_image_curve(render::Renderer& renderer, const render::FramePacket& packet,
                                       const render::QualityLevelOptions& kind, const std::function<void(double)>& at);
/// Returns the settings of a cached curve; nothing if one of its points is not a setting of this program or has invalid values.
std::optional<ImageCurve> to_image_curve(const Curve& curve, const render::QualityLevelOptions& kind);

/// The setting in use for a target, chosen from an ImageCurve and updated with measured frame times.
class ImageTuning {
 public:
  ImageTuning(ImageCurve curve, const scene::TuningTargets& targets);

  /// Settings of the next frame.
  const render::RenderSettings& settings() const { return curve_.settings[static_cast<std::size_t>(current_)]; }
  double expected_error() const { return curve_.curve.points[static_cast<std::size_t>(current_)].error; }
  double expected_ms() const { return expected_ms(current_); }
  /// Updates the time model with the time of the frame just rendered; settings() may change.
  void record_frame_time(double ms);
  /// Replaces the targets and chooses again.
  void set_targets(const scene::TuningTargets& targets);
  const scene::TuningTargets& targets() const { return targets_; }

  /// Errors at which the choice changes, from the fastest setting on; none below the resolvable error.
  std::vector<double> error_breakpoints() const;
  /// Index of the current point of the curve.
  int current() const { return current_; }
  const Curve& curve() const { return curve_.curve; }

  /// Returns "quality error=2: fast, step 1; expected: error 1.6/255 in 92 ms", with a remark if the target cannot be met or lies below the
  /// resolvable error.
  std::string summary() const;

 private:
  double expected_ms(int point) const { return times_.expected_ms(static_cast<std::size_t>(point)); }
  void choose_setting();
  int prefer_fewer_bytes(int point) const;

  ImageCurve curve_;
  scene::TuningTargets targets_;
  render::TimeModel times_;
  tuning::PickedPoint picked_;
  int current_ = 0;
};

}  // namespace catena::app::tuning
