// SPDX-License-Identifier: MIT
#include "engine/field/measure/labels.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <unordered_map>

#include "engine/base/numbers.h"
#include "engine/field/measure/slabs.h"

namespace catena::field {
namespace {

/// Labels in the order of their first voxel.
struct LabelTally {
  std::vector<MeasuredLabel> labels;
  std::unordered_map<float, std::uint32_t> numbers{};
  std::optional<std::pair<Index3, float>> not_a_label{};

  MeasuredLabel& of(float label) {
    const auto [found, inserted] = numbers.try_emplace(label, static_cast<std::uint32_t>(labels.size()));
    if (inserted) labels.emplace_back().label = label;
    return labels[found->second];
  }
  bool is_too_many() const { return labels.size() > kMaxMeasuredLabels; }
};

bool can_be_label(float value) { return value == std::nearbyint(value) && std::fabs(value) <= kMaxMeasuredLabel; }

LabelTally tally_labels(const VoxelSlab& slab) {
  LabelTally tally;
  std::size_t at = 0;
  for (int k = 0; k < slab.size.z; ++k)
    for (int j = 0; j < slab.size.y; ++j)
      for (int i = 0; i < slab.size.x;) {
        if (slab.counted[at] == 0) {
          ++i, ++at;
          continue;
        }
        const float label = slab.voxels[at] == 0 ? 0.f : slab.voxels[at];  // without the sign of -0
        if (!can_be_label(label)) {
          tally.not_a_label = {{slab.origin.x + i, slab.origin.y + j, slab.origin.z + k}, label};
          return tally;
        }
        MeasuredLabel& measured = tally.of(label);
        if (tally.is_too_many()) return tally;
        const int first = i;
        for (; i < slab.size.x && slab.counted[at] != 0 && slab.voxels[at] == label; ++i, ++at)
          if (!slab.values.empty() && !std::isnan(slab.values[at])) measured.values.add(slab.values[at]);
        measured.add_run(slab.origin.x + first, slab.origin.x + i - 1, slab.origin.y + j, slab.origin.z + k);
      }
  return tally;
}

/// Two layers of labels with a margin of one voxel of label 0.
struct PaddedLayers {
  Index3 size;  ///< voxels, margin included; z: layers
  std::vector<float> labels;

  PaddedLayers(const ScalarGrid& map, const VoxelBox& box, int z, int layers)
      : size{box.size.x + 2, box.size.y + 2, layers}, labels(static_cast<std::size_t>(size.x) * size.y * layers, 0.f) {
    const int from = std::max(z, 0), to = std::min(z + layers, box.size.z);
    if (from >= to) return;
    const VoxelSlab slab = SlabReader(map, box, nullptr).read(from, to - from);
    std::size_t at = 0;
    for (int k = from - z; k < to - z; ++k)
      for (int j = 0; j < box.size.y; ++j) {
        float* row = &labels[(static_cast<std::size_t>(k) * size.y + static_cast<std::size_t>(j) + 1) * size.x + 1];
        for (int i = 0; i < box.size.x; ++i, ++at) row[i] = slab.counted[at] != 0 ? slab.voxels[at] : 0.f;
      }
  }
};

/// Areas of all labels in the cells between some layers.
std::vector<double> areas_in(const PaddedLayers& layers, const std::unordered_map<float, std::size_t>& numbers,
                             const std::array<double, 256>& cell_areas) {
  std::vector<double> areas(numbers.size(), 0.0);
  const std::size_t nx = static_cast<std::size_t>(layers.size.x), slice = nx * static_cast<std::size_t>(layers.size.y);
  for (int k = 0; k + 1 < layers.size.z; ++k)
    for (int j = 0; j + 1 < layers.size.y; ++j) {
      const float* row = &layers.labels[static_cast<std::size_t>(k) * slice + static_cast<std::size_t>(j) * nx];
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        const float corner[8] = {row[i],         row[i + 1],         row[i + nx],         row[i + nx + 1],
                                 row[i + slice], row[i + slice + 1], row[i + slice + nx], row[i + slice + nx + 1]};
        unsigned remaining = 0;  // corners of the labels that are not yet measured
        bool same = true;
        for (unsigned c = 0; c < 8; ++c) {
          same = same && corner[c] == corner[0];
          remaining |= corner[c] != 0 ? 1u << c : 0u;
        }
        if (same) continue;
        for (unsigned c = 0; c < 8; ++c) {
          if ((remaining >> c & 1) == 0) continue;
          unsigned with_label = 0;
          for (unsigned other = c; other < 8; ++other) with_label |= corner[other] == corner[c] ? 1u << other : 0u;
          remaining &= ~with_label;
          areas[numbers.at(corner[c])] += cell_areas[with_label];
        }
      }
    }
  return areas;
}

}  // namespace

Result<MeasuredLabels> measure_labels(const ScalarGrid& map, const ScalarField* values) {
  CATENA_TRY(const VoxelBox box, measurable_box(map));
  const SlabReader reader(map, box, values);
  LabelTally all;
  for_slabs<LabelTally>(
      box.size.z,
      [&](int z, int layers) { return all.not_a_label || all.is_too_many() ? LabelTally{} : tally_labels(reader.read(z, layers)); },
      [&](LabelTally&& part) {
        if (!all.not_a_label) all.not_a_label = part.not_a_label;
        if (all.not_a_label || all.is_too_many()) return;
        for (const MeasuredLabel& label : part.labels) all.of(label.label).merge(label);
      });
  if (all.not_a_label) {
    const auto& [at, value] = *all.not_a_label;
    return Error{fmt::format("voxel {} {} {} holds {}; a label map, whose voxels are integers up to {}, was expected", at.x, at.y, at.z,
                             format_readable(value), kMaxMeasuredLabel)};
  }
  if (all.is_too_many()) return Error{fmt::format("there are more than {} labels; a label map was expected", kMaxMeasuredLabels)};
  std::sort(all.labels.begin(), all.labels.end(), [](const MeasuredLabel& a, const MeasuredLabel& b) { return a.label < b.label; });
  return MeasuredLabels{std::move(all.labels), left_out(map, box)};
}

Outcome add_label_surfaces(const ScalarGrid& map, const std::array<double, 256>& cell_areas, MeasuredLabels& measured) {
  CATENA_TRY(const VoxelBox box, measurable_box(map));
  std::unordered_map<float, std::size_t> numbers;
  for (std::size_t n = 0; n < measured.labels.size(); ++n) numbers[measured.labels[n].label] = n;
  for_slabs<std::vector<double>>(
      box.size.z + 1,  // layers of cells: the first one is below the first slice
      [&](int z, int layers) { return areas_in(PaddedLayers(map, box, z - 1, layers + 1), numbers, cell_areas); },
      [&](std::vector<double>&& areas) {
        for (std::size_t n = 0; n < areas.size(); ++n) measured.labels[n].surface += areas[n];
      });
  return Done{};
}

}  // namespace catena::field
