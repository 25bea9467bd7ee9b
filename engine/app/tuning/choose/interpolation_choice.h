// SPDX-License-Identifier: MIT
/// Choice between linear and cubic interpolation in a tuning: which fields leave it open, and how a field becomes cubic. Not for the haptic
/// thread.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace catena::app::tuning {

inline constexpr const char* kInterpolationKey = "interpolation";

/// Returns whether the field is a grid from a single file, read linearly, whose interpolation the scene does not state.
bool is_interpolation_unset(const scene::FieldSource& source);

/// Switches the field to cubic interpolation, including the data loaded so far; its grids for rendering are discarded and rebuilt. An Error
/// if there is no memory for the ghost cells of a cubic grid; the field is then unchanged.
Outcome set_cubic_interpolation(scene::FieldSource& source);

/// Returns the JSON pointer of a field in the scene's text, "/fields/NAME".
std::string field_pointer(const std::string& name);

}  // namespace catena::app::tuning
