// SPDX-License-Identifier: MIT
/// Search for settings of an image that is rendered only once, at a small cost compared with the image (quality.h defines the errors). Rays
/// are measured on a small sample grid; a finished image is rendered only if it may become the result.
///   1  exact rays, unless even their longest steps take more work than 2: the longest step whose rays meet the error goal
///   2  fast rays, where exact ones take more work than packing the grid for fast ones and marching these: the longest step whose rays meet
///      the goal, shaded by central differences (shading by the gradient of the cell saves a third of the rays' time, but testing whether
///      it meets the goal costs more)
///   3  every 4th pixel, refined where needed, with rays of that step: rendered where every pixel is much work. If that does not
///      meet the goal, it is refined further, and if that is not enough either, every pixel is marched
/// Steps are tried from a middle one on, to longer ones while they meet the goal, or to shorter ones until one does. Work is counted in
/// samples of unshaded exact rays, not timed, so that the choice is reproducible:
///   rays     path length in voxels (ray_path_length.h), shaded ones weighted higher, x (0.3 + 1 / step)
///   packing  a number of samples per stored voxel, more with its gradient, as measured
/// Temporal stability is not tested. begin() must have been called on the estimator, which must outlive this object. Frame thread.
#pragma once
#include <optional>
#include <span>

#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"
#include "render/quality/ray_path_length.h"

namespace catena::render {

/// Search for settings of a single image by error.
class SingleImageSearch {
 public:
  /// `error`: goal for the covered RMSE, 1/255.
  SingleImageSearch(ErrorEstimator& estimator, double error) : estimator_(estimator), error_(error) {}
  /// Returns the choice; nullopt if no rays meet the goal.
  Result<std::optional<QualityChoice>> find();

 private:
  /// Ray settings that meet the goal.
  struct RayCandidate {
    RenderSettings settings;
    double rmse_upper_bound;  ///< upper bound of the error of the rays alone (ErrorEstimate)
  };
  /// Returns the longest of the steps (in falling order) whose rays meet `share` of the error goal; nullopt if none does. `first`: step to
  /// begin with.
  template <class MakeSettings>
  Result<std::optional<RayCandidate>> find_longest_step(std::span<const double> steps, double first, double share,
                                                        MakeSettings&& settings_of) const;
  Result<std::optional<RayCandidate>> find_exact() const;
  /// Searches at every pixel, without interpolation.
  Result<std::optional<RayCandidate>> find_fast() const;
  /// Returns nullopt if interpolation does not meet the goal.
  Result<std::optional<QualityChoice>> find_interpolated(const RayCandidate& rays) const;
  /// Returns the number of samples of an image of exact rays.
  double ray_work(double step) const;
  /// Returns the cost of packing the grid, in samples.
  double packing_work() const;

  ErrorEstimator& estimator_;
  RayPathLength path_length_;  ///< measured only if there is a choice
  const double error_;
};

}  // namespace catena::render
