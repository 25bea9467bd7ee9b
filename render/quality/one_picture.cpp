#include "render/quality/one_picture.h"

#include <cmath>
#include <limits>

#include "engine/field/grid.h"
#include "render/quality/refinement.h"
#include "render/quality/search.h"

namespace catena::render {
namespace {

// Work, in samples of unlit exact rays. Of the way through a cube of voxels what rays go that let light through, and that end in it; a
// sample that is lit; a voxel in the form of fast rays, where processor or GPU draw; a picture of fast rays, as a share of that of exact
// ones of step 1; and that from which on interpolation is tried.
constexpr double kThrough = 0.6, kEnding = 0.25, kLit = 3, kPacking = 2, kPackingForGpu = 100, kFastShare = 0.25, kWorthTrying = 6e6;
constexpr double kRefineHalf = 1, kRefineFull = 3;  // errors

RenderSettings fast_rays(double step, double error, bool smooth) {
  RenderSettings s = fast_rung(step, 1, 0, -1, smooth);
  end_rays_for(error, s);
  return s;
}

}  // namespace

double OnePicture::voxels() const {
  double bytes = 0;
  for (const VolumeItem& item : lattice_.packet().volumes) bytes += double(item.grid->bytes());
  return bytes / sizeof(float);
}

double OnePicture::work_of_rays(double step) const {
  const double opaque = lattice_.opaque_share(), way = std::cbrt(voxels()) * (kThrough * (1 - opaque) + kEnding * opaque);
  return lattice_.covered() * way * (kStepless + 1 / step) * (lattice_.shaded() ? kLit : 1);
}

Result<std::optional<OnePicture::Rays>> OnePicture::exact() const {
  for (const double step : kExactSteps) {
    if (step < 2 * lattice_.truth_step()) break;  // they are judged by what is finer than they are
    CATENA_TRY(const LatticeError error, lattice_.of_rays(exact_rung(step)));
    if (error.good_for(error_)) return std::optional(Rays{exact_rung(step), error.above});
  }
  return std::optional<Rays>();
}

Result<std::optional<OnePicture::Rays>> OnePicture::fast(bool smooth) const {
  const bool facets = !smooth && lattice_.shaded();
  double before = std::numeric_limits<double>::infinity();
  for (const double step : kFastSteps) {
    const RenderSettings settings = fast_rays(step, error_, smooth);
    CATENA_TRY(const LatticeError error, lattice_.of_rays(settings));
    if (error.rmse > error_ && error.rmse > kStill * before) break;
    before = error.rmse;
    if (error.rmse > (facets ? kFacetShare : kStepShare) * error_ || !error.good_for(error_)) continue;
    if (lattice_.lattice_keeps_what_is_thin(error_)) return std::optional(Rays{settings, error.above});
  }
  return std::optional<Rays>();
}

Result<std::optional<QualityChoice>> OnePicture::interpolated(const Rays& rays) const {
  RenderSettings settings = rays.settings;
  settings.fast->spacing = 4;
  settings.fast->refine_half_255 = kRefineHalf * error_;
  settings.fast->refine_full_255 = kRefineFull * error_;
  settings.keep = true;
  CATENA_TRY(const LatticeError error, lattice_.of_picture(settings));
  if (!error.good_for(error_) || !lattice_.lattice_keeps_what_is_thin(error_)) return std::optional<QualityChoice>();
  return std::optional(choice_of(lattice_, settings, error.above));
}

Result<std::optional<QualityChoice>> OnePicture::find() {
  CATENA_TRY(const std::optional<Rays> exact_rays, exact());
  const double packing = (lattice_.renderer().device().info().is_cpu() ? kPacking : kPackingForGpu) * voxels();
  const double fast_work = kFastShare * work_of_rays(1);
  const auto best_exact = [&]() -> std::optional<QualityChoice> {
    if (!exact_rays) return std::nullopt;
    return choice_of(lattice_, exact_rays->settings, exact_rays->above);
  };
  if (exact_rays && work_of_rays(exact_rays->settings.step_voxels) <= packing + fast_work) return best_exact();
  CATENA_TRY(const bool can_be_fast, lattice_.begin_fast());
  if (!can_be_fast) return best_exact();
  CATENA_TRY(std::optional<Rays> rays, fast(false));
  if (!rays && lattice_.shaded()) {
    CATENA_TRY(rays, fast(true));
  }
  if (!rays) return best_exact();
  if (fast_work > kWorthTrying) {
    CATENA_TRY(const std::optional<QualityChoice> picture, interpolated(*rays));
    if (picture) return picture;
  }
  return std::optional(choice_of(lattice_, rays->settings, rays->above));
}

}  // namespace catena::render
