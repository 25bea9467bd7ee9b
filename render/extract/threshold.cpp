// SPDX-License-Identifier: MIT
#include "render/extract/threshold.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena::render {

namespace {

using Range = std::array<double, 2>;

bool is_in(const Range& range, double value) { return value >= range[0] && value <= range[1]; }

/// Interval of the fractions of an edge, from value `a` to value `b`, whose values lie in the range; empty if first > last.
LinePart edge_part(double a, double b, const Range& range) {
  constexpr LinePart kNothing{1, 0};
  if (std::isnan(a) || std::isnan(b)) return kNothing;
  if (a == b) return is_in(range, a) ? LinePart{0, 1} : kNothing;
  const double to_lo = (range[0] - a) / (b - a), to_hi = (range[1] - a) / (b - a);
  return {std::max(0.0, std::min(to_lo, to_hi)), std::min(1.0, std::max(to_lo, to_hi))};
}

/// Adds the vertices of the cuts of one mesh.
class TriangleCutter {
 public:
  TriangleCutter(MeshGeometry& geometry, std::vector<double>& values, const Range& range)
      : geometry_(geometry), values_(values), range_(range) {}

  /// Adds the part of a triangle in the range to `out`.
  void cut(const std::array<std::uint32_t, 3>& triangle, std::vector<std::uint32_t>& out) {
    std::vector<std::uint32_t> polygon;
    const auto add = [&](std::uint32_t vertex) {
      if (polygon.empty() || (polygon.back() != vertex && polygon.front() != vertex)) polygon.push_back(vertex);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      if (std::isnan(values_[a])) return;
      const LinePart part = edge_part(values_[a], values_[b], range_);
      if (part.first > part.last) continue;
      add(vertex_at(a, b, part.first));
      add(vertex_at(a, b, part.last));
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) out.insert(out.end(), {polygon[0], polygon[i - 1], polygon[i]});
  }

 private:
  std::uint32_t vertex_at(std::uint32_t a, std::uint32_t b, double f) {
    if (f <= 0) return a;
    if (f >= 1) return b;
    const Vec3 p = geometry_.vertices[a] + f * (geometry_.vertices[b] - geometry_.vertices[a]);
    geometry_.vertices.push_back(p);
    if (!geometry_.normals.empty()) geometry_.normals.push_back(direction((1 - f) * geometry_.normals[a] + f * geometry_.normals[b]));
    values_.push_back(std::clamp(values_[a] + f * (values_[b] - values_[a]), range_[0], range_[1]));
    return static_cast<std::uint32_t>(geometry_.vertices.size() - 1);
  }

  MeshGeometry& geometry_;
  std::vector<double>& values_;
  Range range_;
};

}  // namespace

std::vector<LinePart> line_parts_within(std::span<const double> values, const Threshold& threshold) {
  std::vector<LinePart> parts;
  for (const Range& range : threshold) {
    const std::size_t before = parts.size();
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      const auto at = static_cast<double>(i);
      const LinePart part = edge_part(values[i], values[i + 1], range);
      if (!(part.first < part.last)) continue;
      if (parts.size() > before && part.first == 0 && parts.back().last == at)
        parts.back().last = at + part.last;
      else
        parts.push_back({at + part.first, at + part.last});
    }
  }
  std::ranges::sort(parts, {}, &LinePart::first);
  return parts;
}

void cut_triangles(MeshGeometry& geometry, std::vector<double>& values, const Threshold& threshold) {
  std::vector<std::uint32_t> kept;
  for (const Range& range : threshold) {
    TriangleCutter cutter(geometry, values, range);
    for (std::size_t i = 0; i + 2 < geometry.triangles.size(); i += 3) {
      const std::array<std::uint32_t, 3> triangle{geometry.triangles[i], geometry.triangles[i + 1], geometry.triangles[i + 2]};
      if (std::ranges::all_of(triangle, [&](std::uint32_t v) { return is_in(range, values[v]); }))
        kept.insert(kept.end(), triangle.begin(), triangle.end());
      else
        cutter.cut(triangle, kept);
    }
  }
  geometry.triangles = std::move(kept);
}

std::vector<std::array<double, 2>> cut_extinctions(const std::vector<std::array<double, 2>>& rows, const Threshold& threshold) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<std::array<double, 2>> out;
  for (const Range& range : threshold) {
    // the bounds as floats in the range; next to them, sigma is 0
    auto lo = static_cast<float>(range[0]), hi = static_cast<float>(range[1]);
    if (lo < range[0]) lo = std::nextafter(lo, kInfinity);
    if (hi > range[1]) hi = std::nextafter(hi, -kInfinity);
    if (lo > hi) continue;
    out.push_back({std::nextafter(lo, -kInfinity), 0});
    out.push_back({lo, interpolate_piecewise(rows, lo, 1)});
    for (const auto& row : rows)
      if (row[0] > lo && row[0] < hi) out.push_back(row);
    if (hi > lo) out.push_back({hi, interpolate_piecewise(rows, hi, 1)});
    out.push_back({std::nextafter(hi, kInfinity), 0});
  }
  if (out.empty()) out.push_back({threshold.front()[0], 0});
  return out;
}

}  // namespace catena::render
