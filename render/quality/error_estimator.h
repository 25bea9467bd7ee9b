// SPDX-License-Identifier: MIT
/// Error estimation for render settings: measured on a sparse pixel sample grid of one image against converged rays through these pixels
/// (quality.h defines the measures). Frame thread.
#pragma once
#include <array>
#include <vector>

#include "render/image/image.h"
#include "render/passes/renderer.h"

namespace catena::render {

inline constexpr double kMaxP999Ratio = 8;       ///< upper limit of the 99.9 percentile, as a multiple of the error goal
inline constexpr double kCoarseErrorGoal = 1.5;  ///< 1/255: for goals from here on, the error of a reference of step 0.25 is negligible

/// Error on the pixel sample grid, 1/255.
struct ErrorEstimate {
  double rmse = 0;         ///< RMSE over the covered pixels
  double upper_bound = 0;  ///< upper bound of the RMSE of the whole image: three standard deviations above the estimate
  double p999 = 0;         ///< 99.9 percentile of a pixel's largest channel difference
  /// Returns whether the error meets the goal `e`.
  bool meets(double e) const { return upper_bound <= e && p999 <= kMaxP999Ratio * e; }
};

/// Number of covered pixels in the sample grid: full about 6000, reduced about 800.
enum class EstimatorSize { full, reduced };

/// Estimates errors of render settings for one packet. The renderer must outlive it.
class ErrorEstimator {
 public:
  /// The image is rendered without a background, so that alpha shows the coverage, and without the overlay, which ray samples lack. If the
  /// packet's background is transparent, the image may be composited over anything: then errors are the larger ones of over black and over
  /// white, which bound all others.
  ErrorEstimator(Renderer& renderer, const FramePacket& packet, EstimatorSize size = EstimatorSize::full);

  /// Chooses the sample grid and renders the reference; to be called first. `goal`: smallest error of interest, 1/255. `moves`: temporal
  /// stability will be tested, too.
  Outcome begin(double goal, bool moves = false);
  /// Returns whether the fast raycast can render the image; packs the grid on the device. begin() includes this unless the size is reduced.
  Result<bool> prepare_fast();

  Renderer& renderer() const { return renderer_; }
  const FramePacket& packet() const { return packet_; }
  bool uses_fast_raycast() const { return uses_fast_raycast_; }  ///< the fast raycast can render the image
  double reference_step() const { return reference_step_; }      ///< ray step of the reference, voxels
  /// Estimated remaining error of the reference, 1/255.
  double reference_error() const { return reference_error_; }
  double covered_pixels() const { return covered_pixels_; }  ///< number of covered pixels in the whole image
  bool is_shaded() const;                                    ///< any volume is shaded
  bool empty() const;                                        ///< every pixel was sampled, and all are transparent
  int images_rendered() const { return images_rendered_; }   ///< number of images rendered so far

  /// Returns the RMSE between rays of this step and of half the step, 1/255, on a separate sample grid; does not require begin().
  Result<double> half_step_difference(const RenderSettings& settings) const;

  /// Returns the error of the rays alone.
  Result<ErrorEstimate> estimate_rays(const RenderSettings& settings);
  /// Renders the image and returns its error, including interpolation.
  Result<ErrorEstimate> estimate_image(const RenderSettings& settings);

  /// Returns, for the image rendered last, the rays refined at every 2nd pixel and at every pixel, as shares of all covered rays of that
  /// spacing.
  Result<std::array<double, 2>> refined_shares() const;
  /// Returns whether the image rendered last preserves thin features and has few outlier pixels (99.9 percentile), for the error goal `e`,
  /// compared with full-resolution reference rays of the fast raycast (step 0.25).
  Result<bool> preserves_thin_features(double e);
  /// Returns whether the samples measured last preserve thin features, compared with the converged rays.
  bool samples_preserve_thin_features(double e) const;
  /// Return whether the error of the rays, or of the image, that were measured last is temporally stable: it changes little while the
  /// camera moves.
  Result<bool> are_rays_stable(const RenderSettings& settings);
  Result<bool> is_image_stable(const RenderSettings& settings);

 private:
  Outcome find_reference(double goal);
  Result<Image8> render_samples();
  ErrorEstimate compare(const Image8& a, const Image8& b) const;
  /// Returns the flicker over each background.
  std::vector<double> flicker(const Image8& last, const Image8& last_truth, const Image8& now, const Image8& truth) const;
  ErrorEstimate compare_to_reference() const;
  bool is_stable(const Image8& after) const;

  Renderer& renderer_;
  FramePacket packet_;
  std::vector<std::array<float, 3>> backgrounds_;    ///< backgrounds to evaluate; images here are composited over the first
  Image8 reference_, next_reference_;                ///< reference samples; the same for the moved camera
  std::vector<double> max_flicker_;                  ///< limit of the flicker for each background
  double covered_pixels_ = 1;                        ///< pixels
  Image8 last_samples_;                              ///< samples of the rays or of the image measured last
  double reference_step_ = 0, reference_error_ = 0;  ///< step of the reference, voxels, and its remaining error
  Image8 fast_reference_;                            ///< full-resolution reference rays of the fast raycast at a short step
  EstimatorSize size_;
  std::uint32_t spacing_ = 1;
  bool uses_fast_raycast_ = false;
  int images_rendered_ = 0;
};

}  // namespace catena::render
