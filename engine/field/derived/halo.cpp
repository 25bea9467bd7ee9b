// SPDX-License-Identifier: MIT
#include "engine/field/derived/halo.h"

#include <fmt/format.h>

#include <cfloat>
#include <vector>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/field/grid/dense.h"
#include "engine/field/grid/grid_factory.h"

namespace catena::field {
namespace {

using nanovdb::Coord;

constexpr int kReach = 3;                        // maximum number of samples in a row for extrapolation
constexpr int kWindow = kLeafEdge + 2 * kReach;  // voxels per axis of a block with kReach voxels on each side
constexpr int kWindowVoxels = kWindow * kWindow * kWindow;

constexpr int window_at(int x, int y, int z) { return (x * kWindow + y) * kWindow + z; }

/// Directions of the sample rows, grouped by the number of axes along which they step (1 to 3).
struct RowDirections {
  std::array<std::vector<Coord>, 4> by_axes;
  explicit RowDirections(const Index3& step) {
    for (int x = -step.x; x <= step.x; ++x)
      for (int y = -step.y; y <= step.y; ++y)
        for (int z = -step.z; z <= step.z; ++z) by_axes[(x != 0) + (y != 0) + (z != 0)].push_back({x, y, z});
  }
};

/// Limits of a halo sample's value: the grid's range widened by its length on both sides.
template <class T>
struct GhostLimits;
template <>
struct GhostLimits<float> {
  double min_value, max_value;
  explicit GhostLimits(const GridStats& s) : min_value(s.min - (s.max - s.min)), max_value(s.max + (s.max - s.min)) {}
  float clamp(double v) const {
    return static_cast<float>(std::clamp(std::clamp(v, min_value, max_value), double{-FLT_MAX}, double{FLT_MAX}));
  }
};
template <>
struct GhostLimits<nanovdb::Vec3f> {
  GhostLimits<float> axis[3];
  explicit GhostLimits(const GridStats& s) : axis{of(s, 0), of(s, 1), of(s, 2)} {}
  nanovdb::Vec3f clamp(const Vec3& v) const { return {axis[0].clamp(v.x), axis[1].clamp(v.y), axis[2].clamp(v.z)}; }

 private:
  static GhostLimits<float> of(const GridStats& s, int a) {
    GridStats one;
    one.min = s.component_min[a];
    one.max = s.component_max[a];
    return GhostLimits<float>(one);
  }
};

/// Values and presence of the voxels of a block and of three voxels around it.
template <class T>
class Neighbourhood {
 public:
  explicit Neighbourhood(const GridStorage<T>& storage) : values_(*storage.values) {
    if (storage.valid_voxels) valid_.emplace(*storage.valid_voxels);
    lo_ = to_nano_coord(storage.first_base);
    hi_ = to_nano_coord(storage.last_voxel());
  }

  bool some_present = false, some_missing = false;  ///< whether the region read by look() has a present, or a missing, voxel

  /// Reads the voxels within `reach` voxels of the block.
  void look(const Coord& block, int reach) {
    some_present = some_missing = false;
    const Coord first = block.offsetBy(-reach, -reach, -reach), after = block.offsetBy(8 + reach, 8 + reach, 8 + reach);
    Coord part;
    for (part[0] = first[0] & ~7; part[0] < after[0]; part[0] += 8)
      for (part[1] = first[1] & ~7; part[1] < after[1]; part[1] += 8)
        for (part[2] = first[2] & ~7; part[2] < after[2]; part[2] += 8) {
          Coord from = part, to = part.offsetBy(8, 8, 8);
          from.maxComponent(first);
          to.minComponent(after);
          look_at(block, part, from, to);
        }
  }

  bool present(int at) const { return present_[at] != 0; }
  const T& value(int at) const { return value_[at]; }

 private:
  void look_at(const Coord& block, const Coord& part, const Coord& from, const Coord& to) {
    const auto* values = values_.probeLeaf(part);
    const T constant = values ? T(0.f) : values_.getValue(part);
    const auto* valid = valid_ ? valid_->probeLeaf(part) : nullptr;
    const bool all_valid = !valid_ || (!valid && valid_->getValue(part));
    for (int x = from[0]; x < to[0]; ++x)
      for (int y = from[1]; y < to[1]; ++y)
        for (int z = from[2]; z < to[2]; ++z) {
          const std::uint32_t n = static_cast<std::uint32_t>((x & 7) * 64 + (y & 7) * 8 + (z & 7));
          const int at = window_at(x - block[0] + kReach, y - block[1] + kReach, z - block[2] + kReach);
          value_[at] = values ? values->getValue(n) : constant;
          const bool in_box = x >= lo_[0] && y >= lo_[1] && z >= lo_[2] && x <= hi_[0] && y <= hi_[1] && z <= hi_[2];
          const bool is_present = in_box && (valid ? valid->valueMask().isOn(n) : all_valid) && is_finite_value(value_[at]);
          present_[at] = is_present;
          (is_present ? some_present : some_missing) = true;
        }
  }

  nanovdb::ReadAccessor<T, 0, 1, 2> values_;
  std::optional<nanovdb::ReadAccessor<nanovdb::ValueMask, 0, 1, 2>> valid_;
  Coord lo_, hi_;
  std::array<T, kWindowVoxels> value_;
  std::array<std::uint8_t, kWindowVoxels> present_;
};

template <class T>
class GhostMaker {
 public:
  GhostMaker(const GridStorage<T>& storage, const GridStats& stats) : storage_(storage), directions_(storage.step), limits_(stats) {
    const Index3 &lo = storage.first_base, hi = storage.last_voxel(), &step = storage.step;
    first_ = {lo.x - step.x, lo.y - step.y, lo.z - step.z};
    final_ = {hi.x + step.x, hi.y + step.y, hi.z + step.z};
    for (int a = 0; a < 3; ++a) blocks_[a] = (final_[a] >> 3) - (first_[a] >> 3) + 1;
  }
  double blocks() const { return static_cast<double>(blocks_[0]) * blocks_[1] * blocks_[2]; }

  /// Returns the origins of all blocks that contain a halo sample.
  std::vector<Coord> with_ghosts() const {
    const auto count = static_cast<std::size_t>(blocks());
    std::vector<std::uint8_t> needed(count);
    parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
      Neighbourhood<T> window(storage_);
      for (std::size_t b = begin; b < end; ++b) needed[b] = is_needed(window, origin(b));
    });
    std::vector<Coord> found;
    for (std::size_t b = 0; b < count; ++b)
      if (needed[b]) found.push_back(origin(b));
    return found;
  }

  void fill(const Coord& block, Neighbourhood<T>& window, typename NanoTypes<T>::Leaf& leaf) const {
    window.look(block, kReach);
    leaf.mBBoxMin = block;
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y)
        for (int z = 0; z < 8; ++z) {
          const int at = window_at(x + kReach, y + kReach, z + kReach);
          if (window.present(at) || !in_ring(block.offsetBy(x, y, z))) continue;
          if (T ghost; continued(window, at, ghost)) {
            const auto n = static_cast<std::uint32_t>(x * 64 + y * 8 + z);
            leaf.mValues[n] = ghost;
            leaf.mValueMask.setOn(n);
          }
        }
  }

 private:
  Coord origin(std::size_t b) const {
    const auto nx = static_cast<std::size_t>(blocks_[0]), ny = static_cast<std::size_t>(blocks_[1]);
    return {((first_[0] >> 3) + static_cast<int>(b % nx)) * 8, ((first_[1] >> 3) + static_cast<int>(b / nx % ny)) * 8,
            ((first_[2] >> 3) + static_cast<int>(b / nx / ny)) * 8};
  }
  bool in_ring(const Coord& c) const {
    for (int a = 0; a < 3; ++a)
      if (c[a] < first_[a] || c[a] > final_[a]) return false;
    return true;
  }
  bool within_box(const Coord& block) const {
    const Index3 &lo = storage_.first_base, hi = storage_.last_voxel();
    return block[0] >= lo.x && block[1] >= lo.y && block[2] >= lo.z && block[0] + 7 <= hi.x && block[1] + 7 <= hi.y && block[2] + 7 <= hi.z;
  }
  bool is_needed(Neighbourhood<T>& window, const Coord& block) const {
    if (!storage_.has_invalid_cells) return !within_box(block);
    window.look(block, 0);
    if (!window.some_missing) return false;
    if (!window.some_present) window.look(block, 1);
    return window.some_present;
  }

  /// Computes the extrapolated value of a missing sample; returns false if it has no present neighbor.
  bool continued(const Neighbourhood<T>& window, int at, T& ghost) const {
    for (int axes = 1; axes <= 3; ++axes) {
      int longest = 0, rows = 0;
      decltype(corner_value(T())) sum(0.0);
      for (const Coord& direction : directions_.by_axes[axes]) {
        const int step = window_at(direction[0], direction[1], direction[2]);
        int length = 0;
        while (length < kReach && window.present(at + (length + 1) * step)) ++length;
        if (length == 0 || length < longest) continue;
        if (length > longest) longest = length, rows = 0, sum = decltype(sum)(0.0);
        const auto s = [&](int n) { return corner_value(window.value(at + n * step)); };
        sum += length == 3 ? 3.0 * (s(1) - s(2)) + s(3) : length == 2 ? 2.0 * s(1) - s(2) : s(1);
        ++rows;
      }
      if (longest == 0) continue;
      ghost = limits_.clamp(sum * (1.0 / rows));
      return true;
    }
    return false;
  }

  const GridStorage<T>& storage_;
  RowDirections directions_;
  GhostLimits<T> limits_;
  Coord first_, final_, blocks_;  ///< bounds of the box with one sample around it, and its size in blocks
};

}  // namespace

template <class T>
Result<HaloGrid<T>> make_halo(const GridStorage<T>& storage, const GridStats& stats) {
  const GhostMaker<T> ghost_maker(storage, stats);
  if (!(ghost_maker.blocks() <= kMaxHaloBlocks))
    return Error{fmt::format("has {:.3g} blocks of 8^3 voxels, expected at most {:.3g} for the interpolation \"cubic\"",
                             ghost_maker.blocks(), kMaxHaloBlocks)};
  const std::vector<Coord> origins = ghost_maker.with_ghosts();
  using Leaf = typename NanoTypes<T>::Leaf;
  CATENA_CHECK(
      check_memory_available("the cubic interpolation", static_cast<double>(origins.size()) * (sizeof(Leaf) + sizeof(NanoBlock<T>))));
  HaloGrid<T> result{reserve_leaves<T>(origins.size()), nullptr};
  parallel_for(origins.size(), 8, [&](std::size_t begin, std::size_t end) {
    Neighbourhood<T> window(storage);
    for (std::size_t n = begin; n < end; ++n) ghost_maker.fill(origins[n], window, NanoBuilder<T>::leaf_at(result.memory.data(), n));
  });
  std::vector<NanoBlock<T>> blocks(origins.size());
  for (std::size_t n = 0; n < origins.size(); ++n) blocks[n] = {origins[n], static_cast<std::uint32_t>(n), {}};
  CATENA_TRY(result.memory, build_from_blocks<T>(std::move(result.memory), origins.size(), std::move(blocks), T(0.f)));
  result.grid = &as_nano_grid<T>(result.memory);
  return result;
}

template Result<HaloGrid<float>> make_halo(const GridStorage<float>&, const GridStats&);
template Result<HaloGrid<nanovdb::Vec3f>> make_halo(const GridStorage<nanovdb::Vec3f>&, const GridStats&);

}  // namespace catena::field
