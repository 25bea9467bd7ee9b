// SPDX-License-Identifier: MIT
#include "render/quality/error_estimator.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/base/numbers.h"
#include "render/image/image_error.h"
#include "render/quality/quality.h"
#include "render/quality/refinement.h"

namespace catena::render {
namespace {

constexpr double kDeviations = 3;  // standard deviations of the mean from the estimate to its upper bound
constexpr double kTailInverse = 1000,
                 kMinTailSamples = 2;         // tail of the p999: 1 of kTailInverse samples, but at least kMinTailSamples samples
constexpr double kThinContrastRatio = 6;      // a thin part may lose error / kThinContrastRatio of its contrast
constexpr double kFlickerGoal = 0.5;          // maximum flicker / max(error goal, flicker of the image itself)
constexpr double kFlickerRotation_deg = 0.2;  // rotation of the camera between the two frames that flicker is measured on, degrees
constexpr double kHalfStepSamples = 4000;     // samples of half_step_difference(), in pixels
constexpr double kFullSamples = 6000, kReducedSamples = 800;  // covered pixels on the sample grid
constexpr std::uint32_t kSpacings[] = {25, 21, 19, 17, 15, 13,
                                       11, 9,  7,  5,  3,  1};  // pixels; odd, so that the samples do not fall on one ray grid only
constexpr std::uint32_t kCoverageSpacing = 13;                  // sample spacing that finds the covered pixels
constexpr std::uint32_t kSparseFactor = 3;                      // the coarser sample grid on which the reference step is found,
constexpr double kSparseSamples = 500;                          // if it has at least so many covered pixels
// Ray steps in voxels: of the coverage; of the fast raycast's reference for thin features; initial steps of the converged reference, for
// coarse and for other goals, and its minimum. The reference step is halved until its remaining error is below the share of the goal (full,
// reduced size) or below the error of rounding to 8 bits.
constexpr double kCoverageStep = 1, kFineStep = 0.25, kCoarseReferenceStep = 0.5, kReferenceStep = 0.25, kMinReferenceStep = 0.03,
                 kReferenceShare = 0.3, kCoarseReferenceShare = 0.5;

ErrorEstimate compare_over_ground(const Image8& a, const Image8& b) {
  PixelErrors errors = compute_covered_errors(a, b);
  const auto count = double(errors.squared.size());
  if (count == 0) return {};
  double sum = 0, squares = 0;
  for (const double here : errors.squared) {
    sum += here;
    squares += here * here;
  }
  const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
  // of few samples the maximum alone says little about the 99.9 percentile
  const double tail = std::max(1 / kTailInverse, kMinTailSamples / count);
  return {std::sqrt(mean), std::sqrt(mean + kDeviations * std::sqrt(variance / count)),
          quantile(errors.max_channel, 1 - std::min(1.0, tail))};
}

/// Moves an image composited over the first background to background `ground`; the second background is white, and then the first is black.
Image8 over_ground(Image8 rendered, std::size_t ground) {
  if (ground == 0) return rendered;
  for (std::size_t i = 0; i < rendered.rgba.size(); i += 4)
    for (std::size_t c = i; c < i + 3; ++c) rendered.rgba[c] = std::uint8_t(std::min(255, rendered.rgba[c] + 255 - rendered.rgba[i + 3]));
  return rendered;
}

/// Returns the packet with the camera rotated by kFlickerRotation_deg around its target.
FramePacket orbit_view(const FramePacket& packet) {
  FramePacket out = packet;
  const Vec3 turn = direction(packet.view.up) * (kFlickerRotation_deg * std::numbers::pi / 180);
  out.view.position = packet.view.target + rotate(rotation_from_vector(turn), packet.view.position - packet.view.target);
  return out;
}

/// Returns the pixels of a rendered image that lie on the sample grid.
Image8 subsample(const Image8& rendered, std::uint32_t spacing) {
  Image8 out;
  out.width = (rendered.width + spacing - 1) / spacing;
  out.height = (rendered.height + spacing - 1) / spacing;
  for (std::uint32_t y = 0; y < rendered.height; y += spacing)
    for (std::uint32_t x = 0; x < rendered.width; x += spacing)
      out.rgba.insert(out.rgba.end(), rendered.pixel(x, y), rendered.pixel(x, y) + 4);
  return out;
}

}  // namespace

ErrorEstimator::ErrorEstimator(Renderer& renderer, const FramePacket& packet, EstimatorSize size)
    : renderer_(renderer), packet_(packet), size_(size) {
  if (packet_.background[3] < 1) packet_.background = {};
  backgrounds_.push_back({packet_.background[0], packet_.background[1], packet_.background[2]});
  if (packet_.background[3] < 1) backgrounds_.push_back({1, 1, 1});
  packet_.background[3] = 0;
  packet_.overlay = {};
}

Outcome ErrorEstimator::begin(double goal, bool moves) {
  // exact rays first, so that a large grid's data for them and for the fast raycast are not held at once
  CATENA_TRY(const Image8 coverage, renderer_.sample_rays(packet_, converged_level(kCoverageStep), kCoverageSpacing));
  double covered = 0;
  for (std::size_t i = 3; i < coverage.rgba.size(); i += 4) covered += coverage.rgba[i] > 0;
  covered *= double(packet_.width) * packet_.height / (double(coverage.rgba.size()) / 4);
  covered_pixels_ = std::max(1.0, covered);
  const double samples = size_ == EstimatorSize::full ? kFullSamples : kReducedSamples;
  for (const std::uint32_t spacing : kSpacings) {
    spacing_ = spacing;
    if (covered / (spacing * spacing) >= samples) break;
  }
  CATENA_CHECK(find_reference(size_ == EstimatorSize::reduced || renderer_.can_draw_fast(packet_) ? goal : 0));
  if (moves && renderer_.can_draw_fast(packet_)) {
    CATENA_TRY(next_reference_, renderer_.sample_rays(orbit_view(packet_), converged_level(reference_step_), spacing_));
    const Image8 none{reference_.width, reference_.height, std::vector<std::uint8_t>(reference_.rgba.size())};
    for (const double change : flicker(none, reference_, none, next_reference_))
      max_flicker_.push_back(kFlickerGoal * std::max(goal, change));
  }
  if (size_ == EstimatorSize::full) CATENA_CHECK(prepare_fast());
  return Done{};
}

Result<bool> ErrorEstimator::prepare_fast() {
  if (!renderer_.can_draw_fast(packet_)) return false;
  // the memory may not suffice for the grid
  CATENA_CHECK(renderer_.sample_rays(packet_, fast_level(kCoverageStep, 1, 0, -1), kCoverageSpacing));
  return uses_fast_raycast_ = renderer_.can_draw_fast(packet_);
}

/// Opaque regions of steep transfer functions require much shorter steps than translucent ones.
Outcome ErrorEstimator::find_reference(double goal) {
  const bool sparser = covered_pixels_ / std::pow(kSparseFactor * spacing_, 2) >= kSparseSamples;
  const std::uint32_t spacing = sparser ? kSparseFactor * spacing_ : spacing_;
  RenderSettings converged = converged_level(goal < kCoarseErrorGoal ? kReferenceStep : kCoarseReferenceStep);
  CATENA_TRY(reference_, renderer_.sample_rays(packet_, converged, spacing));
  double before = 0;
  do {
    converged.step_voxels /= 2;
    CATENA_TRY(Image8 finer, renderer_.sample_rays(packet_, converged, spacing));
    const double change = compare(reference_, finer).rmse;
    // Remaining error of a geometric series of changes with ratio 1/r: r >= sqrt(2), the ratio where edges of a step in opacity jump from
    // pixel to pixel; r <= 4.
    reference_error_ = change / (std::clamp(before > 0 ? before / std::max(change, 1e-30) : 2.0, std::numbers::sqrt2, 4.0) - 1);
    before = change;
    reference_ = std::move(finer);
  } while (reference_error_ >
               std::max(kMinReportedRmse, (size_ == EstimatorSize::reduced ? kCoarseReferenceShare : kReferenceShare) * goal) &&
           converged.step_voxels > kMinReferenceStep);
  reference_step_ = converged.step_voxels;
  if (!sparser) return Done{};
  CATENA_TRY(reference_, renderer_.sample_rays(packet_, converged, spacing_));
  return Done{};
}

Result<double> ErrorEstimator::half_step_difference(const RenderSettings& settings) const {
  const auto spacing = std::max(1u, std::uint32_t(std::sqrt(double(packet_.width) * packet_.height / kHalfStepSamples)));
  RenderSettings half = settings;
  half.step_voxels /= 2;
  CATENA_TRY(const Image8 rendered, renderer_.sample_rays(packet_, settings, spacing));
  CATENA_TRY(const Image8 finer, renderer_.sample_rays(packet_, half, spacing));
  return compare(rendered, finer).rmse;
}

bool ErrorEstimator::is_shaded() const { return std::ranges::any_of(packet_.volumes, &VolumeItem::is_shaded); }

bool ErrorEstimator::empty() const {
  for (std::size_t i = 3; i < reference_.rgba.size(); i += 4)
    if (reference_.rgba[i] > 0) return false;
  return spacing_ == 1;
}

Result<ErrorEstimate> ErrorEstimator::estimate_rays(const RenderSettings& settings) {
  CATENA_TRY(last_samples_, renderer_.sample_rays(packet_, settings, spacing_));
  return compare_to_reference();
}

Result<ErrorEstimate> ErrorEstimator::estimate_image(const RenderSettings& settings) {
  CATENA_CHECK(renderer_.draw(packet_, settings));
  ++images_rendered_;
  CATENA_TRY(last_samples_, render_samples());
  return compare_to_reference();
}

ErrorEstimate ErrorEstimator::compare(const Image8& a, const Image8& b) const {
  ErrorEstimate worst;
  for (std::size_t ground = 0; ground < backgrounds_.size(); ++ground) {
    const ErrorEstimate error = compare_over_ground(over_ground(a, ground), over_ground(b, ground));
    worst = {std::max(worst.rmse, error.rmse), std::max(worst.upper_bound, error.upper_bound), std::max(worst.p999, error.p999)};
  }
  return worst;
}

std::vector<double> ErrorEstimator::flicker(const Image8& last, const Image8& last_truth, const Image8& now, const Image8& truth) const {
  std::vector<double> each;
  for (std::size_t ground = 0; ground < backgrounds_.size(); ++ground)
    each.push_back(measure_frame_flicker(over_ground(last, ground), over_ground(last_truth, ground), over_ground(now, ground),
                                         over_ground(truth, ground)));
  return each;
}

/// Returns the error of the last samples. The upper bound includes the reference's own error as far as it exceeds the error of rounding.
ErrorEstimate ErrorEstimator::compare_to_reference() const {
  ErrorEstimate error = compare(last_samples_, reference_);
  error.upper_bound =
      std::hypot(error.upper_bound, std::sqrt(std::max(0.0, reference_error_ * reference_error_ - kMinReportedRmse * kMinReportedRmse)));
  return error;
}

Result<std::array<double, 2>> ErrorEstimator::refined_shares() const {
  CATENA_TRY(const auto rays, renderer_.refined_ray_counts());
  return std::array{4 * double(rays[0]) / covered_pixels_, double(rays[1]) / covered_pixels_};
}

Result<bool> ErrorEstimator::preserves_thin_features(double e) {
  CATENA_TRY(const Image8 rendered, renderer_.read_back());
  if (fast_reference_.rgba.empty()) {
    CATENA_CHECK(renderer_.draw(packet_, fast_level(kFineStep, 1, 0, -1, is_shaded())));
    CATENA_TRY(fast_reference_, renderer_.read_back());
    ++images_rendered_;
  }
  for (const std::array<float, 3>& ground : backgrounds_) {
    const ImageError error = measure_error(rendered, fast_reference_, ground);
    if (error.min_thin_retained < 1 - e / kThinContrastRatio || error.p999 > kMaxP999Ratio * e) return false;
  }
  return true;
}

bool ErrorEstimator::samples_preserve_thin_features(double e) const {
  for (std::size_t ground = 0; ground < backgrounds_.size(); ++ground)
    if (measure_error(over_ground(last_samples_, ground), over_ground(reference_, ground)).min_thin_retained < 1 - e / kThinContrastRatio)
      return false;
  return true;
}

/// Returns the samples of the image rendered last.
Result<Image8> ErrorEstimator::render_samples() {
  CATENA_TRY(const Image8 rendered, renderer_.read_back());
  return composite_over(subsample(rendered, spacing_), backgrounds_.front());
}

bool ErrorEstimator::is_stable(const Image8& after) const {
  return std::ranges::equal(flicker(last_samples_, reference_, after, next_reference_), max_flicker_, std::less_equal<>());
}

Result<bool> ErrorEstimator::are_rays_stable(const RenderSettings& settings) {
  CATENA_TRY(const Image8 after, renderer_.sample_rays(orbit_view(packet_), settings, spacing_));
  return is_stable(after);
}

Result<bool> ErrorEstimator::is_image_stable(const RenderSettings& settings) {
  CATENA_CHECK(renderer_.draw(orbit_view(packet_), settings));
  ++images_rendered_;
  CATENA_TRY(const Image8 after, render_samples());
  return is_stable(after);
}

}  // namespace catena::render
