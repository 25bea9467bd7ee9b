// SPDX-License-Identifier: MIT
/// Triangulation of the cells of a grid, by the rules of isosurface.h. Vertices are numbered by the caller, so that a surface can be stored
/// or only measured. `Vertices` has these functions; positions are in index space unless stated otherwise:
///   uint32_t on_edge(const EdgeVertex&)          number of a vertex on an edge of cells, the same for all cells at the edge
///   void add_cell(number, corners, in_cell)      one more cell at this vertex: its eight values, the vertex relative to its first corner
///   uint32_t add_inner(index, gradient)          a new vertex inside a cell; gradient per voxel
///   const Vec3& position(number)                 world
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "engine/field/grid/grid.h"
#include "engine/geometry/mesh/isosurface.h"
#include "engine/geometry/mesh/isosurface_blocks.h"

namespace catena::mesh {

// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2). Edge 4 axis + n runs along `axis` from the n-th corner with that bit clear.

inline constexpr int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  const int low = a & b;
  const int n = axis == 0 ? low >> 1 : axis == 1 ? (low & 1) | (low >> 2) << 1 : low & 3;
  return 4 * axis + n;
}
inline constexpr int first_corner(int edge) {
  const int axis = edge / 4, n = edge % 4;
  return axis == 0 ? n << 1 : axis == 1 ? (n & 1) | (n >> 1) << 2 : n;
}

/// Corners of each face, counterclockwise as seen from outside the cell.
inline constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/// Bit mask of the faces that contain each edge.
inline constexpr auto kFacesOfEdge = [] {
  std::array<unsigned, 12> faces{};
  for (unsigned f = 0; f < 6; ++f)
    for (int k = 0; k < 4; ++k) faces[static_cast<std::size_t>(edge_between(kFaces[f][k], kFaces[f][(k + 1) % 4]))] |= 1u << f;
  return faces;
}();

/// Returns for each cut edge the next one of its loop. Loops are oriented so that values above the level are on the left of a segment,
/// seen from outside the cell. `d`: values minus the level; 0 counts as above.
inline std::array<int, 12> loops_of(const std::array<double, 8>& d) {
  std::array<int, 12> next{};
  next.fill(-1);
  for (const auto& face : kFaces) {
    int enters[2], exits[2], cuts = 0;
    // around the face: from the edge that enters the region above the level to the edge that leaves it
    int begin = 0;
    while (begin < 4 && d[static_cast<std::size_t>(face[begin])] >= 0) ++begin;
    if (begin == 4) continue;
    for (int k = 0; k < 4; ++k) {
      const int a = face[(begin + k) % 4], b = face[(begin + k + 1) % 4];
      const bool above_a = d[static_cast<std::size_t>(a)] >= 0, above_b = d[static_cast<std::size_t>(b)] >= 0;
      if (!above_a && above_b) enters[cuts] = edge_between(a, b);
      if (above_a && !above_b) exits[cuts++] = edge_between(a, b);
    }
    const auto at = [&](int k) { return d[static_cast<std::size_t>(face[(begin + k) % 4])]; };
    const bool joined = cuts == 2 && at(1) * at(3) > at(0) * at(2);
    for (int i = 0; i < cuts; ++i) next[static_cast<std::size_t>(exits[i])] = enters[joined ? 1 - i : i];
  }
  return next;
}

/// A vertex on an edge between two voxels, or exactly at a voxel, which all edges there share.
struct EdgeVertex {
  field::Index3 voxel;  ///< lower end of the edge, or the voxel
  int kind = 0;         ///< axis of the edge; kAtVoxel: at the voxel
  field::Index3 above;  ///< end of the edge at or above the level
  Vec3 index{0.0};      ///< position
  static constexpr int kAtVoxel = 3;
};

/// Meshes blocks of cells: `triangles` receives numbers of `vertices`.
template <class Vertices>
class CellMesher {
 public:
  CellMesher(const field::ScalarGrid& grid, double level, OutwardSide outside, Vertices& vertices, std::vector<Triangle>& triangles)
      : grid_(grid), level_(level), vertices_(vertices), triangles_(triangles) {
    const bool mirrored = glm::determinant(grid.mapping().world_from_index_linear) < 0;
    swap_ = mirrored != (outside == OutwardSide::lower);
  }

  /// Appends the triangles of the block of cells at `block`.
  void add_block(const field::Index3& block) {
    float values[kWide * kWide * kWide];
    std::uint8_t valid[kSurfaceBlock * kSurfaceBlock * kSurfaceBlock];
    grid_.read_block(block, {kWide, kWide, kWide}, values);
    bool some_below = false, some_above = false;
    for (const float v : values) some_below = some_below || v < level_, some_above = some_above || v >= level_;
    if (!some_below || !some_above) return;
    grid_.read_cell_validity(block, {kSurfaceBlock, kSurfaceBlock, kSurfaceBlock}, valid);
    for (int z = 0; z < kSurfaceBlock; ++z)
      for (int y = 0; y < kSurfaceBlock; ++y)
        for (int x = 0; x < kSurfaceBlock; ++x) {
          if (valid[(z * kSurfaceBlock + y) * kSurfaceBlock + x] == 0) continue;
          std::array<double, 8> corner;
          int count = 0;
          bool finite = true;
          for (int c = 0; c < 8; ++c) {
            const double v = values[((z + (c >> 2)) * kWide + y + (c >> 1 & 1)) * kWide + x + (c & 1)];
            corner[static_cast<std::size_t>(c)] = v;
            count += v >= level_ ? 1 : 0;
            finite = finite && std::isfinite(v);
          }
          if (finite && count != 0 && count != 8) add_cell({block.x + x, block.y + y, block.z + z}, corner);
        }
  }

 private:
  static constexpr int kWide = kSurfaceBlock + 1;  ///< voxels per axis that the cells of a block need
  /// Cost of a chord in a face, in squared longest edges: more than all other chords of a loop together.
  static constexpr double kInFace = 1e3;

  void add_cell(const field::Index3& base, const std::array<double, 8>& corner) {
    std::array<double, 8> d;
    for (std::size_t c = 0; c < 8; ++c) d[c] = corner[c] - level_;
    std::array<int, 12> next = loops_of(d);
    for (int start = 0; start < 12; ++start) {
      if (next[static_cast<std::size_t>(start)] < 0) continue;
      std::array<Cut, 12> loop;
      std::size_t n = 0;
      for (int edge = start; next[static_cast<std::size_t>(edge)] >= 0;) {
        loop[n++] = cut(base, corner, edge);
        edge = std::exchange(next[static_cast<std::size_t>(edge)], -1);
      }
      if (!fill(loop, n)) fill_around(base, corner, loop, n);
    }
  }

  struct Cut {
    int edge = 0;
    std::uint32_t vertex = 0;
  };

  /// Returns the vertex on an edge of a cell.
  Cut cut(const field::Index3& base, const std::array<double, 8>& corner, int edge) {
    const int axis = edge / 4, from = first_corner(edge), to = from | 1 << axis;
    const double v0 = corner[static_cast<std::size_t>(from)], v1 = corner[static_cast<std::size_t>(to)];
    const double t = std::clamp((level_ - v0) / (v1 - v0), 0.0, 1.0);
    const auto voxel = [&](int c) { return field::Index3{base.x + (c & 1), base.y + (c >> 1 & 1), base.z + (c >> 2)}; };
    Vec3 in_cell(from & 1, from >> 1 & 1, from >> 2);
    in_cell[axis] += t;
    const std::uint32_t vertex = vertices_.on_edge({voxel(t == 1 ? to : from), t == 0 || t == 1 ? EdgeVertex::kAtVoxel : axis,
                                                    voxel(v0 >= level_ ? from : to), Vec3(base.x, base.y, base.z) + in_cell});
    vertices_.add_cell(vertex, corner, in_cell);
    return {edge, vertex};
  }

  /// Returns the cost of joining two cuts of a loop by an edge inside the cell. In a face of the cell the neighbor could create the same
  /// edge, which costs kInFace.
  double chord_cost(const Cut& a, const Cut& b) const {
    const Vec3 chord = vertices_.position(b.vertex) - vertices_.position(a.vertex);
    const bool in_face = (kFacesOfEdge[static_cast<std::size_t>(a.edge)] & kFacesOfEdge[static_cast<std::size_t>(b.edge)]) != 0;
    const double longest = grid_.max_voxel_edge();
    return dot(chord, chord) + (in_face ? kInFace * longest * longest : 0);
  }

  /// Triangulates the loop with the minimum sum of chord costs: best[i][j] is the cost of the part from cut i to cut j, whose last
  /// triangle has its third corner at third[i][j]. Returns false if every triangulation has an edge in a face.
  bool fill(const std::array<Cut, 12>& loop, std::size_t n) {
    double best[12][12]{};
    std::size_t third[12][12]{};
    for (std::size_t length = 2; length < n; ++length)
      for (std::size_t i = 0; i + length < n; ++i) {
        const std::size_t j = i + length;
        best[i][j] = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k)
          if (const double cost = best[i][k] + best[k][j]; cost < best[i][j]) best[i][j] = cost, third[i][j] = k;
        if (length + 1 < n) best[i][j] += chord_cost(loop[i], loop[j]);
      }
    if (n >= 2 && best[0][n - 1] >= kInFace * grid_.max_voxel_edge() * grid_.max_voxel_edge()) return false;
    add_part(loop, third, 0, n - 1);
    return true;
  }

  /// Triangulates the loop as a fan around an additional vertex: the mean of the cuts, moved along the gradient to the level.
  void fill_around(const field::Index3& base, const std::array<double, 8>& corner, const std::array<Cut, 12>& loop, std::size_t n) {
    const Vec3 origin(base.x, base.y, base.z);
    Vec3 middle(0.0), gradient(0.0);
    for (std::size_t i = 0; i < n; ++i) middle += grid_.mapping().index_from_world(vertices_.position(loop[i].vertex)) - origin;
    middle /= static_cast<double>(n);
    for (int step = 0; step < 20; ++step) {
      double value;
      field::trilinear(corner, middle, value, gradient);
      const double slope = dot(gradient, gradient);
      if (!(slope > 0)) break;
      middle = glm::clamp(middle - gradient * ((value - level_) / slope), Vec3(0.0), Vec3(1.0));
    }
    const std::uint32_t centre = vertices_.add_inner(origin + middle, gradient);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t a = loop[i].vertex, b = loop[(i + 1) % n].vertex;
      if (a != b) triangles_.push_back(swap_ ? Triangle{a, centre, b} : Triangle{a, b, centre});
    }
  }

  void add_part(const std::array<Cut, 12>& loop, const std::size_t (&third)[12][12], std::size_t i, std::size_t j) {
    if (j < i + 2) return;
    const std::size_t k = third[i][j];
    add_part(loop, third, i, k);
    const std::uint32_t a = loop[i].vertex, b = loop[k].vertex, c = loop[j].vertex;
    if (a != b && b != c && c != a) triangles_.push_back(swap_ ? Triangle{a, c, b} : Triangle{a, b, c});
    add_part(loop, third, k, j);
  }

  const field::ScalarGrid& grid_;
  double level_;
  Vertices& vertices_;
  std::vector<Triangle>& triangles_;
  bool swap_ = false;  ///< corners of a triangle in the reverse order
};

/// Error of a level without triangles.
Error no_surface(double level, const std::string& name);

}  // namespace catena::mesh
