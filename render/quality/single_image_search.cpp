// SPDX-License-Identifier: MIT
#include "render/quality/single_image_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/field/grid/grid.h"
#include "render/quality/refinement.h"
#include "render/quality/settings_search.h"
#include "render/residency/packed_volume.h"

namespace catena::render {
namespace {

// Work in units of samples of unshaded exact rays: a shaded sample; packing a voxel for fast rays, with a CPU and with a GPU driver, and
// its factor with gradients; an image of fast rays with its search, as a share of exact rays of step 1, unshaded and shaded (a shaded fast
// ray reads its gradient, an exact one differentiates the cell); minimum work for which interpolation is tried.
constexpr double kShadedSample = 8, kPacking = 4.5, kPackingForGpu = 200, kWithGradient = 2, kFastShare = 0.5, kShadedFastShare = 0.3,
                 kMinInterpolationWork = 4.5e7;
constexpr std::array<double, 2> kRefine[] = {
    {1, 3}, {0.4, 1}};  // refinement thresholds at every 2nd pixel and at every pixel, as shares of the error goal
constexpr double kFirstExactStep = 1.4, kFirstFastStep = 2;  // voxels

RenderSettings fast_rays(double step, double error, bool smooth) {
  RenderSettings s = fast_level(step, 1, 0, -1, smooth);
  set_termination_for(error, s);
  return s;
}

}  // namespace

double SingleImageSearch::packing_work() const {
  vk::Device& device = estimator_.renderer().device();
  double voxels = 0;
  for (const VolumeItem& item : estimator_.packet().volumes) {
    const std::size_t bytes = can_pack_dense(device, *item.grid) ? packed_bytes(*item.grid, false) : item.grid->bytes();
    voxels += double(bytes) / sizeof(float);
  }
  return voxels * (device.info().is_cpu() ? kPacking : kPackingForGpu) * (estimator_.is_shaded() ? kWithGradient : 1);
}

double SingleImageSearch::ray_work(double step) const {
  return (path_length_.marched + (estimator_.is_shaded() ? kShadedSample - 1 : 0) * path_length_.visible) * (kFixedRayCost + 1 / step);
}

template <class MakeSettings>
Result<std::optional<SingleImageSearch::RayCandidate>> SingleImageSearch::find_longest_step(std::span<const double> steps, double first,
                                                                                            double share,
                                                                                            MakeSettings&& settings_of) const {
  std::optional<RayCandidate> best;
  double best_step = 0;
  const auto try_step = [&](std::size_t i) -> Result<bool> {
    const RenderSettings settings = settings_of(steps[i]);
    CATENA_TRY(const ErrorEstimate error, estimator_.estimate_rays(settings));
    const bool good = error.rmse <= share * error_ && error.meets(error_) && estimator_.samples_preserve_thin_features(error_);
    if (good) best = RayCandidate{settings, error.upper_bound}, best_step = steps[i];
    return good;
  };
  const auto middle = static_cast<std::size_t>(std::ranges::find(steps, first) - steps.begin());
  CATENA_ASSERT(middle < steps.size());
  for (std::size_t i = middle; i < steps.size() && !best; ++i) CATENA_CHECK(try_step(i));
  if (!best || best_step != first) return best;
  for (std::size_t i = middle; i-- > 0;) {
    CATENA_TRY(const bool good, try_step(i));
    if (!good) break;
  }
  return best;
}

Result<std::optional<SingleImageSearch::RayCandidate>> SingleImageSearch::find_exact() const {
  // the reference must be finer than the tested step
  const auto fine = std::ranges::find_if(kExactSteps, [this](double step) { return step < 2 * estimator_.reference_step(); });
  return find_longest_step({std::begin(kExactSteps), fine}, kFirstExactStep, 1, exact_level);
}

Result<std::optional<SingleImageSearch::RayCandidate>> SingleImageSearch::find_fast() const {
  return find_longest_step(kFastSteps, kFirstFastStep, kStepShare,
                           [this](double step) { return fast_rays(step, error_, estimator_.is_shaded()); });
}

Result<std::optional<QualityChoice>> SingleImageSearch::find_interpolated(const RayCandidate& rays) const {
  RenderSettings settings = rays.settings;
  settings.fast->spacing = 4;
  settings.reuse_rays = true;
  for (const auto [half, full] : kRefine) {
    settings.fast->refine_half_255 = half * error_;
    settings.fast->refine_full_255 = full * error_;
    CATENA_TRY(const ErrorEstimate error, estimator_.estimate_image(settings));
    if (error.meets(error_) && estimator_.samples_preserve_thin_features(error_))
      return std::optional(make_choice(estimator_, settings, error.upper_bound));
  }
  return std::optional<QualityChoice>();
}

Result<std::optional<QualityChoice>> SingleImageSearch::find() {
  const auto chosen = [this](const std::optional<RayCandidate>& rays) -> std::optional<QualityChoice> {
    if (!rays) return std::nullopt;
    return make_choice(estimator_, rays->settings, rays->rmse_upper_bound);
  };
  std::optional<RayCandidate> exact_rays;
  if (!estimator_.renderer().can_draw_fast(estimator_.packet())) {
    CATENA_TRY(exact_rays, find_exact());
    return chosen(exact_rays);
  }
  path_length_ = measure_ray_path_length(estimator_.packet());
  const double packing = packing_work(), fast_work = (estimator_.is_shaded() ? kShadedFastShare : kFastShare) * ray_work(1);
  const bool exact_first = ray_work(kExactSteps[0]) <= packing + fast_work;
  if (exact_first) {
    CATENA_TRY(exact_rays, find_exact());
    if (exact_rays && ray_work(exact_rays->settings.step_voxels) <= packing + fast_work) return chosen(exact_rays);
  }
  CATENA_TRY(const bool can_be_fast, estimator_.prepare_fast());
  std::optional<RayCandidate> rays;
  if (can_be_fast) {
    CATENA_TRY(rays, find_fast());
  }
  if (!rays) {
    if (!exact_first) {
      CATENA_TRY(exact_rays, find_exact());
    }
    return chosen(exact_rays);
  }
  if (fast_work > kMinInterpolationWork) {
    CATENA_TRY(const std::optional<QualityChoice> image, find_interpolated(*rays));
    if (image) return image;
  }
  return chosen(rays);
}

}  // namespace catena::render
