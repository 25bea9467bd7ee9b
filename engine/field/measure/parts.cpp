// SPDX-License-Identifier: MIT
#include "engine/field/measure/parts.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/field/measure/slabs.h"

namespace catena::field {
namespace {

/// Runs of a slab, and their number in each of its rows.
struct SlabRuns {
  std::vector<PartRun> runs;
  std::vector<std::uint32_t> in_row;
};

SlabRuns runs_above(const VoxelSlab& slab, double level) {
  SlabRuns made;
  std::size_t at = 0;
  for (int row = 0; row < slab.size.y * slab.size.z; ++row) {
    const std::size_t before = made.runs.size();
    bool inside = false;
    for (int i = 0; i < slab.size.x; ++i, ++at) {
      const bool above = slab.counted[at] != 0 && slab.voxels[at] >= level;
      if (above && !inside) made.runs.push_back({slab.origin.x + i, slab.origin.x + i, 0});
      if (above) made.runs.back().last = slab.origin.x + i;
      inside = above;
    }
    made.in_row.push_back(static_cast<std::uint32_t>(made.runs.size() - before));
  }
  return made;
}

/// Union-find on the runs: `part` of a run is the number of another run of its part, that of a root its own.
class RunJoiner {
 public:
  RunJoiner(PartMap& map, Neighbors neighbors) : map_(map), reach_(neighbors == Neighbors::all ? 1 : 0) {
    for (std::size_t n = 0; n < map.runs.size(); ++n) map.runs[n].part = static_cast<std::uint32_t>(n);
  }
  void join_all() {
    const Index3& size = map_.box.size;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y) {
        if (y > 0) join_rows(y, z, y - 1, z);
        for (int other = std::max(0, y - reach_); z > 0 && other <= std::min(size.y - 1, y + reach_); ++other)
          join_rows(y, z, other, z - 1);
      }
    for (std::size_t n = 0; n < map_.runs.size(); ++n) map_.runs[n].part = root(static_cast<std::uint32_t>(n));
  }

 private:
  std::uint32_t root(std::uint32_t n) {
    while (map_.runs[n].part != n) n = map_.runs[n].part = map_.runs[map_.runs[n].part].part;
    return n;
  }
  std::uint64_t row_number(int y, int z) const { return static_cast<std::uint64_t>(z) * map_.box.size.y + static_cast<std::uint64_t>(y); }
  void join_rows(int y, int z, int other_y, int other_z) {
    const std::uint64_t row = row_number(y, z), other = row_number(other_y, other_z);
    std::uint64_t a = map_.row_starts[row], b = map_.row_starts[other];
    while (a < map_.row_starts[row + 1] && b < map_.row_starts[other + 1]) {
      const PartRun &left = map_.runs[a], &right = map_.runs[b];
      if (left.first <= right.last + reach_ && right.first <= left.last + reach_) {
        // the root is the first run of the part
        const std::uint32_t i = root(static_cast<std::uint32_t>(a)), j = root(static_cast<std::uint32_t>(b));
        map_.runs[std::max(i, j)].part = std::min(i, j);
      }
      left.last < right.last ? ++a : ++b;
    }
  }

  PartMap& map_;
  int reach_;
};

Result<PartMap> find_runs(const SlabReader& reader, const VoxelBox& box, double level) {
  PartMap map{box, {0}, {}};
  const double rows = static_cast<double>(box.size.y) * box.size.z;
  CATENA_CHECK(check_memory_available("the table of parts", rows * sizeof(std::uint64_t)));
  map.row_starts.reserve(static_cast<std::size_t>(rows) + 1);
  Outcome enough = Done{};
  const std::uint64_t allowed = available_memory();
  for_slabs<SlabRuns>(
      box.size.z, [&](int z, int layers) { return enough ? runs_above(reader.read(z, layers), level) : SlabRuns{}; },
      [&](SlabRuns&& part) {
        if (!enough) return;
        const double runs = static_cast<double>(map.runs.size() + part.runs.size());
        constexpr double kGrowth = 2;  // vectors double their capacity
        enough = check_memory_available("the table of parts", runs * (kGrowth * sizeof(PartRun) + sizeof(std::uint64_t)), allowed);
        if (enough && runs >= std::numeric_limits<std::uint32_t>::max()) enough = Error{"there are too many parts"};
        if (!enough) return;
        map.runs.insert(map.runs.end(), part.runs.begin(), part.runs.end());
        for (const std::uint32_t n : part.in_row) map.row_starts.push_back(map.row_starts.back() + n);
      });
  CATENA_CHECK(enough);
  return map;
}

/// Numbers the parts by their size; returns the number of all parts, and sets `kept` to the number of those with their own number.
std::uint64_t number_by_size(PartMap& map, std::size_t max_parts, std::size_t& kept) {
  std::vector<std::uint64_t> sizes(map.runs.size(), 0);
  for (const PartRun& run : map.runs) sizes[run.part] += static_cast<std::uint64_t>(run.last - run.first) + 1;
  std::vector<std::uint32_t> roots;
  for (std::size_t n = 0; n < map.runs.size(); ++n)
    if (map.runs[n].part == n) roots.push_back(static_cast<std::uint32_t>(n));
  kept = std::min(max_parts, roots.size());
  std::partial_sort(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(kept), roots.end(),
                    [&](std::uint32_t a, std::uint32_t b) { return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : a < b; });
  for (std::size_t n = 0; n < roots.size(); ++n) sizes[roots[n]] = std::min(n, kept);  // from here on the number of the part
  for (PartRun& run : map.runs) run.part = static_cast<std::uint32_t>(sizes[run.part]);
  return roots.size();
}

}  // namespace

std::optional<std::uint32_t> PartMap::part_at(const Index3& voxel) const {
  const Index3 d{voxel.x - box.lo.x, voxel.y - box.lo.y, voxel.z - box.lo.z};
  if (d.x < 0 || d.y < 0 || d.z < 0 || d.x >= box.size.x || d.y >= box.size.y || d.z >= box.size.z) return std::nullopt;
  const std::span<const PartRun> in_row = row(voxel.y, voxel.z);
  const auto found =
      std::lower_bound(in_row.begin(), in_row.end(), voxel.x, [](const PartRun& run, std::int32_t x) { return run.last < x; });
  if (found == in_row.end() || found->first > voxel.x) return std::nullopt;
  return found->part;
}

Result<MeasuredParts> measure_parts(const ScalarGrid& grid, double level, Neighbors neighbors, std::size_t max_parts,
                                    const ScalarField* values) {
  CATENA_ASSERT(max_parts >= 1);
  CATENA_TRY(const VoxelBox box, measurable_box(grid));
  MeasuredParts measured;
  measured.left_out = left_out(grid, box);
  CATENA_TRY(measured.map, find_runs(SlabReader(grid, box, nullptr), box, level));
  if (measured.map.runs.empty())
    return Error{fmt::format("no voxel reaches the level {}; a level of at most {} was expected", to_text(level),
                             format_readable(grid.stats().max))};
  RunJoiner(measured.map, neighbors).join_all();
  std::size_t kept = 0;
  measured.count = number_by_size(measured.map, max_parts, kept);
  std::vector<RegionStats> all(kept + 1);
  const SlabReader reader(grid, box, values ? values : &grid);
  for_slabs<std::vector<RegionStats>>(
      box.size.z,
      [&](int z, int layers) {
        std::vector<RegionStats> parts(kept + 1);
        const VoxelSlab slab = reader.read(z, layers);
        for (int k = 0; k < layers; ++k)
          for (int j = 0; j < slab.size.y; ++j)
            for (const PartRun& run : measured.map.row(slab.origin.y + j, slab.origin.z + k)) {
              RegionStats& part = parts[run.part];
              part.add_run(run.first, run.last, slab.origin.y + j, slab.origin.z + k);
              const double* row = &slab.values[(static_cast<std::size_t>(k) * slab.size.y + static_cast<std::size_t>(j)) * slab.size.x];
              for (std::int32_t x = run.first; x <= run.last; ++x)
                if (const double value = row[x - slab.origin.x]; !std::isnan(value)) part.values.add(value);
            }
        return parts;
      },
      [&](std::vector<RegionStats>&& parts) {
        for (std::size_t n = 0; n < parts.size(); ++n) all[n].merge(parts[n]);
      });
  measured.others = all.back();
  all.pop_back();
  measured.parts = std::move(all);
  return measured;
}

}  // namespace catena::field
