/// Settings for one picture that is drawn once, found at little cost beside it (quality.h has the errors). Rays are measured on a small
/// lattice; a finished picture is drawn only where it may become the one that is asked for.
///   1  exact rays, unless even their longest steps are more work than 2: the longest step whose rays are good enough
///   2  fast rays, where exact ones are more work than to bring the grid to the device in the form of fast ones and to march these: the
///      longest step whose rays are good enough, lit by central differences (light by the gradient of the cell saves a third of the rays'
///      time, and to find out whether it is good enough costs more)
///   3  every 4th pixel, refined where it is needed, with rays of that step: drawn, where every pixel is much work. Where that is not good
///      enough, it is refined further, and if that is not enough either, every pixel is marched
/// Steps are tried from a middle one on, to longer ones while they are good enough, or to shorter ones until one is.
/// Work is counted in samples of unlit exact rays, not timed, so that the choice is the same in every run:
///   rays     voxels on the way (ray_way.h), those that are lit counted more, x (0.3 + 1 / step)
///   packing  so many samples a voxel that is kept, more with its gradient, as measured
/// The steadiness of the error while the camera moves is not measured. The lattice must have begun, and must outlive this. Frame thread.
#pragma once
#include <optional>
#include <span>

#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"
#include "render/quality/ray_path_length.h"

namespace catena::render {

class SingleImageSearch {
 public:
  /// `error`: covered RMSE, 1/255.
  SingleImageSearch(ErrorEstimator& lattice, double error) : estimator_(lattice), error_(error) {}
  /// Nothing where no rays are good enough.
  Result<std::optional<QualityChoice>> find();

 private:
  struct RayCandidate {
    RenderSettings settings;
    double rmse_upper_bound;  ///< of the rays alone: ErrorEstimate
  };
  /// The longest of the steps (they fall) whose rays are good enough; `share` of the error is for the rays. Nothing: none is.
  template <class MakeSettings>
  Result<std::optional<RayCandidate>> find_longest_step(std::span<const double> steps, double first, double share,
                                                        MakeSettings&& settings_of) const;
  Result<std::optional<RayCandidate>> find_exact() const;
  /// Of every pixel.
  Result<std::optional<RayCandidate>> find_fast() const;
  /// Nothing where it is not good enough.
  Result<std::optional<QualityChoice>> find_interpolated(const RayCandidate& rays) const;
  /// Samples of a picture of exact rays.
  double ray_work(double step) const;
  double packing_work() const;

  ErrorEstimator& estimator_;
  RayPathLength path_length_;  ///< where there is a choice
  const double error_;
};

}  // namespace catena::render
