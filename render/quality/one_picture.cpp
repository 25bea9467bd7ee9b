#include "render/quality/one_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/field/grid.h"
#include "render/mirror/packed_volume.h"
#include "render/quality/refinement.h"
#include "render/quality/search.h"

namespace catena::render {
namespace {

// Work, in samples of unlit exact rays: a sample that is lit; a voxel in the form of fast rays, where processor or GPU draw, and with its
// gradient so many times that; a picture of fast rays and their search, as a share of that of exact ones of step 1, unlit and lit (a lit
// fast ray reads its gradient, where an exact one differentiates the cell); and that from which on interpolation is tried.
constexpr double kLit = 8, kPacking = 4.5, kPackingForGpu = 200, kWithGradient = 2, kFastShare = 0.5, kLitFastShare = 0.3,
                 kWorthTrying = 4.5e7;
constexpr std::array<double, 2> kRefine[] = {{1, 3}, {0.4, 1}};  // errors above which every 2nd, every pixel is marched
constexpr double kFirstExactStep = 1.4, kFirstFastStep = 2;      // voxels

RenderSettings fast_rays(double step, double error, bool smooth) {
  RenderSettings s = fast_rung(step, 1, 0, -1, smooth);
  end_rays_for(error, s);
  return s;
}

}  // namespace

double OnePicture::work_of_packing() const {
  vk::Device& device = lattice_.renderer().device();
  double voxels = 0;
  for (const VolumeItem& item : lattice_.packet().volumes) {
    const std::size_t bytes = can_be_packed(device, *item.grid) ? packed_bytes(*item.grid, false) : item.grid->bytes();
    voxels += double(bytes) / sizeof(float);
  }
  return voxels * (device.info().is_cpu() ? kPacking : kPackingForGpu) * (lattice_.shaded() ? kWithGradient : 1);
}

double OnePicture::work_of_rays(double step) const {
  return (way_.marched + (lattice_.shaded() ? kLit - 1 : 0) * way_.visible) * (kStepless + 1 / step);
}

template <class MakeSettings>
Result<std::optional<OnePicture::Rays>> OnePicture::longest(std::span<const double> steps, double first, double share,
                                                            MakeSettings&& settings_of) const {
  std::optional<Rays> best;
  double best_step = 0;
  const auto try_step = [&](std::size_t i) -> Result<bool> {
    const RenderSettings settings = settings_of(steps[i]);
    CATENA_TRY(const LatticeError error, lattice_.of_rays(settings));
    const bool good = error.rmse <= share * error_ && error.good_for(error_) && lattice_.lattice_keeps_what_is_thin(error_);
    if (good) best = Rays{settings, error.above}, best_step = steps[i];
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

Result<std::optional<OnePicture::Rays>> OnePicture::exact() const {
  // they are judged by what is finer than they are
  const auto fine = std::ranges::find_if(kExactSteps, [this](double step) { return step < 2 * lattice_.truth_step(); });
  return longest({std::begin(kExactSteps), fine}, kFirstExactStep, 1, exact_rung);
}

Result<std::optional<OnePicture::Rays>> OnePicture::fast() const {
  return longest(kFastSteps, kFirstFastStep, kStepShare, [this](double step) { return fast_rays(step, error_, lattice_.shaded()); });
}

Result<std::optional<QualityChoice>> OnePicture::interpolated(const Rays& rays) const {
  RenderSettings settings = rays.settings;
  settings.fast->spacing = 4;
  settings.keep = true;
  for (const auto [half, full] : kRefine) {
    settings.fast->refine_half_255 = half * error_;
    settings.fast->refine_full_255 = full * error_;
    CATENA_TRY(const LatticeError error, lattice_.of_picture(settings));
    if (error.good_for(error_) && lattice_.lattice_keeps_what_is_thin(error_))
      return std::optional(choice_of(lattice_, settings, error.above));
  }
  return std::optional<QualityChoice>();
}

Result<std::optional<QualityChoice>> OnePicture::find() {
  const auto chosen = [this](const std::optional<Rays>& rays) -> std::optional<QualityChoice> {
    if (!rays) return std::nullopt;
    return choice_of(lattice_, rays->settings, rays->above);
  };
  std::optional<Rays> exact_rays;
  if (!lattice_.renderer().draws_fast(lattice_.packet())) {
    CATENA_TRY(exact_rays, exact());
    return chosen(exact_rays);
  }
  way_ = ray_way(lattice_.packet());
  const double packing = work_of_packing(), fast_work = (lattice_.shaded() ? kLitFastShare : kFastShare) * work_of_rays(1);
  const bool exact_first = work_of_rays(kExactSteps[0]) <= packing + fast_work;
  if (exact_first) {
    CATENA_TRY(exact_rays, exact());
    if (exact_rays && work_of_rays(exact_rays->settings.step_voxels) <= packing + fast_work) return chosen(exact_rays);
  }
  CATENA_TRY(const bool can_be_fast, lattice_.begin_fast());
  std::optional<Rays> rays;
  if (can_be_fast) {
    CATENA_TRY(rays, fast());
  }
  if (!rays) {
    if (!exact_first) {
      CATENA_TRY(exact_rays, exact());
    }
    return chosen(exact_rays);
  }
  if (fast_work > kWorthTrying) {
    CATENA_TRY(const std::optional<QualityChoice> picture, interpolated(*rays));
    if (picture) return picture;
  }
  return chosen(rays);
}

}  // namespace catena::render
