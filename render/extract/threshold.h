// SPDX-License-Identifier: MIT
/// Parts of lines, triangles and opacities within a threshold (engine/base/threshold.h) that is not empty. Values are linear along an edge,
/// so that a cut lies where the interpolated value equals a bound; a value that is NaN at one end of an edge leaves the whole edge out.
/// Pure functions, any thread.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/threshold.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Part of a polyline between two positions, each the index of a point plus the fraction of the way to the next one; first < last.
struct LinePart {
  double first, last;
};

/// Returns the parts of a polyline, one value a point, whose values lie within the threshold, in order along the line.
std::vector<LinePart> line_parts_within(std::span<const double> values, const Threshold& threshold);

/// Returns the entries of a part: those of its points, and interpolated ones at its two ends where these lie between points.
template <class T>
std::vector<T> entries_of(const LinePart& part, std::span<const T> entries) {
  const auto at = [&](double position) {
    const auto i = static_cast<std::size_t>(position);
    const double f = position - static_cast<double>(i);
    return f > 0 ? T(entries[i] * (1 - f) + entries[i + 1] * f) : entries[i];
  };
  std::vector<T> out{at(part.first)};
  for (auto i = static_cast<std::size_t>(part.first) + 1; static_cast<double>(i) < part.last; ++i) out.push_back(entries[i]);
  out.push_back(at(part.last));
  return out;
}

/// Cuts the triangles, with one value a vertex, to the parts whose values lie within the threshold; adds the vertices of the cuts to the
/// geometry (positions and normals) and to the values. Colors are left alone.
void cut_triangles(MeshGeometry& geometry, std::vector<double>& values, const Threshold& threshold);

/// Returns the extinctions (rows of value and sigma, values not falling) with a sigma of 0 outside the threshold.
std::vector<std::array<double, 2>> cut_extinctions(const std::vector<std::array<double, 2>>& rows, const Threshold& threshold);

}  // namespace catena::render
