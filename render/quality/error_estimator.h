/// How far settings are off in one picture, measured on a sparse lattice of its pixels against converged rays through them (quality.h has
/// the numbers). Frame thread.
#pragma once
#include <array>
#include <vector>

#include "render/image/image.h"
#include "render/passes/renderer.h"

namespace catena::render {

inline constexpr double kMaxP999Ratio = 8;       ///< the 99.9 percentile, in errors
inline constexpr double kCoarseErrorGoal = 1.5;  ///< 1/255: from it on the error of step 0.25 does not count

/// Errors on the lattice, 1/255.
struct ErrorEstimate {
  double rmse = 0;         ///< over the covered pixels
  double upper_bound = 0;  ///< the true one is at most so, whatever chance makes of the lattice
  double p999 = 0;         ///< of the largest of a pixel's differences
  bool meets(double e) const { return upper_bound <= e && p999 <= kMaxP999Ratio * e; }
};

/// How many covered pixels it has: about 6000, about 800.
enum class EstimatorSize { full, reduced };

class ErrorEstimator {
 public:
  /// The picture is drawn without a background, so that it says what it covers, and without what is written over it, which rays lack. What
  /// is to have none may come to lie over anything: then errors are the larger ones of over black and over white, between which all others
  /// are.
  ErrorEstimator(Renderer& renderer, const FramePacket& packet, EstimatorSize size = EstimatorSize::full);

  /// Before all that follows. `goal`: the least error that matters, 1/255. `moves`: the error is wanted to be steady, too.
  Outcome begin(double goal, bool moves = false);
  /// Whether the fast raycast draws the picture: it brings the grid to the device in its form. begin() has done so, unless the lattice is
  /// small.
  Result<bool> prepare_fast();

  Renderer& renderer() const { return renderer_; }
  const FramePacket& packet() const { return packet_; }
  bool uses_fast_raycast() const { return uses_fast_raycast_; }  ///< the fast raycast draws the picture
  double reference_step() const { return reference_step_; }      ///< of the converged rays, voxels
  double reference_error() const { return reference_error_; }
  double covered_pixels() const { return covered_pixels_; }  ///< pixels
  bool is_shaded() const;                                    ///< a volume of it is
  bool empty() const;                                        ///< every pixel was looked at, and nothing is in any
  int images_rendered() const { return images_rendered_; }   ///< drawn so far

  /// By how much rays of half the step differ, on a lattice of its own; begin() is not needed.
  Result<double> half_step_difference(const RenderSettings& settings) const;

  /// Of the rays alone; of the finished picture.
  Result<ErrorEstimate> estimate_rays(const RenderSettings& settings);
  Result<ErrorEstimate> estimate_image(const RenderSettings& settings);

  /// Of the picture that was drawn last: the rays of every 2nd pixel and of every pixel that were refined, by all such that show something.
  Result<std::array<double, 2>> refined_shares() const;
  /// Whether what is thin is in the picture that was drawn last, and its tail of errors is short, beside every ray of a short step.
  Result<bool> preserves_thin_features(double e);
  /// The same of the lattice of what was measured last, beside the converged rays.
  bool samples_preserve_thin_features(double e) const;
  /// Whether the error of the rays, of the picture, that were measured last stays much the same where the camera goes on.
  Result<bool> are_rays_stable(const RenderSettings& settings);
  Result<bool> is_image_stable(const RenderSettings& settings);

 private:
  Outcome find_reference(double goal);
  Result<Image8> render_samples();
  ErrorEstimate compare(const Image8& a, const Image8& b) const;
  /// Over each ground.
  std::vector<double> flicker(const Image8& last, const Image8& last_truth, const Image8& now, const Image8& truth) const;
  ErrorEstimate compare_to_reference() const;
  bool is_stable(const Image8& after) const;

  Renderer& renderer_;
  FramePacket packet_;
  std::vector<std::array<float, 3>> backgrounds_;    ///< that the picture may lie over; pictures here lie over the first
  Image8 reference_, next_reference_;                ///< the rays of the lattice; and from where the camera goes
  std::vector<double> max_flicker_;                  ///< that is steady enough, over each ground
  double covered_pixels_ = 1;                        ///< pixels
  Image8 last_samples_;                              ///< the lattice of the rays or the picture that were measured last
  double reference_step_ = 0, reference_error_ = 0;  ///< and what is left of it
  Image8 fast_reference_;                            ///< the fast raycast's every ray of a short step
  EstimatorSize size_;
  std::uint32_t spacing_ = 1;
  bool uses_fast_raycast_ = false;
  int images_rendered_ = 0;
};

}  // namespace catena::render
