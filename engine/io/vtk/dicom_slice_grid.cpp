// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_slice_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena::vtk {
namespace {

/// Returns the maximum difference between the file's slices and the sampling grid at their positions, as a fraction of the range.
double lattice_error(const std::vector<float>& slices, const std::vector<float>& even, std::size_t voxels, const DicomSliceGrid& lattice) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo, max_error = 0;
  for (std::size_t k = 0; k < lattice.stated_positions.size(); ++k) {
    const double position = std::clamp(lattice.stated_positions[k], 0.0, static_cast<double>(lattice.count - 1));
    const auto n = std::min(static_cast<std::size_t>(position), lattice.count - 2);
    const double t = position - static_cast<double>(n);
    const auto part = [&](double weight, std::size_t at) { return weight > 0 ? weight * static_cast<double>(even[at]) : 0.0; };
    for (std::size_t i = 0; i < voxels; ++i) {
      const double value = static_cast<double>(slices[k * voxels + i]);
      const double interpolated = part(1 - t, n * voxels + i) + part(t, (n + 1) * voxels + i);
      if (std::isfinite(value)) lo = std::min(lo, value), hi = std::max(hi, value);
      if (std::isfinite(value) && std::isfinite(interpolated)) max_error = std::max(max_error, std::fabs(value - interpolated));
    }
  }
  return hi > lo ? max_error / (hi - lo) : 0;
}

/// Number of steps between slices: the smallest number whose nodes meet every position, otherwise the one whose nodes come nearest to all.
struct Steps {
  double count = 1;
  bool exact = false;
};
Steps steps_for(const std::vector<double>& positions, double min_distance, double most_slices) {
  constexpr double kOfStep = 0.01, kOfLeast = 1e-5;
  const double span = positions.back(), fewest = std::max(1.0, std::ceil(span / min_distance - kOfStep));
  Steps best{std::max(1.0, std::min(fewest, most_slices - 1)), false};
  double nearest = std::numeric_limits<double>::infinity();
  for (double count = best.count; count + 1 <= most_slices; ++count) {
    const double step = span / count, tolerance = std::max(kOfStep * step, kOfLeast * min_distance);
    double deviation = 0;
    for (auto position = positions.begin(); position != positions.end() && deviation < nearest; ++position) {
      const double at = *position / step;
      deviation = std::max(deviation, std::fabs(at - std::round(at)) * step);
    }
    if (deviation <= tolerance && deviation < nearest && count >= fewest) return {count, true};
    if (deviation < nearest) nearest = deviation, best.count = count;
  }
  return best;
}

/// Finds distances that are not slice spacings: the space between two acquisitions, or several missing slices.
void find_gaps(const std::vector<double>& positions, DicomSliceGrid& lattice) {
  constexpr double kOfNeighbour = 2.05, kOfMedian = 10;
  std::vector<double> distances;
  for (std::size_t k = 1; k < positions.size(); ++k) distances.push_back(positions[k] - positions[k - 1]);
  if (distances.size() < 2) return;
  std::vector<double> ordered = distances;
  const auto middle = ordered.begin() + static_cast<std::ptrdiff_t>((ordered.size() - 1) / 2);
  std::ranges::nth_element(ordered, middle);
  const auto is_wide = [&](std::size_t k) {
    const double before = k > 0 ? distances[k - 1] : 0, after = k + 1 < distances.size() ? distances[k + 1] : 0;
    return distances[k] > kOfNeighbour * std::max(before, after) || distances[k] > kOfMedian * *middle;
  };
  lattice.is_open_gap.assign(distances.size(), false);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (!is_wide(k)) continue;
    lattice.is_open_gap[k] = k > 0 && k + 1 < distances.size() && !is_wide(k - 1) && !is_wide(k + 1);
    double& widest = lattice.is_open_gap[k] ? lattice.widest_open_gap : lattice.widest_filled_gap;
    widest = std::max(widest, distances[k]);
  }
}

}  // namespace

DicomSliceGrid fit_slice_grid(const DicomVolume& volume) {
  DicomSliceGrid lattice;
  const DicomFrame &first = *volume.frames.front(), &last = *volume.frames.back();
  lattice.origin = first.position;
  const std::size_t n = volume.frames.size();
  lattice.count = n;
  if (n == 1) {
    const double pixel = first.column_spacing > 0 ? std::min(first.column_spacing, first.row_spacing) : 1;
    lattice.step = (first.thickness > 0 ? first.thickness : pixel) * first.normal();
    lattice.positions = lattice.stated_positions = {0};
    return lattice;
  }
  const double span = last.offset() - first.offset();
  lattice.min_distance = span;
  std::vector<double> positions;
  for (const DicomFrame* frame : volume.frames) positions.push_back(frame->offset() - first.offset());
  for (std::size_t k = 1; k < n; ++k) {
    lattice.min_distance = std::min(lattice.min_distance, positions[k] - positions[k - 1]);
    lattice.max_distance = std::max(lattice.max_distance, positions[k] - positions[k - 1]);
  }
  constexpr double kEven = 0.01;
  lattice.is_uniform = lattice.max_distance - lattice.min_distance <= kEven * lattice.min_distance;
  double steps = static_cast<double>(n - 1);
  if (!lattice.is_uniform) {
    // at most eight times the number of slices in the file, or as many as fit in a reasonable amount of memory
    constexpr double kMaxSlices = 4096, kTimes = 8, kVoxels = 32e6;
    const double slice_count = static_cast<double>(n), by_memory = kVoxels / (static_cast<double>(first.columns) * first.rows);
    const double max_slices =
        std::max(std::clamp(kTimes * slice_count, 64.0, std::max(kMaxSlices, slice_count)), std::min(kMaxSlices, by_memory));
    const Steps planned = steps_for(positions, lattice.min_distance, max_slices);
    steps = planned.count;
    lattice.is_exact = planned.exact;
    find_gaps(positions, lattice);
  }
  lattice.count = static_cast<std::size_t>(steps) + 1;
  lattice.step = (last.position - first.position) / steps;
  for (const double position : positions) {
    lattice.stated_positions.push_back(position / span * steps);
    lattice.positions.push_back(lattice.is_exact ? std::round(lattice.stated_positions.back()) : lattice.stated_positions.back());
  }
  if (lattice.is_uniform)
    for (std::size_t k = 0; k < n; ++k) lattice.positions[k] = static_cast<double>(k);
  return lattice;
}

std::vector<float> resample_slices(const std::vector<float>& slices, std::size_t voxels, const DicomSliceGrid& lattice, bool zero_between) {
  std::vector<float> even(voxels * lattice.count);
  std::size_t k = 0;
  for (std::size_t n = 0; n < lattice.count; ++n) {
    const double position = std::min(static_cast<double>(n), lattice.positions.back());
    while (k + 2 < lattice.positions.size() && lattice.positions[k + 1] <= position) ++k;
    const double before = position - lattice.positions[k], after = lattice.positions[k + 1] - position;
    const double t = std::clamp(before / (before + after), 0.0, 1.0);
    const float *a = slices.data() + k * voxels, *b = a + voxels;
    float* to = even.data() + n * voxels;
    if (t == 0 || t == 1) {
      std::copy_n(t == 0 ? a : b, voxels, to);
      continue;
    }
    if (zero_between) continue;
    // a node less than a step from a slice belongs to the cell of that slice
    if (k < lattice.is_open_gap.size() && lattice.is_open_gap[k] && std::min(before, after) >= 1) {
      std::fill_n(to, voxels, std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    for (std::size_t i = 0; i < voxels; ++i)
      to[i] = static_cast<float>((1 - t) * static_cast<double>(a[i]) + t * static_cast<double>(b[i]));
  }
  return even;
}

std::string slice_grid_note(const DicomSliceGrid& lattice, const std::vector<float>& slices, const std::vector<float>& even,
                            std::size_t voxels, bool zero_between) {
  std::string note =
      fmt::format("the slices are {:.4g} to {:.4g} mm apart: {} slices were resampled to {} at equal distances of {:.4g} mm, {}",
                  lattice.min_distance, lattice.max_distance, lattice.positions.size(), lattice.count, norm(lattice.step),
                  zero_between ? "with 0 where the segment has no slice" : "by linear interpolation");
  // differences below the rounding of 32-bit floats are not reported
  constexpr double kLost = 1e-6;
  if (const double error = lattice_error(slices, even, voxels, lattice); error > kLost)
    note += fmt::format("; at the original slices the values differ by up to {:.2g} % of the range", 100 * error);
  if (zero_between) return note;
  if (const auto gaps = std::ranges::count(lattice.is_open_gap, true); gaps > 0)
    note += fmt::format("; {} {:.4g} mm {} no values", gaps == 1 ? "a gap of" : fmt::format("{} gaps of up to", gaps),
                        lattice.widest_open_gap, gaps == 1 ? "has" : "have");
  if (lattice.widest_filled_gap > 0) note += fmt::format("; a gap of {:.4g} mm beside a single slice is filled", lattice.widest_filled_gap);
  return note;
}

}  // namespace catena::vtk
