/// The search behind choose_quality (quality.h has the model): settings for a stated error or time, judged on a lattice that has begun.
/// Frame thread.
#pragma once
#include "render/quality/error_estimator.h"
#include "render/quality/quality.h"

namespace catena::render {

/// Ray steps that are tried, voxels: of exact rays, of the fast raycast's.
inline constexpr double kExactSteps[] = {4, 2.8, 2, 1.4, 1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.06, 0.04, 0.03};
inline constexpr double kFastSteps[] = {8, 6, 4, 3, 2, 1.5, 1.2, 1, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.25, 0.18, 0.125};
/// Shares of the error that rays may have: exact ones of what is lit, whose long steps draw rings, which are seen sooner than grain is,
/// and shorter steps cost them little; fast ones, which interpolation adds to; those lit by the gradient of the cell, which draws facets.
inline constexpr double kBandingShare = 0.5, kStepShare = 0.93, kFacetShare = 0.5;
inline constexpr double kPlateauRatio = 0.95;  ///< of the error of a longer step: hardly less
/// The fast raycast's rays may end where they leave out no more than the error, 1/255, says.
void set_termination_for(double error, RenderSettings& settings);

QualityChoice make_choice(const ErrorEstimator& lattice, const RenderSettings& settings, double error, bool reached = true);

Result<QualityChoice> find_settings_for_error(ErrorEstimator& lattice, double e, const SearchProgress& progress);
/// For a picture that is drawn once; the lattice may be a small one.
Result<QualityChoice> find_settings_for_single_image(ErrorEstimator& lattice, double e);
Result<QualityChoice> find_settings_for_time(ErrorEstimator& lattice, double ms, const SearchProgress& progress, const RenderTimeFn& timer);

}  // namespace catena::render
