/// How far settings are off in one picture, measured on a sparse lattice of its pixels against converged rays through them (quality.h has
/// the numbers). Frame thread.
#pragma once
#include <array>
#include <vector>

#include "render/image/picture.h"
#include "render/passes/renderer.h"

namespace catena::render {

inline constexpr double kFarthest = 8;     ///< the 99.9 percentile, in errors
inline constexpr double kRoughGoal = 1.5;  ///< 1/255: from it on the error of step 0.25 does not count

/// Errors on the lattice, 1/255.
struct LatticeError {
  double rmse = 0;   ///< over the covered pixels
  double above = 0;  ///< the true one is at most so, whatever chance makes of the lattice
  double p999 = 0;   ///< of the largest of a pixel's differences
  bool good_for(double e) const { return above <= e && p999 <= kFarthest * e; }
};

/// How many covered pixels it has: about 6000, about 800.
enum class LatticeSize { whole, small };

class Lattice {
 public:
  /// The picture is drawn without a background, so that it says what it covers, and without what is written over it, which rays lack. What
  /// is to have none may come to lie over anything: then errors are the larger ones of over black and over white, between which all others
  /// are.
  Lattice(Renderer& renderer, const FramePacket& packet, LatticeSize size = LatticeSize::whole);

  /// Before all that follows. `goal`: the least error that matters, 1/255. `moves`: the error is wanted to be steady, too.
  Outcome begin(double goal, bool moves = false);
  /// Whether the fast raycast draws the picture: it brings the grid to the device in its form. begin() has done so, unless the lattice is
  /// small.
  Result<bool> begin_fast();

  Renderer& renderer() const { return renderer_; }
  const FramePacket& packet() const { return packet_; }
  bool fast() const { return fast_; }                ///< the fast raycast draws the picture
  double truth_step() const { return truth_step_; }  ///< of the converged rays, voxels
  double truth_error() const { return truth_error_; }
  double covered() const { return covered_; }  ///< pixels
  bool shaded() const;                         ///< a volume of it is
  bool empty() const;                          ///< every pixel was looked at, and nothing is in any
  int pictures() const { return pictures_; }   ///< drawn so far

  /// By how much rays of half the step differ, on a lattice of its own; begin() is not needed.
  Result<double> change_of_half_step(const RenderSettings& settings) const;

  /// Of the rays alone; of the finished picture.
  Result<LatticeError> of_rays(const RenderSettings& settings);
  Result<LatticeError> of_picture(const RenderSettings& settings);

  /// Of the picture that was drawn last: the rays of every 2nd pixel and of every pixel that were refined, by all such that show something.
  Result<std::array<double, 2>> refined() const;
  /// Whether what is thin is in the picture that was drawn last, and its tail of errors is short, beside every ray of a short step.
  Result<bool> keeps_what_is_thin(double e);
  /// The same of the lattice of what was measured last, beside the converged rays.
  bool lattice_keeps_what_is_thin(double e) const;
  /// Whether the error of the rays, of the picture, that were measured last stays much the same where the camera goes on.
  Result<bool> rays_are_steady(const RenderSettings& settings);
  Result<bool> picture_is_steady(const RenderSettings& settings);

 private:
  Outcome find_truth(double goal);
  Result<Picture> drawn_lattice();
  LatticeError compare(const Picture& a, const Picture& b) const;
  /// Over each ground.
  std::vector<double> flicker(const Picture& last, const Picture& last_truth, const Picture& now, const Picture& truth) const;
  LatticeError off_the_truth() const;
  bool is_steady(const Picture& after) const;

  Renderer& renderer_;
  FramePacket packet_;
  std::vector<std::array<float, 3>> grounds_;  ///< that the picture may lie over; pictures here lie over the first
  Picture truth_, next_truth_;                 ///< the rays of the lattice; and from where the camera goes
  std::vector<double> most_flicker_;           ///< that is steady enough, over each ground
  double covered_ = 1;                         ///< pixels
  Picture last_;                               ///< the lattice of the rays or the picture that were measured last
  double truth_step_ = 0, truth_error_ = 0;    ///< and what is left of it
  Picture fine_;                               ///< the fast raycast's every ray of a short step
  LatticeSize size_;
  std::uint32_t spacing_ = 1;
  bool fast_ = false;
  int pictures_ = 0;
};

}  // namespace catena::render
