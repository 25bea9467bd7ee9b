/// A transfer function from the values themselves, for volumes that state none. Off the tick, any thread.
///   background b, in a range from the 0.5 to the 99.8 percentile of the values in the display range (engine/field/field_display_range.h),
///   cut into 256 bins: the fullest bin of the lowest 15 % where those hold over 10 % of the samples; else the fullest of all where it
///   holds over 30 % and no mask cuts the background away; else the lowest value. w(s) = smoothstep of |s - b| from a 6 % margin to the far
///   end of the range; sigma(s) = k w(s), k such that a ray across the domain meets an optical depth of 2.5 on average.
/// Where values lie on a scale that is not linear (ValueMapping), s, b and the bins do, too.
#pragma once
#include <memory>
#include <vector>

#include "engine/field/field_display_range.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// field::sample_values in rising order, as many as complete_transfer looks at.
std::shared_ptr<const std::vector<float>> sorted_values(const field::ScalarGrid& grid);

/// Beside a FieldSource once a transfer function has asked: the sorted_values of its drawn grid.
struct ValueSample {
  const void* grid = nullptr;
  std::shared_ptr<const std::vector<float>> sorted;
};

/// Fills what is missing: colours if there are none, extinctions if there are neither extinctions nor opacities. A stated range
/// replaces that of the percentiles; a map named without one reaches over the display range (engine/field/field_display_range.h).
bool is_complete(const TransferFunction& transfer);
void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid);
/// With the sorted_values of the grid that were made before.
void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid, const std::vector<float>& sorted);

}  // namespace catena::scene
