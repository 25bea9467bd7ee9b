// SPDX-License-Identifier: MIT
/// Search for the cheapest settings of the fast raycast that meet an error goal (quality.h describes the model): ray steps are tested on
/// the sample grid, with both kinds of gradients; those that meet the goal there are rendered with every interpolation plan, the cheapest
/// first, until none is left that would cost less than the best. Requires an ErrorEstimator on which begin() was called and that outlives
/// this object. Frame thread.
#pragma once
#include <optional>
#include <vector>

#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"

namespace catena::render {

/// Search for settings of the fast raycast by error.
class FastSettingsSearch {
 public:
  /// `error`: goal for the covered RMSE, 1/255.
  FastSettingsSearch(ErrorEstimator& estimator, double error, const SearchProgress& progress);
  /// Returns the best choice; nullopt if no settings meet the goal.
  Result<std::optional<QualityChoice>> find();

 private:
  /// Ray grid spacing and refinement. Refinement thresholds are fractions of the error goal.
  struct InterpolationPlan {
    std::uint32_t spacing;
    double refine_half, refine_full;
    /// Initial guess of the rays refined at every 2nd pixel and at every pixel, as shares of all covered rays of that spacing.
    std::array<double, 2> refined_shares;
  };
  static constexpr InterpolationPlan kPlans[] = {{4, -1, -1, {0, 0}},    {4, 1.3, -1, {0.4, 0}}, {2, 0, -1, {0, 0}},
                                                 {4, 1, 3, {0.45, 0.1}}, {2, 0, 2, {0, 0.15}},   {2, 0, 1.5, {0, 0.22}},
                                                 {2, 0, 0.8, {0, 0.37}}, {1, 0, -1, {0, 0}}};

  /// Settings to be tried as an image.
  struct Candidate {
    RenderSettings settings;
    double ray_rmse, rmse_upper_bound;  ///< error of the rays alone (ErrorEstimate)
    std::size_t plan;
  };
  /// Results of the images of a plan, for one kind of gradients: of the cell, or central differences.
  struct Attempts {
    std::optional<double> interpolation_rmse;  ///< error added by interpolation when it was last too large
    int failures = 0;                          ///< number of images, each at another step, that missed thin features or had outlier pixels
  };

  RenderSettings make_settings(const InterpolationPlan& plan, double step, bool smooth) const;
  double cost(const Candidate& candidate) const;
  Attempts& attempts(const Candidate& candidate) { return attempts_[candidate.settings.fast->smooth_gradients][candidate.plan]; }
  bool is_hopeless(const Candidate& candidate);
  void update_refined_shares(std::size_t plan, const std::array<double, 2>& found);
  void accept(const Candidate& candidate, double above);

  Outcome add_candidates(bool smooth);
  Outcome try_full_resolution();
  Outcome try_interpolation(const Candidate& candidate);

  ErrorEstimator& estimator_;
  const double error_;
  const SearchProgress& progress_;
  std::vector<Candidate> candidates_;
  bool skips_empty_space_ = false;  ///< unshaded rays skip empty space
  std::array<std::array<double, 2>, std::size(kPlans)> refined_shares_;
  Attempts attempts_[2][std::size(kPlans)];
  std::optional<QualityChoice> best_;
  double best_cost_;
};

}  // namespace catena::render
