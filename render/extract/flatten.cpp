// SPDX-License-Identifier: MIT
#include "render/extract/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/result.h"

namespace catena::render {

namespace {

constexpr double kSampledShare = 0.25;  ///< share of the error for the chords of the samples; the rest is for leaving out samples
constexpr double kMaxTurn = 0.8;        ///< maximum turn of the tangent along a segment, in radians

/// Returns |v| of a vector in units of the tube radius, whose square neither overflows nor underflows.
double length_of(const Vec3& v) { return std::sqrt(dot(v, v)); }

struct Sample {
  FlattenedPoint flattened;
  Vec3 tangent{0.0};
};

/// Returns the number of parts for the interval between two knots: the chord of each part deviates by at most `error` tube radii and its
/// tangent turns by at most half of a segment's maximum. The bound is the maximum of |p''|, which lies at an end because p'' is linear in
/// s.
double parts_of(const flow::Knot& a, const flow::Knot& b, const FlattenOptions& options, double error) {
  const double scale = 1 / options.radius, h = scale * (b.s - a.s);
  if (!(h > 0)) return 1;
  // h^2 |p''|; on a short interval from the tangents, because the positions' rounding error would dominate
  const Vec3 chord = (6 * scale) * (b.p - a.p), start = h * a.t, end = h * b.t, at_start = chord - (4.0 * start + 2.0 * end),
             at_end = (2.0 * start + 4.0 * end) - chord;
  const double bend = h < 1e-3 ? 2 * length_of(end - start) : std::sqrt(std::max(dot(at_start, at_start), dot(at_end, at_end)));
  double parts = std::max(std::sqrt(bend / (8 * error)), bend / (h * 0.5 * kMaxTurn));
  if (options.max_segment > 0) parts = std::max(parts, (b.s - a.s) / options.max_segment);
  return std::min(std::ceil(parts), static_cast<double>(options.max_points));
}

/// Calls visit(sample) for each knot and for points between knots by parts_of(), in order, until it returns false.
template <class Visit>
void each_sample(const flow::Curve& curve, const FlattenOptions& options, double error, Visit&& visit) {
  const std::vector<flow::Knot>& knots = curve.knots();
  if (!visit(Sample{{knots.front().p, knots.front().s}, knots.front().t})) return;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const flow::Knot &a = knots[k], &b = knots[k + 1];
    const double parts = parts_of(a, b, options, error);
    for (double i = 1; i < parts; ++i) {
      const double s = a.s + (b.s - a.s) * (i / parts);
      Vec3 p, derivative;
      curve.evaluate_interval(k, s, p, derivative);
      if (!visit(Sample{{p, s}, direction(derivative)})) return;
    }
    if (!visit(Sample{{curve.is_closed() && k + 2 == knots.size() ? knots.front().p : b.p, b.s}, b.t})) return;
  }
}

/// Decides which samples a segment may skip. Each skipped sample allows a cone of directions in which the segment passes it within the
/// error. The intersection is tracked as an inscribed cone, whose size is a chord on the unit sphere.
class Segment {
 public:
  /// `error`: in tube radii; `radius`, `longest`: in world units.
  Segment(double error, double radius, double longest) : error_(error), scale_(1 / radius), longest_(longest) {}
  void begin(const Sample& from) {
    from_ = from;
    farthest_ = 0;
    spread_ = std::numeric_limits<double>::infinity();
  }
  /// Returns whether the segment may end at or beyond this sample; false: it must end at the previous one.
  bool reaches(const Sample& to) {
    const Vec3 way = scale_ * (to.flattened.position - from_.flattened.position);
    const double length = length_of(way);
    const bool reached = to.flattened.arc_length - from_.flattened.arc_length <= longest_ && allows(to, way, length);
    pass(way, length);
    return reached;
  }

 private:
  bool allows(const Sample& to, const Vec3& way, double length) const {
    if (farthest_ <= error_ && length <= error_) return true;  // core of a spiral
    if (length < farthest_ - error_) return false;
    const Vec3 deviation = (1 / length) * way - axis_;
    if (spread_ < 2 && !(spread_ >= 0 && dot(deviation, deviation) <= spread_ * spread_)) return false;
    // bound for the outer wall of the bend, whose radius of curvature is larger by the tube radius
    const Vec3 turn = to.tangent - from_.tangent;
    return dot(turn, turn) <= std::min(kMaxTurn * kMaxTurn, 8 * error_);
  }
  void pass(const Vec3& way, double length) {
    farthest_ = std::max(farthest_, length);
    if (!(length > error_)) return;
    const Vec3 axis = (1 / length) * way;
    const double spread = error_ / length, apart = length_of(axis - axis_);
    if (!(spread_ < 2) || apart + spread <= spread_) {
      axis_ = axis;
      spread_ = spread;
    } else if (apart + spread_ > spread) {
      const Vec3 between = axis_ + (0.5 * (apart - spread + spread_) / apart) * (axis - axis_);
      axis_ = (1 / length_of(between)) * between;
      spread_ = 0.5 * (spread + spread_ - apart);  // negative: no direction is left
    }
  }

  double error_, scale_, longest_;
  Sample from_;
  double farthest_ = 0;  ///< maximum distance of the skipped samples, in tube radii
  Vec3 axis_{0.0};
  double spread_ = 0;  ///< radius of the cone of allowed directions about the axis; >= 2: all directions
};

}  // namespace

std::vector<FlattenedPoint> flatten_with_arc_length(const flow::Curve& curve, const FlattenOptions& options) {
  CATENA_ASSERT(curve.knots().size() >= 2 && options.radius > 0 && options.max_points >= 2);
  const double longest = options.max_segment > 0 ? options.max_segment : std::numeric_limits<double>::infinity();
  std::vector<FlattenedPoint> points;
  for (double coarsen = 1;; coarsen *= 2) {
    const double error = coarsen * coarsen * options.error;
    points.clear();
    Segment segment((1 - kSampledShare) * error, options.radius, coarsen * longest);
    Sample last;
    each_sample(curve, options, kSampledShare * error, [&](const Sample& sample) {
      if (points.empty()) {
        points.push_back(sample.flattened);
        segment.begin(sample);
      } else if (!segment.reaches(sample) && last.flattened.arc_length > points.back().arc_length) {
        points.push_back(last.flattened);
        segment.begin(last);
        segment.reaches(sample);
      }
      last = sample;
      return points.size() < options.max_points;
    });
    if (points.size() < options.max_points || !std::isfinite(error)) {
      points.push_back(last.flattened);
      return points;
    }
  }
}

std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options) {
  std::vector<Vec3> points;
  for (const FlattenedPoint& point : flatten_with_arc_length(curve, options)) points.push_back(point.position);
  return points;
}

}  // namespace catena::render
