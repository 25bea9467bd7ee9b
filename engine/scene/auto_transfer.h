// SPDX-License-Identifier: MIT
/// Automatic transfer function from the histogram of a field, for volumes that specify none. Off the tick, any thread.
///   range       0.5 to 99.8 percentile of the values within the display range (engine/field/field_display_range.h), cut into 256 bins
///   background  b: center of the fullest bin of the lowest 15 % of the bins if these hold over 10 % of the samples; else center of the
///               fullest bin of all if it holds over 30 % of the samples and the grid has no mask; else the lowest value of the range
///   weight      w(s) = smoothstep of |s - b| from a 6 % margin to the far end of the range
///   extinction  sigma(s) = k w(s), with k such that the mean optical depth of a ray across the domain is 2.5
/// If the mapping (ValueMapping) is not linear, s, b and the bins are on its scale.
#pragma once
#include <memory>
#include <vector>

#include "engine/field/field_display_range.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Returns field::sample_values of the grid in rising order: the samples that complete_transfer evaluates.
std::shared_ptr<const std::vector<float>> sorted_values(const field::ScalarGrid& grid);

/// Cached component of an entity with a FieldSource: the sorted_values of its rendered grid.
struct SortedValues {
  const void* grid = nullptr;                        ///< Grid from which `sorted` was taken, to detect a changed grid
  std::shared_ptr<const std::vector<float>> sorted;  ///< Values in rising order
};

/// Returns whether the function has colors and either extinctions or opacities.
bool is_complete(const TransferFunction& transfer);
/// Adds missing parts: colors if there are none, extinctions if there are neither extinctions nor opacities. A stated range replaces the
/// percentile range; a named map without a range covers the whole display range (engine/field/field_display_range.h).
void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid);
/// Completes the function as complete_transfer(transfer, grid) does, with the sorted_values of the grid computed beforehand.
void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid, const std::vector<float>& sorted);

}  // namespace catena::scene
