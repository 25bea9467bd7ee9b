// SPDX-License-Identifier: MIT
#include "engine/io/volume/downsample.h"

#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <vector>

#include "engine/field/field_display_range.h"
#include "engine/field/grid/dense.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

constexpr double kDifferenceVoxels = 4e6;

double square(double a, double b) { return (a - b) * (a - b); }
double square(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

template <class Grid>
GridDifference difference_of(const Grid& fine, const Grid& coarse) {
  Cursor at_fine, at_coarse;
  const Box& box = fine.index_box();
  const Vec3 count = box.hi - box.lo + Vec3(1.0);
  // an odd step, so that the samples do not coincide with the nodes of the coarse grid
  const int step = std::max(1, static_cast<int>(std::cbrt(count.x * count.y * count.z / kDifferenceVoxels)) * 2 - 1);
  GridDifference d;
  double sum = 0, voxels = 0;
  for (double z = box.lo.z; z <= box.hi.z; z += step)
    for (double y = box.lo.y; y <= box.hi.y; y += step)
      for (double x = box.lo.x; x <= box.hi.x; x += step) {
        const Vec3 p = fine.mapping().world_from_index({x, y, z});
        const auto a = fine.sample(p, at_fine), b = coarse.sample(p, at_coarse);
        if (!a.inside || !b.inside) continue;
        const double e = square(a.value, b.value);
        if (!std::isfinite(e)) continue;
        sum += e;
        d.max = std::max(d.max, std::sqrt(e));
        ++voxels;
      }
  if (voxels > 0) d.rms = std::sqrt(sum / voxels);
  return d;
}

constexpr int kFlat = 2;  // maximum number of nodes along an axis that is not downsampled: an image is stored as two slices

int step_of(int n, int factor) { return n <= kFlat ? 1 : factor; }
/// Returns the number of nodes that remain of `n` along an axis.
int remaining_nodes(int n, int factor) { return (n - 1) / step_of(n, factor) + 1; }

/// The slices of the full grid that are in use, lowest z first; they must be requested with rising z.
class SliceWindow {
 public:
  explicit SliceWindow(const VoxelBox& box) : box_(box) {}

  void want(int lo, int hi) {
    while (first_ < lo && !layers_.empty()) layers_.pop_front(), ++first_;
    if (layers_.empty()) first_ = lo;
    while (first_ + static_cast<int>(layers_.size()) <= hi) {
      const int z = first_ + static_cast<int>(layers_.size());
      Layer& layer = layers_.emplace_back();
      layer.values.resize(box_.layer_voxels() * static_cast<std::size_t>(box_.components));
      box_.read_values(z, layer.values);
      if (!box_.has_mask) continue;
      layer.valid.resize(box_.layer_voxels());
      box_.read_valid(z, layer.valid);
    }
  }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(box_.size.x) + x; }
  float value(int x, int y, int z, int component = 0) const {
    return of(z).values[at(x, y) * static_cast<std::size_t>(box_.components) + component];
  }
  bool valid(int x, int y, int z) const { return !box_.has_mask || of(z).valid[at(x, y)] != 0; }

 private:
  struct Layer {
    std::vector<float> values;
    std::vector<std::uint8_t> valid;
  };
  const Layer& of(int z) const { return layers_[static_cast<std::size_t>(z - first_)]; }

  const VoxelBox& box_;
  std::deque<Layer> layers_;
  int first_ = 0;
};

/// Returns the half-width of the tent filter at a node.
int half_width(int node, int n, int factor) { return n <= kFlat ? 0 : std::min({factor - 1, node, n - 1 - node}); }

float tent(const SliceWindow& layers, const Index3& size, const Index3& at, int factor) {
  const int rx = half_width(at.x, size.x, factor), ry = half_width(at.y, size.y, factor), rz = half_width(at.z, size.z, factor);
  const auto has = [&](int i, int j, int k) {
    return layers.valid(at.x + i, at.y + j, at.z + k) && std::isfinite(layers.value(at.x + i, at.y + j, at.z + k));
  };
  if (!has(0, 0, 0)) return layers.value(at.x, at.y, at.z);
  double sum = 0, weights = 0;
  for (int k = -rz; k <= rz; ++k)
    for (int j = -ry; j <= ry; ++j)
      for (int i = -rx; i <= rx; ++i) {
        if (!has(i, j, k) || !has(-i, -j, -k)) continue;
        const double weight = double(rx + 1 - std::abs(i)) * (ry + 1 - std::abs(j)) * (rz + 1 - std::abs(k));
        sum += weight * layers.value(at.x + i, at.y + j, at.z + k);
        weights += weight;
      }
  return static_cast<float>(sum / weights);
}

/// Reads one slice of the coarse cell mask: a coarse cell is invalid if at least half of its fine cells are.
void coarse_cells(const VoxelBox& box, int factor, int z, std::span<std::uint8_t> out) {
  const int n[3] = {box.size.x, box.size.y, box.size.z};
  int step[3], remaining[3];
  for (int a = 0; a < 3; ++a) step[a] = step_of(n[a], factor), remaining[a] = remaining_nodes(n[a], factor);
  std::vector<int> invalid(out.size(), 0);
  std::vector<std::uint8_t> layer(box.layer_voxels());
  for (int k = z * step[2]; k < (z + 1) * step[2] && k < n[2]; ++k) {
    box.read_cells(k, layer);
    for (int y = 0; y < std::max(1, remaining[1] - 1); ++y)
      for (int x = 0; x < std::max(1, remaining[0] - 1); ++x)
        for (int j = 0; j < step[1]; ++j)
          for (int i = 0; i < step[0]; ++i)
            invalid[static_cast<std::size_t>(y) * static_cast<std::size_t>(remaining[0]) + static_cast<std::size_t>(x)] +=
                layer[static_cast<std::size_t>(y * step[1] + j) * static_cast<std::size_t>(n[0]) +
                      static_cast<std::size_t>(x * step[0] + i)] == 0;
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * invalid[i] < step[0] * step[1] * step[2] ? 1 : 0;
}

template <class Grid>
Result<std::shared_ptr<const Grid>> at_level_of(const std::string& path, const AnyField& field, int factor, bool averaged) {
  const VoxelBox box(field, field.get()->name(), {});
  const Index3 n = box.size;
  DenseSource source;
  source.size = {remaining_nodes(n.x, factor), remaining_nodes(n.y, factor), remaining_nodes(n.z, factor)};
  source.has_mask = box.has_mask;
  CATENA_CHECK(check_dense_memory(path, source.size, box.components, box.has_mask));
  SliceWindow layers(box);
  const auto step = [&](int nodes) { return step_of(nodes, factor); };
  source.read = [&](int first, int count, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
    std::size_t i = 0, v = 0;
    for (int z = first; z < first + count; ++z) {
      const int fine_z = z * step(n.z), rz = averaged ? half_width(fine_z, n.z, factor) : 0;
      layers.want(fine_z - rz, fine_z + rz);
      for (int y = 0; y < source.size.y; ++y)
        for (int x = 0; x < source.size.x; ++x) {
          const Index3 at{x * step(n.x), y * step(n.y), fine_z};
          if (averaged) {
            values[i++] = tent(layers, n, at, factor);
          } else {
            for (int c = 0; c < box.components; ++c) values[i++] = layers.value(at.x, at.y, at.z, c);
          }
          if (box.has_mask) valid[v++] = layers.valid(at.x, at.y, at.z);
        }
    }
    return Done{};
  };
  if (box.has_cell_mask)
    source.read_cells = [&](int first, int count, std::span<std::uint8_t> cells) -> Outcome {
      const std::size_t plane = static_cast<std::size_t>(source.size.x) * static_cast<std::size_t>(source.size.y);
      for (int z = 0; z < count; ++z) coarse_cells(box, factor, first + z, cells.subspan(static_cast<std::size_t>(z) * plane, plane));
      return Done{};
    };
  Mapping mapping = box.mapping;
  const Vec3 steps(step(n.x), step(n.y), step(n.z));
  for (int axis = 0; axis < 3; ++axis) mapping.world_from_index_linear[axis] *= steps[axis];
  mapping = Mapping::from_linear(mapping.world_from_index_linear, box.mapping.origin);
  const std::string prefix = fmt::format("{}: at this level of detail the grid \"{}\" ", path, box.name);
  return make_dense_grid<Grid>(box.name, mapping, source, prefix, true);
}

}  // namespace

GridDifference compute_difference(const ScalarGrid& fine, const ScalarGrid& coarse) { return difference_of(fine, coarse); }
GridDifference compute_difference(const VectorGrid& fine, const VectorGrid& coarse) { return difference_of(fine, coarse); }

Result<AnyField> downsample_to_level(const std::string& path, AnyField field, int level, bool cubic) {
  CATENA_ASSERT(field.get()->is_grid() && level >= 1 && level <= kMaxLevels);
  const int factor = 1 << level;
  const Box& full_box = field.get()->index_box();
  for (int axis = 0; axis < 3; ++axis) {
    const double nodes = full_box.hi[axis] - full_box.lo[axis] + 1;
    if (nodes > kFlat && nodes <= factor)
      return Error{fmt::format("{}: {:.0f} voxels along {} are too few for level of detail {}; more than {} were expected", path, nodes,
                               "xyz"[axis], level, factor)};
  }
  AnyField coarse = field;
  const ScalarGrid* numbers = field.scalar ? field.scalar->grid() : nullptr;
  if (numbers != nullptr) {
    const bool nearest = numbers->interpolation() == Interpolation::nearest;
    CATENA_TRY(const auto made, at_level_of<ScalarGrid>(path, field, factor, !nearest));
    coarse.scalar = nearest ? made->with_interpolation(Interpolation::nearest) : made;
  } else {
    CATENA_TRY(coarse.vector, at_level_of<VectorGrid>(path, field, factor, false));
  }
  if (cubic) {
    CATENA_TRY(coarse, with_cubic_interpolation(std::move(coarse), path));
  }
  const GridDifference off = numbers != nullptr ? compute_difference(*numbers, *coarse.scalar->grid())
                                                : compute_difference(*field.vector->grid(), *coarse.vector->grid());
  const DisplayRange range = display_range(field);
  const double scale = numbers != nullptr ? range.hi - range.lo : range.hi;
  const Box& now = coarse.get()->index_box();
  const auto size = [](const Box& b) {
    const Vec3 n = b.hi - b.lo + Vec3(1.0);
    return fmt::format("{:.0f} x {:.0f} x {:.0f}", n.x, n.y, n.z);
  };
  std::string note =
      fmt::format("level of detail {}: {} of {} voxels; the values differ from the data by {:.2g} (root mean square; maximum {:.2g}", level,
                  size(now), size(full_box), off.rms, off.max);
  if (scale > 0) note += fmt::format("; the data range is {:.2g} wide", scale);
  coarse.notes.push_back(note + ")");
  return coarse;
}

}  // namespace catena::field
