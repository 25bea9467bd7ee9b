// SPDX-License-Identifier: MIT
/// Searches behind choose_quality() (quality.h describes the model): settings for an error or time goal, judged by an ErrorEstimator on
/// which begin() was called. Frame thread.
#pragma once
#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"

namespace catena::render {

/// Ray steps to be tried, voxels: of exact rays and of the fast raycast's.
inline constexpr double kExactSteps[] = {4, 2.8, 2, 1.4, 1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.06, 0.04, 0.03};
inline constexpr double kFastSteps[] = {8, 6, 4, 3, 2, 1.5, 1.2, 1, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.25, 0.18, 0.125};
/// Shares of the error goal available to rays: kBandingShare for shaded exact rays, whose long steps produce rings, more visible than
/// grain, and for which shorter steps cost little; kStepShare for fast rays, to whose error interpolation adds; kFacetShare for rays shaded
/// by the gradient of the cell, which produces facets.
inline constexpr double kBandingShare = 0.5, kStepShare = 0.93, kFacetShare = 0.5;
inline constexpr double kPlateauRatio = 0.95;  ///< an error above this fraction of the error of a longer step counts as no improvement
/// Sets the termination of the fast raycast's rays so that they omit no more than `error`, 1/255, permits.
void set_termination_for(double error, RenderSettings& settings);

/// Returns a choice with the data of the estimator.
QualityChoice make_choice(const ErrorEstimator& estimator, const RenderSettings& settings, double error, bool reached = true);

/// Searches for the cheapest settings with an error of at most `e`, 1/255.
Result<QualityChoice> find_settings_for_error(ErrorEstimator& estimator, double e, const SearchProgress& progress);
/// Searches for settings of an image that is rendered only once; the estimator may be of reduced size.
Result<QualityChoice> find_settings_for_single_image(ErrorEstimator& estimator, double e);
/// Searches for the settings with the smallest error within `ms` milliseconds.
Result<QualityChoice> find_settings_for_time(ErrorEstimator& estimator, double ms, const SearchProgress& progress,
                                             const RenderTimeFn& timer);

}  // namespace catena::render
