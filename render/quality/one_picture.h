/// Settings for one picture that is drawn once, found at little cost beside it (quality.h has the errors). Rays are looked at on a small
/// lattice alone; a finished picture is drawn only where it may become the one that is asked for.
///   1  exact rays: the longest step whose rays are good enough
///   2  fast rays, where exact ones are more work than to bring the grid to the device in the form of fast ones and to march these: the
///      longest step whose rays are good enough, lit by the gradient of the cell or, where that has too large an error, by central
///      differences
///   3  every 4th pixel, refined where it is needed, with rays of that step: drawn, where every pixel is much work. Where it is not good
///      enough: every pixel
/// Work is counted in samples of unlit exact rays, not timed, so that the choice is the same in every run:
///   rays     pixels covered x voxels on the way (a share of the cube root of the grid's, less where rays end) x (0.3 + 1 / step) x light
///   packing  samples a voxel, as measured
/// Nothing is asked of how the error moves with the camera. A small lattice that has begun, and lives longer. Frame thread.
#pragma once
#include <optional>

#include "render/quality/lattice.h"
#include "render/quality/quality.h"

namespace catena::render {

class OnePicture {
 public:
  /// `error`: covered RMSE, 1/255.
  OnePicture(Lattice& lattice, double error) : lattice_(lattice), error_(error) {}
  /// Nothing where no rays are good enough.
  Result<std::optional<QualityChoice>> find();

 private:
  struct Rays {
    RenderSettings settings;
    double above;  ///< of the rays alone: LatticeError
  };
  Result<std::optional<Rays>> exact() const;
  /// Of every pixel.
  Result<std::optional<Rays>> fast(bool smooth) const;
  /// Nothing where it is not good enough.
  Result<std::optional<QualityChoice>> interpolated(const Rays& rays) const;
  /// Samples of a picture of exact rays.
  double work_of_rays(double step) const;
  double voxels() const;

  Lattice& lattice_;
  const double error_;
};

}  // namespace catena::render
