/// A link of the widgets: its feature is not of the scene but of the tick (LinkState::shape, put there by haptics/chain/widgets.h):
/// a plane, a sphere or a point, held from both sides, never released. None, or one that is not finite: the probe is passed through,
/// FREE. Closed form, no field fetch. Not for scene files. World units. Haptic thread: no allocation, lock, or throw.
#pragma once
#include <memory>

#include "haptics/chain/constraint.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

std::shared_ptr<const Constraint> widget_constraint();

/// Appends the four links that widgets share, with the coupling's stiffness, and says so in first_widget_link.
void add_widget_links(HapticProgram& program);

}  // namespace catena::haptics
