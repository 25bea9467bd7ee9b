// SPDX-License-Identifier: MIT
/// Unbiased image of a packet's scene by path tracing on the processor, in linear radiance. Light is scattered by Lambert's law at surfaces
/// and at the gradients of shaded volumes, else by the phase function of L. G. Henyey and J. L. Greenstein (1941); a light's irradiance is
/// pi times its color. Samples are independent and depend on seed, pixel and number only: images are equal to the bit for any number of
/// threads.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "render/frame/camera.h"
#include "render/path/path_scene.h"

namespace catena::render {

/// What is computed.
struct PathSettings {
  /// Largest number of times that light is scattered. 1: the model of the fast picture, by the packet's occlusion and shadows. More: all
  /// light is occluded.
  int bounces = kUnlimited;
  std::uint64_t seed = 0;
  static constexpr int kUnlimited = 1 << 20;
};

/// When the image is finished: what is reached first.
struct PathGoal {
  std::uint32_t samples = 0;  ///< per pixel; 0: no limit
  double error = 0;           ///< standard error of the mean, root mean square over the covered pixels, 1/255; 0: no limit
  double seconds = 0;         ///< time; 0: no limit
};

/// Progressive image: means and variances of independent samples.
class PathImage {
 public:
  /// The scene and the packet must outlive it.
  PathImage(const PathScene& scene, const FramePacket& packet, const PathSettings& settings);

  /// Adds samples to every pixel.
  void add_samples(std::uint32_t count);
  /// Adds samples until the goal is reached or `proceed`, called with the completed fraction, returns false. False: it did.
  bool render(const PathGoal& goal, const std::function<bool(double done)>& proceed);
  /// Number of samples of each pixel.
  std::uint32_t samples() const { return samples_; }
  /// Returns the mean of a pixel: premultiplied linear radiance, and the coverage.
  void mean(std::size_t pixel, double rgba[4]) const;
  /// Returns the image over the packet's background, in the display encoding, with straight alpha.
  std::vector<float> display() const;

  /// Errors over the pixels where something is seen.
  struct Error {
    double standard = 0;  ///< standard error of the mean in the display encoding, root mean square, 1/255
    double relative = 0;  ///< standard error of the luminance divided by its mean, root mean square
  };
  /// Returns the standard errors.
  Error error() const;

 private:
  struct Sums {
    double rgb[3] = {}, squares[3] = {}, alpha = 0, luminance2 = 0;
  };
  struct Sample {
    double rgb[3] = {}, alpha = 0;
  };
  Sample trace(PathRay ray, Random& random) const;
  void add_lights(const PathRay& ray, const Vec3& position, const Vec3& facing, double surface_share, double anisotropy,
                  const double weight[3], Random& random, Sample& out) const;

  const PathScene& scene_;
  const FramePacket& packet_;
  PathSettings settings_;
  Camera camera_;
  bool has_occlusion_ = true, has_shadows_ = true;
  double reach_ = 0, strength_ = 1;  ///< reach: 0: infinite
  std::vector<LightItem> lights_;    ///< in world axes
  std::uint32_t samples_ = 0;
  std::vector<Sums> sums_;
};

}  // namespace catena::render
