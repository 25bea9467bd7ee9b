// SPDX-License-Identifier: MIT
#include "render/light/light_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include "engine/field/grid/grid.h"
#include "render/residency/voxel_block.h"

namespace catena::render {
namespace {

constexpr double kOpaqueDepth = 8;  // optical depth of a cell that an opaque surface crosses
constexpr double kAside = 0.45;  // distance of a mesh's opaque points from it, in cells: less than half, so that an even one takes one cell
constexpr int kMargin = 3;       // empty cells around everything

double optical_depth(double opacity) { return opacity >= 1 ? kOpaqueDepth : std::min(kOpaqueDepth, -std::log1p(-opacity)); }

double voxel_edge(const field::ScalarGrid& grid) {
  const Mat3& m = grid.mapping().world_from_index_linear;
  return std::max({norm(m[0]), norm(m[1]), norm(m[2])});
}

/// Transmittance of a length by value, tabulated where the transfer function is on a linear scale.
class TransmittanceTable {
 public:
  TransmittanceTable(const TransferTable& transfer, double length) : points_(transfer.extinctions), length_(length) {
    if (points_.empty() || transfer.is_categorical || transfer.linear_below > 0) return;
    lo_ = float(points_.front()[0]);
    const double range = points_.back()[0] - points_.front()[0];
    if (!(range > 0)) return;
    per_value_ = float((kEntries - 1) / range);
    entries_.resize(kEntries);
    for (int i = 0; i < kEntries; ++i) entries_[std::size_t(i)] = at(points_.front()[0] + range * i / (kEntries - 1));
  }
  float operator()(float value) const {
    if (entries_.empty()) return at(value);
    const float place = (value - lo_) * per_value_ + 0.5f;  // the nearest entry
    return entries_[std::size_t(std::clamp(place, 0.0f, float(kEntries - 1)))];
  }

 private:
  float at(double value) const { return float(std::exp(-length_ * interpolate_piecewise(points_, value, 1))); }

  static constexpr int kEntries = 4096;
  std::vector<std::array<double, 2>> points_;
  std::vector<float> entries_;
  double length_;
  float lo_ = 0, per_value_ = 0;
};

/// Adds items to the cells.
class Caster {
 public:
  Caster(const FramePacket& packet, LightCells& cells) : planes_(packet.clip_planes), cells_(cells) {}

  void add(const VolumeItem& item) {
    if (item.projection != Projection::composite || item.transfer.extinctions.empty()) return;
    // voxels beside each other, not behind each other, have a mean transmittance
    const double voxel = voxel_edge(*item.grid);
    const TransmittanceTable transmittance(item.transfer, voxel);
    std::vector<float> weight(cells_.count()), sum(cells_.count());
    scatter(*item.grid, 0, item.is_clipped, sum, &weight,
            [&](const Slab& slab, std::size_t i, int, std::size_t, std::size_t) { return 1 - transmittance(slab.block.values[i]); });
    const auto most = float(kOpaqueDepth / cells_.edge);
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (sum[i] > 0) cells_.extinction[i] += std::min(most, float(-std::log1p(-std::min(0.9999999f, sum[i] / weight[i])) / voxel));
  }

  void add(const IsosurfaceItem& item) {
    if (!(item.opacity > 0)) return;
    // voxels at or above the level with one below it among the 26 around: no light passes between their cells
    const auto level = float(item.level), extinction = float(optical_depth(item.opacity) / cells_.edge);
    std::vector<float> most(cells_.count());
    scatter(*item.grid, 1, item.is_clipped, most, nullptr, [&](const Slab& slab, std::size_t i, int x, std::size_t row, std::size_t plane) {
      const std::vector<float>& v = slab.block.values;
      if (!(v[i] >= level)) return 0.0f;
      const std::size_t in_plane = i % plane, first_x = x > 0 ? 1 : 0, last_x = std::size_t(x) + 1 < row ? 1 : 0;
      const std::size_t first_y = in_plane >= row ? row : 0, last_y = in_plane + row < plane ? row : 0;
      const std::size_t first_z = i >= plane ? plane : 0, last_z = i + plane < v.size() ? plane : 0;
      for (std::size_t z = i - first_z; z <= i + last_z; z += plane)
        for (std::size_t y = z - first_y; y <= z + last_y; y += row)
          for (std::size_t k = y - first_x; k <= y + last_x; ++k)
            if (!(v[k] >= level)) return extinction;
      return 0.0f;
    });
    for (std::size_t i = 0; i < most.size(); ++i) cells_.extinction[i] += most[i];
  }

  /// Marks the cells that the triangles cross, by points at most half an edge apart, on both sides: no light passes between the cells.
  void add(const MeshItem& item) {
    if (!item.geometry || !(item.opacity > 0)) return;
    const double extinction = (item.opacity >= 1 ? 1 : 0.5) * optical_depth(item.opacity) / cells_.edge;
    const MeshGeometry& mesh = *item.geometry;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const Vec3 a = mesh.vertices[mesh.triangles[t]], b = mesh.vertices[mesh.triangles[t + 1]] - a,
                 c = mesh.vertices[mesh.triangles[t + 2]] - a;
      const int steps = steps_of(std::max({norm(b), norm(c), norm(c - b)}));
      const Vec3 normal = cross(b, c);
      const Vec3 aside = norm(normal) > 0 ? kAside * cells_.edge * direction(normal) : Vec3(0.0);
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps - i; ++j)
          for (const double side : {-1.0, 1.0})
            mark(a + b * (double(i) / steps) + c * (double(j) / steps) + side * aside, extinction, item.is_clipped);
    }
  }

  void add(const TubeItem& item) {
    const std::vector<Vec3>& points = item.points.list();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) add_segment(points[i], points[i + 1], item.radius, item.is_clipped);
    if (points.size() == 1) add_ball(points.front(), item.radius, item.is_clipped);
  }
  void add(const ArrowItem& item) { add_segment(item.base, item.tip, 0.5 * item.radius, item.is_clipped); }
  void add(const GlyphItem& item) {
    for (const Glyph& glyph : item.glyphs)
      add_segment(glyph.tail, glyph.tip, std::max(item.shaft_radius, 0.5 * item.head_radius) * norm(glyph.tip - glyph.tail),
                  item.is_clipped);
  }
  void add(const SpheresItem& item) {
    for (std::size_t i = 0; i < item.spheres->offsets.size(); ++i)
      add_ball(item.spheres->position(i), double(item.spheres->radii[i]), item.is_clipped);
  }

 private:
  /// Number of steps of at most half an edge.
  int steps_of(double length) const {
    constexpr double kMostSteps = 4 * kMaxLightCells;
    return int(std::clamp(std::ceil(2 * length / cells_.edge), 1.0, kMostSteps));
  }
  bool is_clipped_away(const Vec3& point, bool is_clipped) const {
    return is_clipped && std::ranges::any_of(planes_, [&](const Plane& plane) { return dot(point - plane.point, plane.normal) < 0; });
  }
  /// Returns the cell of a point; nullptr: outside, or clipped away.
  float* find(const Vec3& point, bool is_clipped) {
    const Vec3 at = (point - cells_.lo) / cells_.edge;
    if (!(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < cells_.size.x && at.y < cells_.size.y && at.z < cells_.size.z)) return nullptr;
    if (is_clipped_away(point, is_clipped)) return nullptr;
    return &cells_.extinction[cells_.index(int(at.x), int(at.y), int(at.z))];
  }
  void mark(const Vec3& point, double extinction, bool is_clipped) {
    if (float* cell = find(point, is_clipped)) *cell = std::max(*cell, float(extinction));
  }
  /// Adds something small that covers `area` of a cell's face.
  void cover(const Vec3& point, double area, bool is_clipped) {
    const double most = kOpaqueDepth / cells_.edge;
    if (float* cell = find(point, is_clipped))
      *cell = float(std::min(most, *cell + optical_depth(std::min(1.0, area / (cells_.edge * cells_.edge))) / cells_.edge));
  }
  void add_segment(const Vec3& a, const Vec3& b, double radius, bool is_clipped) {
    const double length = norm(b - a);
    const int steps = steps_of(length);
    for (int i = 0; i < steps; ++i) {
      const Vec3 point = a + (b - a) * ((i + 0.5) / steps);
      if (radius > cells_.edge)
        add_ball(point, radius, is_clipped);
      else
        cover(point, 2 * radius * length / steps, is_clipped);
    }
  }
  void add_ball(const Vec3& center, double radius, bool is_clipped) {
    if (!(radius > cells_.edge)) return cover(center, std::numbers::pi * radius * radius, is_clipped);
    const double reach = std::min(radius, kMaxLightCells * cells_.edge);
    const int steps = int(std::ceil(reach / cells_.edge));
    for (int z = -steps; z <= steps; ++z)
      for (int y = -steps; y <= steps; ++y)
        for (int x = -steps; x <= steps; ++x) {
          const Vec3 offset = cells_.edge * Vec3(x, y, z);
          if (norm(offset) <= radius) mark(center + offset, kOpaqueDepth / cells_.edge, is_clipped);
        }
  }

  /// Calls value(slab, voxel, x, row, plane) for each voxel, with the strides of its neighbors, and adds it to its cell in `out`;
  /// without `weight` the largest value remains.
  template <class Value>
  void scatter(const field::ScalarGrid& grid, int margin, bool is_clipped, std::vector<float>& out, std::vector<float>* weight,
               const Value& value) {
    const VoxelExtent extent = voxel_extent(grid);
    const field::Mapping& mapping = grid.mapping();
    const Vec3 step = mapping.world_from_index_linear[0] / cells_.edge;
    std::mutex mutex;
    for_each_slab(grid, {0, extent.size.z, margin, margin}, [&](const Slab& slab) {
      const field::Index3& n = slab.block.size;
      const std::size_t row = std::size_t(n.x), plane = row * std::size_t(n.y);
      const auto cell_of = [&](int x, int y, int z) {
        return (mapping.world_from_index(Vec3(extent.lo.x + x, extent.lo.y + y, extent.lo.z + z)) - cells_.lo) / cells_.edge;
      };
      // the part of the cells that the slab touches
      Bounds touched;
      for (int corner = 0; corner < 8; ++corner)
        touched.extend(cell_of(corner & 1 ? n.x - 1 : 0, corner & 2 ? n.y - 1 : 0, slab.first + (corner & 4 ? slab.planes - 1 : 0)));
      int lo[3], size[3];
      const int all[3] = {cells_.size.x, cells_.size.y, cells_.size.z};
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::clamp(int(std::floor(touched.lo[a])), 0, all[a] - 1);
        size[a] = std::clamp(int(std::floor(touched.hi[a])) + 1, lo[a] + 1, all[a]) - lo[a];
      }
      const std::size_t part_row = std::size_t(size[0]), part_plane = part_row * std::size_t(size[1]);
      std::vector<float> part(part_plane * std::size_t(size[2])), counts(weight ? part.size() : 0);
      const float top[3] = {float(size[0] - 1), float(size[1] - 1), float(size[2] - 1)};
      // cells of a row along x, which are the same for all rows if the voxels are parallel to the cells
      std::vector<std::uint32_t> along(std::size_t(n.x), 0);
      const bool is_parallel = step.y == 0 && step.z == 0;
      const bool keeps_all = planes_.empty() || !is_clipped;
      for (int z = 0; z < slab.planes; ++z)
        for (int y = 0; y < n.y; ++y) {
          const Vec3 first = cell_of(0, y, slab.first + z) - Vec3(lo[0], lo[1], lo[2]);
          const auto place = [&](double at, int axis) { return std::size_t(std::clamp(float(at), 0.0f, top[axis])); };
          const std::size_t base = is_parallel ? place(first.z, 2) * part_plane + place(first.y, 1) * part_row : 0;
          if (!is_parallel || (y == 0 && z == 0))
            for (int x = 0; x < n.x; ++x) {
              const Vec3 at = first + double(x) * step;
              const std::size_t rest = is_parallel ? 0 : place(at.z, 2) * part_plane + place(at.y, 1) * part_row;
              along[std::size_t(x)] = std::uint32_t(rest + place(at.x, 0));
            }
          const std::size_t from = slab.block.voxel_index(0, y, slab.offset + z);
          for (int x = 0; x < n.x; ++x) {
            if (!keeps_all && is_clipped_away(cells_.lo + cells_.edge * (first + double(x) * step + Vec3(lo[0], lo[1], lo[2])), true))
              continue;
            const std::size_t cell = base + along[std::size_t(x)], voxel = from + std::size_t(x);
            const float v = slab.block.is_used(voxel) ? value(slab, voxel, x, row, plane) : 0.0f;
            if (weight) {
              part[cell] += v;
              counts[cell] += 1;
            } else {
              part[cell] = std::max(part[cell], v);
            }
          }
        }
      const std::scoped_lock lock(mutex);
      for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
          for (int x = 0; x < size[0]; ++x) {
            const std::size_t from = std::size_t(z) * part_plane + std::size_t(y) * part_row + std::size_t(x);
            const std::size_t to = cells_.index(lo[0] + x, lo[1] + y, lo[2] + z);
            out[to] = weight ? out[to] + part[from] : std::max(out[to], part[from]);
            if (weight) (*weight)[to] += counts[from];
          }
    });
  }

  const std::vector<Plane>& planes_;
  LightCells& cells_;
};

/// Calls body(item) for all surfaces that cast shadows.
template <class Body>
void each_surface(const FramePacket& packet, const Body& body) {
  const auto each = [&](const auto& items) {
    for (const auto& item : items) body(item);
  };
  each(packet.isosurfaces), each(packet.meshes), each(packet.tubes), each(packet.arrows), each(packet.glyphs), each(packet.spheres);
}

}  // namespace

LightCells make_light_cells(const FramePacket& packet) {
  LightCells cells;
  const Bounds& bounds = packet.illumination.bounds;
  if (bounds.empty()) return cells;
  double least_edge = 0;
  for (const VolumeItem& item : packet.volumes) least_edge = std::max(least_edge, voxel_edge(*item.grid));
  for (const IsosurfaceItem& item : packet.isosurfaces) least_edge = std::max(least_edge, voxel_edge(*item.grid));
  const Vec3 size = bounds.hi - bounds.lo;
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0) || !std::isfinite(longest)) return cells;
  cells.edge = std::max(longest / (kMaxLightCells - 1 - 2 * kMargin), least_edge);
  // a voxel in the corner of the bounds is in the middle of its cell
  cells.lo = bounds.lo - Vec3((kMargin + 0.5) * cells.edge);
  const auto count = [&](double length) { return std::min(kMaxLightCells, int(std::ceil(length / cells.edge)) + 1 + 2 * kMargin); };
  cells.size = {count(size.x), count(size.y), count(size.z)};
  cells.extinction.resize(cells.count());
  Caster caster(packet, cells);
  bool has_surfaces = false;
  each_surface(packet, [&](const auto& item) {
    caster.add(item);
    has_surfaces = true;
  });
  if (has_surfaces) {
    cells.open.reserve(cells.count());
    for (const float extinction : cells.extinction) cells.open.push_back(std::exp(-extinction * float(cells.edge)));
  }
  for (const VolumeItem& item : packet.volumes) caster.add(item);
  return cells;
}

}  // namespace catena::render
