// SPDX-License-Identifier: MIT
/// Groups of the labels of a label map by opacity, one surface each. Off the tick, any thread.
#pragma once
#include <span>
#include <vector>

#include "engine/field/derived/label_surface.h"
#include "engine/scene/components.h"

namespace catena::scene {

inline constexpr std::size_t kMaxLabelGroups = 8;  ///< Maximum number of groups, the number of surfaces that an image may have

/// Labels that are shown with the same opacity.
struct LabelGroup {
  double opacity = 1;          ///< 0 to 1
  std::vector<double> values;  ///< Labels, rising
};

/// Returns the groups of all labels but 0, opacities falling. A label has the opacity of the last request that names it, else 1. Error: a
/// request that names no label of the map, or more than kMaxLabelGroups opacities.
Result<std::vector<LabelGroup>> group_labels(std::span<const field::LabelCount> counts, const LabelTable& table,
                                             std::span<const LabelOpacity> requests);

}  // namespace catena::scene
