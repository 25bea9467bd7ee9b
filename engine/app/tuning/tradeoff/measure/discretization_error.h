/// The data's own error: what a grid with spacing h leaves open about the field that it samples, estimated from the grid alone.
///   E(c h) ~ C (c h)^p;  the grid is subsampled to spacings 2 h and 4 h, whose errors can be seen; the observed order p leads on to h
/// The grid is cropped to 4 k + 1 voxels an axis first, so that all three spacings have one domain. Off the tick, any thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/field/grid/grid.h"

namespace catena::app::tradeoff {

struct ExtrapolatedError {
  double error = 0;          ///< at the spacing h
  double order = 0;          ///< p, as observed, at most 4
  bool is_converged = true;  ///< the errors fall as the spacing does; if not, that of differences is the least that it can be
};

/// From errors at 2 h and 4 h that were measured against the truth:  p = log2(E4 / E2),  E(h) = E2 / 2^p
ExtrapolatedError extrapolate_from_errors(double at_2h, double at_4h);
/// From what 2 h and 4 h differ from h by:  d4 / d2 = (4^p - 1) / (2^p - 1) = 2^p + 1,  E(h) = d2 / (2^p - 1).
/// Where that is below order 0.9, as edges and noise make it, the order of linear interpolation, 2, is taken: a floor that is too low
/// chooses too fine a setting, one that is too high too coarse a one.
ExtrapolatedError extrapolate_from_differences(double at_2h, double at_4h);

/// "observed order 1.9"; of differences that fall too slowly for one: what is taken instead.
std::string describe_order(const ExtrapolatedError& e);

/// A grid at spacings h, 2 h and 4 h over one domain.
template <class Grid>
struct ResolutionLevels {
  std::shared_ptr<const Grid> grids[3];
};
/// Nothing where the grid has fewer than nine voxels along an axis, or more than `most` in all.
std::optional<ResolutionLevels<field::ScalarGrid>> make_resolution_levels(const field::ScalarGrid& grid, double most = 1.5e8);
std::optional<ResolutionLevels<field::VectorGrid>> make_resolution_levels(const field::VectorGrid& grid, double most = 5e7);

/// Root mean square of the field's own interpolation's error (linear or cubic), in its own unit: seen at 2 h and 4 h at the voxels between,
/// extrapolated to h.
struct InterpolationError {
  ExtrapolatedError at_h;
  double at_2h = 0, at_4h = 0;
  double scale = 0;  ///< of the field: greatest less least value; of vectors twice the greatest length
};
std::optional<InterpolationError> estimate_interpolation_error(const field::AnyField& field);

}  // namespace catena::app::tradeoff
