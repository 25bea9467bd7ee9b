// SPDX-License-Identifier: MIT
#include "engine/field/bricks/slab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/field/grid/grid_from_slices.h"

namespace catena::field {
namespace {

constexpr double kObliqueSpacing = 0.5;  // of a voxel edge, between the nodes of an oblique slab, so that interpolating twice loses little
constexpr double kObliqueThickness = 0.1;  // of this spacing, between its two layers
constexpr double kParallel = 1e-9;         // largest share of a normal along the two other axes of a parallel plane

/// Node positions of a slab: world = mapping(index), index (0, 0, 0) .. size - 1.
struct SlabNodes {
  Index3 size{0, 0, 0};
  Mapping mapping;
  double count() const { return static_cast<double>(size.x) * size.y * size.z; }
};

/// Returns whether a slab is small enough, and takes at most half of the available memory.
bool fits(const SlabNodes& nodes) {
  constexpr double kBytes = 20;  // of a node, while the slab is made
  return nodes.count() <= kMaxSlabNodes && nodes.count() * kBytes <= 0.5 * static_cast<double>(available_memory());
}

/// Part of a level that a grid covers, voxels.
struct LevelPart {
  const BrickLevel& level;
  int number;
  std::array<int, 3> lo{}, hi{};
  Vec3 lo_index{0.0}, hi_index{0.0};  ///< The grid's box.

  LevelPart(const PagedGrid& grid, int at) : level(grid.source().levels()[static_cast<std::size_t>(at)]), number(at) {
    const std::array<int, 3> n{level.size.x, level.size.y, level.size.z};
    const Vec3 a = level.mapping.index_from_world(grid.corner(0)), b = level.mapping.index_from_world(grid.corner(7));
    for (int axis = 0; axis < 3; ++axis) {
      lo_index[axis] = std::min(a[axis], b[axis]);
      hi_index[axis] = std::max(a[axis], b[axis]);
      const auto voxel = [&](double index) { return static_cast<int>(std::clamp(index, 0.0, n[static_cast<std::size_t>(axis)] - 1.0)); };
      lo[static_cast<std::size_t>(axis)] = voxel(std::floor(lo_index[axis] + 1e-6));
      hi[static_cast<std::size_t>(axis)] = voxel(std::ceil(hi_index[axis] - 1e-6));
    }
  }
};

/// Returns the axis of the voxels that a plane is perpendicular to; -1: none.
int perpendicular_axis(const Mapping& mapping, const Vec3& normal) {
  const Vec3 in_index = normal * mapping.world_from_index_linear;
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::fabs(in_index[axis]) > std::fabs(in_index[longest])) longest = axis;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != longest && std::fabs(in_index[axis]) > kParallel * std::fabs(in_index[longest])) return -1;
  return longest;
}

/// Returns the voxels of a level on both sides of a plane perpendicular to an axis.
SlabNodes parallel_nodes(const LevelPart& part, const Vec3& point, int axis) {
  const auto a = static_cast<std::size_t>(axis);
  std::array<int, 3> first = part.lo, size{};
  for (std::size_t i = 0; i < 3; ++i) size[i] = part.hi[i] - part.lo[i] + 1;
  const double at = part.level.mapping.index_from_world(point)[axis];
  if (!(at >= part.lo_index[axis] - kDomainSlack && at <= part.hi_index[axis] + kDomainSlack) || size[a] < 2) return {};
  first[a] = static_cast<int>(std::clamp(std::floor(at), static_cast<double>(part.lo[a]), part.hi[a] - 1.0));
  size[a] = 2;
  const Vec3 origin = part.level.mapping.world_from_index(Vec3(first[0], first[1], first[2]));
  return {{size[0], size[1], size[2]}, Mapping::from_linear(part.level.mapping.world_from_index_linear, origin)};
}

/// Returns positions `spacing` voxel edges apart, in two layers on both sides of a plane, as far as it meets the grid's box.
SlabNodes oblique_nodes(const LevelPart& part, const PagedGrid& grid, const Vec3& point, const Vec3& normal, double spacing) {
  const double edge = spacing * part.level.mapping.min_voxel_edge(), thickness = kObliqueThickness * edge;
  const Vec3 w = normal / norm(normal);
  const Vec3 across = cross(std::fabs(w.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), w), u = across / norm(across), v = cross(w, u);
  double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
  // the plane's polygon is spanned by its intersections with the box's edges
  for (int from = 0; from < 8; ++from)
    for (int bit = 0; bit < 3; ++bit) {
      if ((from >> bit & 1) != 0) continue;
      const Vec3 a = grid.corner(from), b = grid.corner(from | 1 << bit);
      const double da = dot(a - point, w), db = dot(b - point, w);
      if ((da > 0) == (db > 0)) continue;
      const Vec3 p = a + (b - a) * (da / (da - db)) - point;
      const double at[2] = {dot(p, u), dot(p, v)};
      for (int i = 0; i < 2; ++i) {
        lo[i] = std::min(lo[i], at[i]);
        hi[i] = std::max(hi[i], at[i]);
      }
    }
  if (!(lo[0] < hi[0])) return {};
  const auto nodes = [&](int i) { return static_cast<int>(std::ceil((hi[i] - lo[i]) / edge)) + 2; };
  SlabNodes out;
  if (std::max(hi[0] - lo[0], hi[1] - lo[1]) / edge > 1e6) return {{1 << 20, 1 << 20, 2}, {}};  // too many
  out.size = {nodes(0), nodes(1), 2};
  Mat3 linear(1.0);
  linear[0] = u * edge;
  linear[1] = v * edge;
  linear[2] = w * thickness;
  out.mapping = Mapping::from_linear(linear, point + u * (lo[0] - 0.5 * edge) + v * (lo[1] - 0.5 * edge) - w * (0.5 * thickness));
  return out;
}

/// Trilinear values of a level, read brick by brick. One thread.
class LevelSampler {
 public:
  LevelSampler(const PagedGrid& grid, const LevelPart& part) : grid_(grid), part_(part), counts_(brick_counts(part.level)) {}

  /// Returns the value at a world position; NaN: outside, by more than a voxel.
  Result<float> value(const Vec3& world) {
    const Vec3 index = part_.level.mapping.index_from_world(world);
    std::array<int, 3> base{};
    Vec3 f(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!(index[axis] > part_.lo[a] - 1.0 && index[axis] < part_.hi[a] + 1.0)) return std::numeric_limits<float>::quiet_NaN();
      const double at = std::clamp(index[axis], static_cast<double>(part_.lo[a]), static_cast<double>(part_.hi[a]));
      base[a] = std::clamp(static_cast<int>(at), part_.lo[a], std::max(part_.lo[a], part_.hi[a] - 1));
      f[axis] = at - base[a];
      if (grid_.interpolation() == Interpolation::nearest) f[axis] = f[axis] < 0.5 ? 0 : 1;
    }
    // a node of the level needs one voxel, not eight
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      double weight = 1;
      std::array<int, 3> at = base;
      for (int axis = 0; axis < 3; ++axis) {
        const int up = c >> axis & 1;
        at[static_cast<std::size_t>(axis)] += up;
        weight *= up != 0 ? f[axis] : 1 - f[axis];
      }
      if (weight < kNegligible) continue;
      CATENA_TRY(const float voxel, read({at[0], at[1], at[2]}));
      sum += weight * static_cast<double>(voxel);
    }
    return static_cast<float>(sum);
  }

 private:
  static constexpr double kNegligible = 1e-9;

  Result<float> read(const Index3& voxel) {
    const Index3 at{voxel.x / kBrickEdge, voxel.y / kBrickEdge, voxel.z / kBrickEdge};
    const std::uint64_t number = brick_number(counts_, at);
    auto& [known, brick] = recent_[number % recent_.size()];
    if (brick == nullptr || known != number) {
      CATENA_TRY(brick, grid_.bricks().read(part_.number, at));
      known = number;
    }
    return brick->value(voxel.x - at.x * kBrickEdge, voxel.y - at.y * kBrickEdge, voxel.z - at.z * kBrickEdge);
  }

  const PagedGrid& grid_;
  const LevelPart& part_;
  Index3 counts_;
  std::array<std::pair<std::uint64_t, std::shared_ptr<const Brick>>, 61> recent_;
};

}  // namespace

Result<std::shared_ptr<const ScalarGrid>> make_slab(const PagedGrid& grid, const Vec3& point, const Vec3& normal,
                                                    const std::function<bool()>& is_cancelled) {
  const int levels = static_cast<int>(grid.source().levels().size());
  for (int number = 0; number < levels; ++number) {
    const LevelPart part(grid, number);
    const int axis = perpendicular_axis(part.level.mapping, normal);
    SlabNodes nodes = axis >= 0 ? parallel_nodes(part, point, axis) : oblique_nodes(part, grid, point, normal, kObliqueSpacing);
    if (axis < 0 && !fits(nodes)) nodes = oblique_nodes(part, grid, point, normal, 1);
    if (nodes.size.x < 2 || nodes.size.y < 2 || nodes.size.z < 2) return std::shared_ptr<const ScalarGrid>();
    if (nodes.count() > kMaxSlabNodes && number + 1 < levels) continue;

    // in tiles of a brick's size, so that each brick is read once
    LevelSampler sampler(grid, part);
    const Index3& n = nodes.size;
    std::vector<float> values(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z));
    for (int z0 = 0; z0 < n.z; z0 += kBrickEdge)
      for (int y0 = 0; y0 < n.y; y0 += kBrickEdge)
        for (int x0 = 0; x0 < n.x; x0 += kBrickEdge) {
          if (is_cancelled()) return std::shared_ptr<const ScalarGrid>();
          for (int z = z0; z < std::min(z0 + kBrickEdge, n.z); ++z)
            for (int y = y0; y < std::min(y0 + kBrickEdge, n.y); ++y)
              for (int x = x0; x < std::min(x0 + kBrickEdge, n.x); ++x) {
                CATENA_TRY(values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(y)) *
                                      static_cast<std::size_t>(n.x) +
                                  static_cast<std::size_t>(x)],
                           sampler.value(nodes.mapping.world_from_index(Vec3(x, y, z))));
              }
        }
    if (std::ranges::none_of(values, [](float value) { return std::isfinite(value); })) return std::shared_ptr<const ScalarGrid>();
    const std::size_t plane = static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y);
    const auto read = [&](int z, std::span<float> out) {
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(plane) * z, out.size(), out.begin());
    };
    CATENA_TRY(const AnyField made, make_grid_from_slices(grid.name(), nodes.mapping, {n, false, read}));
    return std::static_pointer_cast<const ScalarGrid>(made.scalar)->with_interpolation(grid.interpolation());
  }
  return std::shared_ptr<const ScalarGrid>();
}

}  // namespace catena::field
