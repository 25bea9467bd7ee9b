/// The cheapest settings of the fast raycast whose picture is as good as stated (quality.h has the model): ray steps are tried on the
/// lattice, with either light; those that are good enough there become pictures with every plan of interpolation, the cheapest first, until
/// none is left that would cost less than the best. A lattice that has begun, and lives longer. Frame thread.
#pragma once
#include <optional>
#include <vector>

#include "render/quality/lattice.h"
#include "render/quality/quality.h"

namespace catena::render {

class FastSearch {
 public:
  /// `error`: covered RMSE, 1/255.
  FastSearch(Lattice& lattice, double error, const SearchProgress& progress);
  /// Nothing where none is good enough.
  Result<std::optional<QualityChoice>> find();

 private:
  /// How rays become a picture. Thresholds of refinement in shares of the error.
  struct Plan {
    std::uint32_t spacing;
    double refine_half, refine_full;
    std::array<double, 2> refined;  ///< rays of every 2nd pixel, of every pixel, by all such that show something: a guess
  };
  static constexpr Plan kPlans[] = {{4, -1, -1, {0, 0}},  {4, 1.3, -1, {0.4, 0}}, {2, 0, -1, {0, 0}},     {4, 1, 3, {0.45, 0.1}},
                                    {2, 0, 2, {0, 0.15}}, {2, 0, 1.5, {0, 0.22}}, {2, 0, 0.8, {0, 0.37}}, {1, 0, -1, {0, 0}}};

  struct Candidate {
    RenderSettings settings;
    double rays, above;  ///< of the rays alone: LatticeError
    std::size_t plan;
  };
  /// What the pictures of a plan were, with one light: by the gradient of the cell, by central differences.
  struct Tried {
    std::optional<double> interpolation;  ///< the error that it added, the last time that it was too much
    int lost = 0;                         ///< pictures that lost what is thin, or had a few pixels far off, at so many steps
  };

  RenderSettings planned(const Plan& plan, double step, bool smooth) const;
  double cost(const Candidate& candidate) const;
  Tried& tried(const Candidate& candidate) { return tried_[candidate.settings.fast->smooth_gradients][candidate.plan]; }
  bool is_hopeless(const Candidate& candidate);
  void learn(std::size_t plan, const std::array<double, 2>& found);
  void take(const Candidate& candidate, double above);

  Outcome add_candidates(bool smooth);
  Outcome try_every_ray();
  Outcome try_interpolation(const Candidate& candidate);

  Lattice& lattice_;
  const double error_;
  const SearchProgress& progress_;
  std::vector<Candidate> candidates_;
  bool leaps_ = false;  ///< unlit rays that leap over what is empty
  std::array<std::array<double, 2>, std::size(kPlans)> refined_;
  Tried tried_[2][std::size(kPlans)];
  std::optional<QualityChoice> best_;
  double best_cost_;
};

}  // namespace catena::render
