// SPDX-License-Identifier: MIT
/// Random walks through one volume: free paths by delta tracking (E. R. Woodcock, 1965), transmittance by ratio tracking (J. Novak, 2014),
/// against an upper bound of the extinction in each brick. Both are unbiased. Immutable after construction: any thread.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/random.h"
#include "render/frame/frame_packet.h"
#include "render/path/dense_grid.h"
#include "render/path/path_ray.h"

namespace catena::render {

/// Piecewise linear function of a value with an index of its points.
class PiecewiseCurve {
 public:
  /// `points`: rows of value and Columns numbers, values not falling.
  template <std::size_t Columns>
  explicit PiecewiseCurve(const std::vector<std::array<double, Columns + 1>>& points, std::integral_constant<std::size_t, Columns>)
      : columns_(Columns) {
    for (const auto& point : points) {
      values_.push_back(float(point[0]));
      for (std::size_t c = 1; c <= Columns; ++c) rows_.push_back(float(point[c]));
    }
    make_index();
  }
  /// Writes the columns at a value: linear between the points, constant beyond them.
  void at(float value, float* out) const;
  /// Returns the largest value of the first column over an interval.
  float largest(float lo, float hi) const;

 private:
  void make_index();
  std::size_t above(float value) const;  ///< the first point with a larger value

  std::size_t columns_;
  std::vector<float> values_, rows_;
  std::vector<std::uint32_t> index_;  ///< by evenly spaced values: the first point above
  float per_value_ = 0;
};

/// Volume of a packet, for rays in display units.
class VolumeTracker {
 public:
  /// `grid`: the voxels of item.grid.
  VolumeTracker(const VolumeItem& item, std::shared_ptr<const DenseGrid> grid);

  /// Item that is tracked.
  const VolumeItem& item() const { return *item_; }
  /// Returns the distance of the next collision within [from, to] of the ray; nullopt: it passes.
  std::optional<double> collide(const PathRay& ray, double from, double to, Random& random) const;
  /// Returns an unbiased estimate of the transmittance between two distances.
  double transmittance(const PathRay& ray, double from, double to, Random& random) const;
  /// Returns the color, as stated by the transfer function, and the gradient at a position.
  Color color_at(const Vec3& position) const;
  /// Returns the gradient at a position.
  Vec3 gradient_at(const Vec3& position) const;

 private:
  /// Extinction per display unit.
  float extinction_at(const glm::vec3& p) const;
  /// Calls body(bound, enter, leave) for the bricks with a bound above 0 along the ray; distances from `from` on. Ends when it returns
  /// false.
  template <class Body>
  void walk(const PathRay& ray, double from, double to, const Body& body) const;

  const VolumeItem* item_;
  std::shared_ptr<const DenseGrid> grid_;
  PiecewiseCurve extinction_, color_;
  std::optional<PiecewiseCurve> factor_;  ///< by the magnitude of the gradient
  std::vector<float> bounds_;             ///< by brick: upper bound of the extinction
};

}  // namespace catena::render
