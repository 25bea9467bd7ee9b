// SPDX-License-Identifier: MIT
/// Link of the widgets: its feature is set in every tick (LinkState::shape, filled by haptics/chain/widgets.h) instead of by the scene:
/// a plane, a sphere or a point, held from both sides, never released. Without a shape, or with one that is not finite, the probe passes
/// through, FREE. Closed form, no field sample. Not for scene files. World units. Haptic thread: no allocation, lock, or throw.
#pragma once
#include <memory>

#include "haptics/chain/constraint.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// Returns the constraint of a widget link; all its data is in LinkState.
std::shared_ptr<const Constraint> widget_constraint();

/// Appends the four links that all widgets share, with the coupling's stiffness, and sets program.first_widget_link to the first of them.
void add_widget_links(HapticProgram& program);

}  // namespace catena::haptics
