// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/isosurface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"

namespace catena::mesh {
namespace {

using field::Index3;

constexpr int kBlock = 8;
constexpr int kWide = kBlock + 1;  ///< voxels per axis that the cells of a block need

// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2). Edge 4 axis + n runs along `axis` from the n-th corner with that bit clear.

constexpr int edge_between(int a, int b) {
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  const int low = a & b;
  const int n = axis == 0 ? low >> 1 : axis == 1 ? (low & 1) | (low >> 2) << 1 : low & 3;
  return 4 * axis + n;
}
constexpr int first_corner(int edge) {
  const int axis = edge / 4, n = edge % 4;
  return axis == 0 ? n << 1 : axis == 1 ? (n & 1) | (n >> 1) << 2 : n;
}

/// Corners of each face, counterclockwise as seen from outside the cell.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/// Bit mask of the faces that contain each edge.
constexpr auto kFacesOfEdge = [] {
  std::array<unsigned, 12> faces{};
  for (unsigned f = 0; f < 6; ++f)
    for (int k = 0; k < 4; ++k) faces[static_cast<std::size_t>(edge_between(kFaces[f][k], kFaces[f][(k + 1) % 4]))] |= 1u << f;
  return faces;
}();

/// Returns for each cut edge the next one of its loop. Loops are oriented so that values above the level are on the left of a segment,
/// seen from outside the cell. `d`: values minus the level; 0 counts as above.
std::array<int, 12> loops_of(const std::array<double, 8>& d) {
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

class Mesher {
 public:
  Mesher(const field::ScalarGrid& grid, double level, OutwardSide outside, const std::string& name)
      : grid_(grid), level_(level), name_(name), allowed_(available_memory()) {
    const auto index = [](const Vec3& v) {
      return Index3{static_cast<std::int32_t>(v.x), static_cast<std::int32_t>(v.y), static_cast<std::int32_t>(v.z)};
    };
    lo_ = index(grid.index_box().lo);
    hi_ = index(grid.index_box().hi);
    const bool mirrored = glm::determinant(grid.mapping().world_from_index_linear) < 0;
    swap_ = mirrored != (outside == OutwardSide::lower);
    sign_ = outside == OutwardSide::lower ? -1 : 1;
  }

  Result<Isosurface> run(const std::function<void(double)>& progress) {
    const Index3 first{lo_.x & ~(kBlock - 1), lo_.y & ~(kBlock - 1), lo_.z & ~(kBlock - 1)};
    const auto blocks = [](std::int32_t from, std::int32_t to) { return (static_cast<std::int64_t>(to) - from) / kBlock + 1; };
    const std::int64_t nx = blocks(first.x, hi_.x), ny = blocks(first.y, hi_.y), nz = blocks(first.z, hi_.z);
    constexpr double kMaxBlocks = 1 << 28;
    const double all = static_cast<double>(nx) * static_cast<double>(ny) * static_cast<double>(nz);
    if (all > kMaxBlocks)
      return Error{fmt::format("{}: the box of the grid has {:.0f} blocks of 8^3 voxels, expected at most {:.0f}", name_, all, kMaxBlocks)};
    if (lo_.x == hi_.x || lo_.y == hi_.y || lo_.z == hi_.z)
      return Error{name_ + ": the grid has a single layer of voxels and no cells; a volume was expected"};
    // two layers of blocks, marked by their side of the level: a block is skipped if it and its neighbors are on one side of the level
    across_ = static_cast<std::size_t>(nx + 1);
    const std::size_t layer = across_ * static_cast<std::size_t>(ny + 1);
    std::vector<char> lower_sides(layer), upper_sides(layer);
    const auto read_sides = [&](std::int64_t k, std::vector<char>& sides) {
      for (std::int64_t j = 0; j <= ny; ++j)
        for (std::int64_t i = 0; i <= nx; ++i)
          sides[static_cast<std::size_t>(j) * across_ + static_cast<std::size_t>(i)] = side_of(block_at(first, i, j, k));
    };
    read_sides(0, lower_sides);
    for (std::int64_t k = 0; k < nz; ++k) {
      read_sides(k + 1, upper_sides);
      for (std::int64_t j = 0; j < ny; ++j)
        for (std::int64_t i = 0; i < nx; ++i) {
          const std::size_t at = static_cast<std::size_t>(j) * across_ + static_cast<std::size_t>(i);
          bool same_side = lower_sides[at] != kMixed;
          for (const auto* sides : {&lower_sides, &upper_sides})
            for (const std::size_t neighbor : {at, at + 1, at + across_, at + across_ + 1})
              same_side = same_side && (*sides)[neighbor] == lower_sides[at];
          if (same_side) continue;
          add_block(block_at(first, i, j, k));
          CATENA_CHECK(ask());
        }
      std::swap(lower_sides, upper_sides);
      if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(nz));
    }
    if (made_.triangles.empty())
      return Error{
          fmt::format("{}: there is no surface at {}; a level between the values of adjacent voxels was expected", name_, to_text(level_))};
    for (Vec3& normal : made_.normals) normal = sign_ * direction(normal);
    return std::move(made_);
  }

 private:
  /// Cost of a chord in a face, in squared longest edges: more than all other chords of a loop together.
  static constexpr double kInFace = 1e3;
  enum Side : char { kBelow, kAbove, kMixed };

  static Index3 block_at(const Index3& first, std::int64_t i, std::int64_t j, std::int64_t k) {
    return {static_cast<std::int32_t>(first.x + i * kBlock), static_cast<std::int32_t>(first.y + j * kBlock),
            static_cast<std::int32_t>(first.z + k * kBlock)};
  }
  Side side_of(const Index3& block) const {
    float value = 0;
    if (!grid_.is_constant_block(block, value)) return kMixed;
    return value >= level_ ? kAbove : kBelow;
  }

  void add_block(const Index3& block) {
    float values[kWide * kWide * kWide];
    std::uint8_t valid[kBlock * kBlock * kBlock];
    grid_.read_block(block, {kWide, kWide, kWide}, values);
    bool some_below = false, some_above = false;
    for (const float v : values) some_below = some_below || v < level_, some_above = some_above || v >= level_;
    if (!some_below || !some_above) return;
    grid_.read_cell_validity(block, {kBlock, kBlock, kBlock}, valid);
    for (int z = 0; z < kBlock; ++z)
      for (int y = 0; y < kBlock; ++y)
        for (int x = 0; x < kBlock; ++x) {
          if (valid[(z * kBlock + y) * kBlock + x] == 0) continue;
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

  void add_cell(const Index3& base, const std::array<double, 8>& corner) {
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

  /// Returns the vertex on an edge of a cell. If a corner has exactly the level, all edges there share one vertex.
  Cut cut(const Index3& base, const std::array<double, 8>& corner, int edge) {
    const int axis = edge / 4, from = first_corner(edge);
    const double v0 = corner[static_cast<std::size_t>(from)], v1 = corner[static_cast<std::size_t>(from | 1 << axis)];
    const double t = std::clamp((level_ - v0) / (v1 - v0), 0.0, 1.0);
    const int at = t == 1 ? from | 1 << axis : from;
    const auto number = [&](int a, std::int32_t x, std::int32_t lo) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(x) - lo + (at >> a & 1));
    };
    const auto nx = static_cast<std::uint64_t>(static_cast<std::int64_t>(hi_.x) - lo_.x + 1);
    const auto ny = static_cast<std::uint64_t>(static_cast<std::int64_t>(hi_.y) - lo_.y + 1);
    const std::uint64_t voxel = (number(2, base.z, lo_.z) * ny + number(1, base.y, lo_.y)) * nx + number(0, base.x, lo_.x);
    const std::uint64_t key = voxel * 4 + (t == 0 || t == 1 ? 3u : static_cast<unsigned>(axis));
    Vec3 position(from & 1, from >> 1 & 1, from >> 2);
    position[axis] += t;
    const auto [found, inserted] = vertices_.try_emplace(key, static_cast<std::uint32_t>(made_.vertices.size()));
    if (inserted) {
      made_.vertices.push_back(grid_.mapping().world_from_index(Vec3(base.x, base.y, base.z) + position));
      made_.normals.emplace_back(0.0);
    }
    double value;
    Vec3 gradient;
    field::trilinear(corner, position, value, gradient);
    made_.normals[found->second] += grid_.mapping().world_from_index_gradient(gradient);
    return {edge, found->second};
  }

  /// Returns the cost of joining two cuts of a loop by an edge inside the cell. In a face of the cell the neighbor could create the same
  /// edge, which costs kInFace.
  double chord_cost(const Cut& a, const Cut& b) const {
    const Vec3 chord = made_.vertices[b.vertex] - made_.vertices[a.vertex];
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
  void fill_around(const Index3& base, const std::array<double, 8>& corner, const std::array<Cut, 12>& loop, std::size_t n) {
    const Vec3 origin(base.x, base.y, base.z);
    Vec3 middle(0.0), gradient(0.0);
    for (std::size_t i = 0; i < n; ++i) middle += grid_.mapping().index_from_world(made_.vertices[loop[i].vertex]) - origin;
    middle /= static_cast<double>(n);
    for (int step = 0; step < 20; ++step) {
      double value;
      field::trilinear(corner, middle, value, gradient);
      const double slope = dot(gradient, gradient);
      if (!(slope > 0)) break;
      middle = glm::clamp(middle - gradient * ((value - level_) / slope), Vec3(0.0), Vec3(1.0));
    }
    const auto centre = static_cast<std::uint32_t>(made_.vertices.size());
    made_.vertices.push_back(grid_.mapping().world_from_index(origin + middle));
    made_.normals.push_back(grid_.mapping().world_from_index_gradient(gradient));
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t a = loop[i].vertex, b = loop[(i + 1) % n].vertex;
      if (a != b) made_.triangles.push_back(swap_ ? Triangle{a, centre, b} : Triangle{a, b, centre});
    }
  }

  void add_part(const std::array<Cut, 12>& loop, const std::size_t (&third)[12][12], std::size_t i, std::size_t j) {
    if (j < i + 2) return;
    const std::size_t k = third[i][j];
    add_part(loop, third, i, k);
    const std::uint32_t a = loop[i].vertex, b = loop[k].vertex, c = loop[j].vertex;
    if (a != b && b != c && c != a) made_.triangles.push_back(swap_ ? Triangle{a, c, b} : Triangle{a, b, c});
    add_part(loop, third, k, j);
  }

  Outcome ask() const {
    constexpr double kVertex = 2 * sizeof(Vec3) + 48, kGrowth = 2;  // with its entry in the hash table; vectors double their capacity
    const double bytes =
        kGrowth * (kVertex * static_cast<double>(made_.vertices.size()) + sizeof(Triangle) * static_cast<double>(made_.triangles.size()));
    return check_memory_available(name_ + ": the surface", bytes, allowed_);
  }

  const field::ScalarGrid& grid_;
  double level_;
  std::string name_;
  std::uint64_t allowed_;
  Index3 lo_, hi_;
  bool swap_ = false;
  double sign_ = 1;
  std::size_t across_ = 0;
  Isosurface made_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
};

}  // namespace

Result<Isosurface> extract_isosurface(const field::ScalarGrid& grid, double level, OutwardSide outside, const std::string& name,
                                      const std::function<void(double)>& progress) {
  return Mesher(grid, level, outside, name).run(progress);
}

}  // namespace catena::mesh
