/// The eye's plan: which settings a picture is drawn with, from measured curves of error against time.
///   error=E  the cheapest setting whose error is at most E, or the data's own if that is greater
///   time=T   the least error within T milliseconds
/// Errors are root mean squares over the covered pixels, 1/255, against converged rays, on the very picture; times are of drawing it
/// (render/quality). Exact rays may read voxels of 16 or 32 bits: of two that are as good and as quick the one of fewer bytes is taken.
/// Fast rays pack words of their own, whatever the voxels. Where pictures follow each other, what each took moves what is expected of all
/// settings (TimeModel), and the next picture may have another one. Frame thread.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/tuning/plan/curve_cache.h"
#include "engine/app/tuning/tradeoff/measure/pareto_choice.h"
#include "render/passes/renderer.h"
#include "render/quality/refinement.h"

namespace catena::app::plan {

/// What can draw the packet: known once it was drawn, which this does.
Result<render::QualityLevelOptions> detect_quality_level_options(render::Renderer& renderer, const render::FramePacket& packet);
/// The ladder of refinement.h up to the reference, exact rays with each format of voxels: what a plan may choose from.
std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind);
/// Those of them that differ on this packet. What is labels, or drawn by no rays (opaque surfaces, slices), is never kept in fewer bits.
std::vector<render::RenderSettings> candidate_image_settings(const render::QualityLevelOptions& kind, const render::FramePacket& packet);

/// A curve and what its points stand for.
struct ImageCurve {
  Curve curve;  ///< error: 1/255; time: ms
  std::vector<render::RenderSettings> settings;
};

/// Measures the picture with settings from the cheapest on, until nothing more exact can be told from the truth. `at`: the share that is
/// done, 0 to 1.
Result<ImageCurve> measure_image_curve(render::Renderer& renderer, const render::FramePacket& packet,
                                       const render::QualityLevelOptions& kind, const std::function<void(double)>& at);
/// Of a kept curve; nothing where one of its points is no setting of this program.
std::optional<ImageCurve> to_image_curve(const Curve& curve, const render::QualityLevelOptions& kind);

class ImageTuning {
 public:
  ImageTuning(ImageCurve curve, const scene::TuningTargets& wanted);

  /// Of the next picture.
  const render::RenderSettings& settings() const { return curve_.settings[static_cast<std::size_t>(current_)]; }
  double expected_error() const { return curve_.curve.points[static_cast<std::size_t>(current_)].error; }
  double expected_ms() const { return expected_ms(current_); }
  /// What that picture took: other settings may follow.
  void record_frame_time(double ms);
  /// Other wishes.
  void set_targets(const scene::TuningTargets& wanted);
  const scene::TuningTargets& targets() const { return targets_; }

  /// The errors at which what is chosen changes, from the fastest setting on; none below what can be told.
  std::vector<double> error_breakpoints() const;
  int current() const { return current_; }
  const Curve& curve() const { return curve_.curve; }

  /// "plan error=2: fast, step 1; expected: error 1.6/255 in 92 ms", and what could not be had or is not asked for.
  std::string summary() const;

 private:
  double expected_ms(int point) const { return times_.expected_ms(static_cast<std::size_t>(point)); }
  void choose_setting();
  int prefer_fewer_bytes(int point) const;

  ImageCurve curve_;
  scene::TuningTargets targets_;
  render::TimeModel times_;
  tradeoff::PickedPoint picked_;
  int current_ = 0;
};

}  // namespace catena::app::plan
