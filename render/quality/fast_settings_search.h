/// The cheapest settings of the fast raycast whose picture is as good as stated (quality.h has the model): ray steps are tried on the
/// lattice, with either light; those that are good enough there become pictures with every plan of interpolation, the cheapest first, until
/// none is left that would cost less than the best. A lattice that has begun, and lives longer. Frame thread.
#pragma once
#include <optional>
#include <vector>

#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"

namespace catena::render {

class FastSettingsSearch {
 public:
  /// `error`: covered RMSE, 1/255.
  FastSettingsSearch(ErrorEstimator& lattice, double error, const SearchProgress& progress);
  /// Nothing where none is good enough.
  Result<std::optional<QualityChoice>> find();

 private:
  /// How rays become a picture. Thresholds of refinement in shares of the error.
  struct InterpolationPlan {
    std::uint32_t spacing;
    double refine_half, refine_full;
    std::array<double, 2> refined_shares;  ///< rays of every 2nd pixel, of every pixel, by all such that show something: a guess
  };
  static constexpr InterpolationPlan kPlans[] = {{4, -1, -1, {0, 0}},    {4, 1.3, -1, {0.4, 0}}, {2, 0, -1, {0, 0}},
                                                 {4, 1, 3, {0.45, 0.1}}, {2, 0, 2, {0, 0.15}},   {2, 0, 1.5, {0, 0.22}},
                                                 {2, 0, 0.8, {0, 0.37}}, {1, 0, -1, {0, 0}}};

  struct Candidate {
    RenderSettings settings;
    double ray_rmse, rmse_upper_bound;  ///< of the rays alone: ErrorEstimate
    std::size_t plan;
  };
  /// What the pictures of a plan were, with one light: by the gradient of the cell, by central differences.
  struct Attempts {
    std::optional<double> interpolation_rmse;  ///< the error that it added, the last time that it was too much
    int failures = 0;                          ///< pictures that lost what is thin, or had a few pixels far off, at so many steps
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
  bool skips_empty_space_ = false;  ///< unlit rays that leap over what is empty
  std::array<std::array<double, 2>, std::size(kPlans)> refined_shares_;
  Attempts attempts_[2][std::size(kPlans)];
  std::optional<QualityChoice> best_;
  double best_cost_;
};

}  // namespace catena::render
