// SPDX-License-Identifier: MIT
/// Alpha of volumes against the optical depth of each pixel's ray.
#pragma once
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test {

using OfRay = std::function<double(const render::Ray&)>;

/// Largest difference between a pixel's alpha and 255 (1 - exp(-depth(ray))).
inline double worst_alpha(const render::Image8& image, const render::FramePacket& packet, const OfRay& depth) {
  const render::Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  double worst = 0;
  for (const auto& [x, y] : pixels_of(image)) {
    const double expected = 255 * (1 - std::exp(-depth(pixel_ray(camera, x + 0.5, y + 0.5))));
    worst = std::max(worst, std::fabs(image.pixel(x, y)[3] - expected));
  }
  return worst;
}

/// Optical depth of a ray in a grid of the extinction `sigma` everywhere.
inline OfRay even_depth(const GridPtr& grid, double sigma) {
  return [grid, sigma](const render::Ray& ray) { return sigma * chord_length(*grid, ray.origin, ray.direction); };
}

/// Optical depth in a grid on [0, 16]^3 whose extinction is 0.2 (x + 2 y + 3 z) / 96: the mean of a linear function is that of its middle.
inline OfRay linear_depth(const GridPtr& grid) {
  return [grid](const render::Ray& ray) {
    const auto [enter, leave] = ray_interval(*grid, ray.origin, ray.direction);
    const Vec3 middle = ray.origin + 0.5 * (enter + leave) * ray.direction;
    return std::max(0.0, leave - enter) * 0.2 * (middle.x + 2 * middle.y + 3 * middle.z) / 96;
  };
}

/// A grid of n voxels with the value 0.5.
inline GridPtr even_grid(const field::Index3& n, const field::Mapping& mapping = {}) {
  return make_grid(
      n, [](const Vec3&) { return 0.5; }, mapping);
}

/// Rotation by `a` about z after one by `b` about x.
inline Mat3 turned(double a, double b) {
  return Mat3(std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1) *
         Mat3(1, 0, 0, 0, std::cos(b), std::sin(b), 0, -std::sin(b), std::cos(b));
}

}  // namespace catena::test
