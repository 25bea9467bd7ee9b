// SPDX-License-Identifier: MIT
/// Discretization error: how far a grid of spacing h determines the field that it samples, estimated from the grid alone.
///   E(c h) ~ C (c h)^p;  the grid is subsampled to spacings 2 h and 4 h, whose errors can be measured; the observed order p gives E(h)
/// The grid is first cropped to 4 k + 1 voxels per axis, so that all three spacings cover the same domain. Not for the haptic thread.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/field/grid/grid.h"

namespace catena::app::tuning {

/// An error extrapolated to the grid spacing h.
struct ExtrapolatedError {
  double error = 0;          ///< Error at the spacing h, in the unit of the measured errors.
  double order = 0;          ///< Observed order p, at most 4.
  bool is_converged = true;  ///< The errors decrease with the spacing as expected; if false, an error from differences is a lower bound.
};

/// Extrapolates from errors at 2 h and 4 h against the true field:  p = log2(E4 / E2),  E(h) = E2 / 2^p
ExtrapolatedError extrapolate_from_errors(double at_2h, double at_4h);
/// Extrapolates from the differences of 2 h and 4 h from h:  d4 / d2 = (4^p - 1) / (2^p - 1) = 2^p + 1,  E(h) = d2 / (2^p - 1).
/// If that gives an order below 0.9, as edges and noise do, order 2 of linear interpolation is assumed: too low an estimate selects too
/// fine a setting, too high an estimate too coarse a one.
ExtrapolatedError extrapolate_from_differences(double at_2h, double at_4h);

/// Returns "observed order 1.9"; if not converged, a text that states the lower bound used instead.
std::string describe_order(const ExtrapolatedError& e);

/// A grid at spacings h, 2 h and 4 h over one domain.
template <class Grid>
struct ResolutionLevels {
  std::shared_ptr<const Grid> grids[3];
};
/// Returns the three grids; nothing if the grid has fewer than nine voxels along an axis, or more than `max_voxels` in total.
std::optional<ResolutionLevels<field::ScalarGrid>> make_resolution_levels(const field::ScalarGrid& grid, double max_voxels = 1.5e8);
std::optional<ResolutionLevels<field::VectorGrid>> make_resolution_levels(const field::VectorGrid& grid, double max_voxels = 5e7);

/// Root mean square error of the field's interpolation (linear or cubic), in the unit of the field: measured at 2 h and 4 h at the voxels
/// in between, extrapolated to h.
struct InterpolationError {
  ExtrapolatedError at_h;
  double at_2h = 0, at_4h = 0;
  double scale = 0;  ///< Scale of the field: largest minus smallest value; for vectors twice the largest length.
};
/// Estimates it; nothing for formulas, label maps, and grids that cannot be subsampled.
std::optional<InterpolationError> estimate_interpolation_error(const field::AnyField& field);

}  // namespace catena::app::tuning
