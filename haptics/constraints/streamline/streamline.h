/// The streamline link (paper, section 4, Eqs. 1-4): keeps the proxy on the streamline through a seed, at the local minimum of
/// the distance to the probe that lies downhill from where the proxy is.
///   selected (a seed, no method): moves on the traced arc-length curve, the same object that is drawn; streamline/selected.h
///   online (a method, "follow": "online", or no seed): integrates every tick; streamline/online.h
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType streamline_constraint();

}  // namespace catena::haptics
