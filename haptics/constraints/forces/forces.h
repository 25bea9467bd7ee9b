// SPDX-License-Identifier: MIT
/// The classical volume mode: a force along the gradient of a scalar field, proportional to the gradient's magnitude.
///   p = x +- displacement min(1, |grad s| / X) grad s / |grad s|,  X the field's largest gradient (engine/field/derived/magnitude.h)
/// so that the force is at most k_i S displacement. The normalization is safe: any scale of the field gives the same proxy.
/// Keys: `field` (scalar), `displacement` (maximum of |p - x|, world units, >= 0, may follow a field), `towards` high | low.
/// LinkStatus OK; on a plateau p = x; outside the domain, in the mask, or where values are not finite p = x and FREE.
/// One evaluation per tick. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType gradient_force_constraint();

/// A viscous fluid around the probe: the proxy p follows the probe x with the relaxation time T.
///   dp/dt = (x - p) / T;  implicit Euler, stable for every step: p <- p + (x - p) dt / (T + dt)
/// At a steady velocity v the gap is v T exactly, and the force k S T v: with k_i the link's stiffness, a damper of
/// b = k_i T N s/m. At rest the proxy converges to the probe and stays on it bit for bit.
/// Keys: `time` T, seconds, >= 0, or `coefficient` b, N s/m (T = b / k_i; 0 where k_i is 0); either may follow a field.
/// LinkStatus OK; residual 0; never slips. Haptic thread: no allocation, lock or throw.
ConstraintType viscosity_constraint();

}  // namespace catena::haptics
