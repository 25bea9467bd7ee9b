// SPDX-License-Identifier: MIT
#include "engine/field/derived/box_downsample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "engine/field/grid/grid_factory.h"

namespace catena::field {
namespace {

constexpr int kLeaf = 8;

/// Fine voxels that contribute to a coarse voxel along one axis, at most factor + 1, with their weights.
struct Window {
  int count = 0;
  std::array<int, 9> at{};       ///< fine indices
  std::array<float, 9> odd{};    ///< weights by odd reflection; they sum to 1
  std::array<float, 9> plain{};  ///< weights by plain reflection; none is negative

  void add(int index, float o, float p) {
    int i = 0;
    while (i < count && at[i] != index) ++i;
    if (i == count) at[count++] = index;
    odd[i] += o;
    plain[i] += p;
  }
};

class Axis {
 public:
  Axis(int lo, int hi, int factor) : lo_(lo), hi_(hi), factor_(factor) {
    const double middle = 0.5 * (factor - 1);
    domain_lo = (lo - middle) / factor;
    domain_hi = (hi - middle) / factor;
    first = int(std::floor(domain_lo));
    last = int(std::ceil(domain_hi));
  }
  Window window(int c) const {
    Window w;
    const float part = 1.0f / float(factor_);
    for (int i = factor_ * c; i < factor_ * (c + 1); ++i) {
      if (i < lo_) {
        const int mirrored = std::min(2 * lo_ - i, hi_);
        w.add(lo_, 2 * part, 0);
        w.add(mirrored, -part, part);
      } else if (i > hi_) {
        const int mirrored = std::max(2 * hi_ - i, lo_);
        w.add(hi_, 2 * part, 0);
        w.add(mirrored, -part, part);
      } else {
        w.add(i, part, part);
      }
    }
    return w;
  }
  int first, last;  ///< first and last index of the coarse voxels
  double domain_lo, domain_hi;

 private:
  int lo_, hi_, factor_;
};

/// The 8^3 coarse voxels of one leaf, clipped to the coarse box.
class Leaf {
 public:
  Leaf(const ScalarGrid& grid, const std::array<Axis, 3>& axes, const nanovdb::Coord& origin) : grid_(grid) {
    for (int a = 0; a < 3; ++a) {
      begin[a] = std::max(axes[a].first - origin[a], 0);
      end[a] = std::min(axes[a].last - origin[a] + 1, kLeaf);
      int lo = std::numeric_limits<int>::max(), hi = std::numeric_limits<int>::min();
      for (int i = begin[a]; i < end[a]; ++i) {
        windows_[a][i] = axes[a].window(origin[a] + i);
        const Window& w = windows_[a][i];
        lo = std::min(lo, *std::min_element(w.at.begin(), w.at.begin() + w.count));
        hi = std::max(hi, *std::max_element(w.at.begin(), w.at.begin() + w.count));
      }
      lo_[a] = lo;
      size_[a] = hi - lo + 1;
    }
  }

  /// Returns true if all fine voxels that contribute have the same finite value, and sets `value` to it; false if the grid has a mask.
  bool constant(float& value) const {
    if (grid_.has_mask()) return false;
    const auto down = [](int v) { return v & ~(kLeaf - 1); };
    bool some = false;
    for (int z = down(lo_[2]); z < lo_[2] + size_[2]; z += kLeaf)
      for (int y = down(lo_[1]); y < lo_[1] + size_[1]; y += kLeaf)
        for (int x = down(lo_[0]); x < lo_[0] + size_[0]; x += kLeaf) {
          float block_value = 0;
          if (!grid_.is_constant_block({x, y, z}, block_value) || !std::isfinite(block_value) || (some && block_value != value))
            return false;
          value = block_value;
          some = true;
        }
    return some;
  }

  void read() {
    values_.resize(std::size_t(size_[0]) * size_[1] * size_[2]);
    grid_.read_block({lo_[0], lo_[1], lo_[2]}, {size_[0], size_[1], size_[2]}, values_);
    if (grid_.has_mask()) find_counting();
  }

  float average(int x, int y, int z) const {
    const Window &wx = windows_[0][x], &wy = windows_[1][y], &wz = windows_[2][z];
    if (grid_.interpolation() == Interpolation::nearest) {
      const std::size_t row = row_of(wy.at[wy.count / 2] - lo_[1], wz.at[wz.count / 2] - lo_[2]);
      return values_[row + std::size_t(wx.at[wx.count / 2] - lo_[0])];
    }
    double odd = 0, plain = 0, weight = 0;
    bool all = true;
    for (int k = 0; k < wz.count; ++k)
      for (int j = 0; j < wy.count; ++j) {
        const std::size_t row = row_of(wy.at[j] - lo_[1], wz.at[k] - lo_[2]);
        const double o = double(wy.odd[j]) * wz.odd[k], p = double(wy.plain[j]) * wz.plain[k];
        for (int i = 0; i < wx.count; ++i) {
          const std::size_t at = row + std::size_t(wx.at[i] - lo_[0]);
          if (!counts_.empty() && !counts_[at]) {
            all = false;
            continue;
          }
          odd += o * wx.odd[i] * values_[at];
          plain += p * wx.plain[i] * values_[at];
          weight += p * wx.plain[i];
        }
      }
    if (all) return float(odd);
    return weight > 0 ? float(plain / weight) : std::numeric_limits<float>::quiet_NaN();
  }

  std::array<int, 3> begin{}, end{};  ///< range of the voxels within the coarse box, relative to the leaf

 private:
  std::size_t row_of(int y, int z) const { return (std::size_t(z) * size_[1] + y) * size_[0]; }

  /// Marks the contributing voxels: a voxel contributes if it is finite and a corner of a valid cell.
  void find_counting() {
    const Index3 n{size_[0] + 1, size_[1] + 1, size_[2] + 1};
    std::vector<std::uint8_t> cells(std::size_t(n.x) * n.y * n.z);
    grid_.read_cell_validity({lo_[0] - 1, lo_[1] - 1, lo_[2] - 1}, n, cells);
    counts_.assign(values_.size(), 0);
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) {
          std::uint8_t any = 0;
          for (int c = 0; c < 8; ++c) any |= cells[(std::size_t(z + (c >> 2)) * n.y + y + (c >> 1 & 1)) * n.x + x + (c & 1)];
          const std::size_t at = row_of(y, z) + std::size_t(x);
          counts_[at] = any && std::isfinite(values_[at]);
        }
  }

  const ScalarGrid& grid_;
  std::array<std::array<Window, kLeaf>, 3> windows_{};
  std::array<int, 3> lo_{}, size_{};
  std::vector<float> values_;
  std::vector<std::uint8_t> counts_;  ///< 1 for each fine voxel that contributes; empty: all contribute
};

/// Builds the masks of the blocks at `origins`: all voxels are valid. The coarse cell at c consists of factor^3 fine cells that start at
/// factor * c + factor / 2; it is invalid if at least half of those within the fine grid are.
Outcome mask_cells(const ScalarGrid& grid, int factor, const std::vector<nanovdb::Coord>& origins, NanoBuffers& buffers) {
  using Mask = nanovdb::ValueMask;
  std::vector<NanoBlock<Mask>> voxels, cells;
  NanoMemory memory = reserve_leaves<Mask>(origins.size());
  for (std::size_t n = 0; n < origins.size(); ++n) {
    voxels.push_back({origins[n], NanoBlock<Mask>::kTile, true});
    cells.push_back({origins[n], static_cast<std::uint32_t>(n), false});
  }
  const Vec3 &lo = grid.index_box().lo, &hi = grid.index_box().hi;
  parallel_for(origins.size(), 1, [&](std::size_t begin, std::size_t end) {
    const int edge = kLeaf * factor;
    std::vector<std::uint8_t> fine(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
    for (std::size_t n = begin; n < end; ++n) {
      auto& leaf = NanoBuilder<Mask>::leaf_at(memory.data(), n);
      leaf.mBBoxMin = origins[n];
      const nanovdb::Coord first(origins[n][0] * factor + factor / 2, origins[n][1] * factor + factor / 2,
                                 origins[n][2] * factor + factor / 2);
      grid.read_cell_validity({first[0], first[1], first[2]}, {edge, edge, edge}, fine);
      int all[512] = {}, valid[512] = {};
      std::size_t i = 0;
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x, ++i) {
            const Vec3 base(first[0] + x, first[1] + y, first[2] + z);
            bool legal = true;
            for (int a = 0; a < 3; ++a) legal = legal && base[a] >= lo[a] && base[a] < std::max(hi[a], lo[a] + 1);
            const int at = x / factor * 64 + y / factor * 8 + z / factor;
            all[at] += legal ? 1 : 0;
            valid[at] += fine[i];
          }
      for (int at = 0; at < 512; ++at)
        if (all[at] == 0 || 2 * valid[at] > all[at]) leaf.mValueMask.setOn(static_cast<std::uint32_t>(at));
    }
  });
  CATENA_TRY(buffers.valid_voxels, build_from_blocks<Mask>(reserve_leaves<Mask>(0), 0, std::move(voxels), false));
  CATENA_TRY(buffers.input_cell_mask, build_from_blocks<Mask>(std::move(memory), origins.size(), std::move(cells), false));
  return Done{};
}

}  // namespace

Result<CoarseGrid> box_downsample(const ScalarGrid& grid, int factor) {
  CATENA_ASSERT(factor == 2 || factor == 4 || factor == 8);
  const Box& box = grid.index_box();
  const auto axis = [&](int a) { return Axis(int(std::lround(box.lo[a])), int(std::lround(box.hi[a])), factor); };
  const std::array<Axis, 3> axes{axis(0), axis(1), axis(2)};

  // every block of the box is examined: a sparse grid may span far more blocks than it stores
  const auto down = [](int v) { return v & ~(kLeaf - 1); };
  double block_count = 1;
  for (const Axis& a : axes) block_count *= (down(a.last) - down(a.first)) / kLeaf + 1;
  constexpr double kMaxBlocks = 4e9;
  const std::string what = fmt::format("grid \"{}\" at 1/{} of its resolution", grid.name(), factor);
  if (block_count > kMaxBlocks) return Error{fmt::format("{} has {:.0f} blocks, expected at most {:.0f}", what, block_count, kMaxBlocks)};
  CATENA_CHECK(check_memory_available(what, block_count * (sizeof(nanovdb::Coord) + 1 + sizeof(float))));

  // a constant block becomes a tile, or is omitted if it has the background value
  const float background = grid.background();
  std::vector<nanovdb::Coord> origins;
  origins.reserve(static_cast<std::size_t>(block_count));
  for (int x = down(axes[0].first); x <= axes[0].last; x += kLeaf)
    for (int y = down(axes[1].first); y <= axes[1].last; y += kLeaf)
      for (int z = down(axes[2].first); z <= axes[2].last; z += kLeaf) origins.emplace_back(x, y, z);
  std::vector<std::uint8_t> is_constant(origins.size());
  std::vector<float> constants(origins.size());
  parallel_for(origins.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) is_constant[i] = Leaf(grid, axes, origins[i]).constant(constants[i]);
  });
  // the box of a grid is the box of its active voxels: the two corners of the box are stored as active voxels
  const nanovdb::Coord lowest(axes[0].first, axes[1].first, axes[2].first), highest(axes[0].last, axes[1].last, axes[2].last);
  const auto leaf_of = [&](const nanovdb::Coord& c) { return nanovdb::Coord(down(c[0]), down(c[1]), down(c[2])); };
  std::vector<NanoBlock<float>> blocks;
  std::vector<nanovdb::Coord> leaves;
  std::vector<std::uint8_t> averaged;  // 1 for leaves to average; the others hold the background with at most an active corner of the box
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const bool corner = origins[i] == leaf_of(lowest) || origins[i] == leaf_of(highest);
    const bool empty = is_constant[i] && constants[i] == background;
    if (empty && !corner) continue;
    const Leaf leaf(grid, axes, origins[i]);
    const bool is_complete = leaf.begin == std::array{0, 0, 0} && leaf.end == std::array{kLeaf, kLeaf, kLeaf};
    if (is_constant[i] && is_complete && !empty) {
      blocks.push_back({origins[i], NanoBlock<float>::kTile, constants[i]});
    } else {
      blocks.push_back({origins[i], static_cast<std::uint32_t>(leaves.size()), 0.f});
      leaves.push_back(origins[i]);
      averaged.push_back(empty ? 0 : 1);
    }
  }
  CATENA_CHECK(check_memory_available(what, static_cast<double>(leaves.size()) * sizeof(NanoTypes<float>::Leaf)));
  NanoMemory memory = reserve_leaves<float>(leaves.size());
  parallel_for(leaves.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      auto& data = NanoBuilder<float>::leaf_at(memory.data(), n);
      data.mBBoxMin = leaves[n];
      std::fill_n(data.mValues, 512, background);
      const auto activate = [&](const nanovdb::Coord& c) {
        if (leaf_of(c) == leaves[n]) data.mValueMask.setOn(static_cast<std::uint32_t>((c[0] & 7) * 64 + (c[1] & 7) * 8 + (c[2] & 7)));
      };
      activate(lowest);
      activate(highest);
      if (!averaged[n]) continue;
      Leaf leaf(grid, axes, leaves[n]);
      leaf.read();
      for (int x = leaf.begin[0]; x < leaf.end[0]; ++x)
        for (int y = leaf.begin[1]; y < leaf.end[1]; ++y)
          for (int z = leaf.begin[2]; z < leaf.end[2]; ++z)
            data.setValue(static_cast<std::uint32_t>(x * 64 + y * 8 + z), leaf.average(x, y, z));
    }
  });
  NanoBuffers buffers;
  CATENA_TRY(buffers.values, build_from_blocks<float>(std::move(memory), leaves.size(), std::move(blocks), background));

  if (grid.has_cell_mask()) CATENA_CHECK(mask_cells(grid, factor, origins, buffers));

  const Mapping& fine = grid.mapping();
  const Mapping mapping =
      Mapping::from_linear(fine.world_from_index_linear * double(factor), fine.world_from_index(Vec3(0.5 * (factor - 1))));
  CoarseGrid coarse;
  CATENA_TRY(coarse.grid, grid_from_buffers<ScalarGrid>(grid.name(), mapping, std::move(buffers)));
  // the interpolation "nearest" is kept; all other coarse grids, which are previews, use linear interpolation
  if (grid.interpolation() == Interpolation::nearest) coarse.grid = coarse.grid->with_interpolation(Interpolation::nearest);
  coarse.domain = {{axes[0].domain_lo, axes[1].domain_lo, axes[2].domain_lo}, {axes[0].domain_hi, axes[1].domain_hi, axes[2].domain_hi}};
  return coarse;
}

}  // namespace catena::field
