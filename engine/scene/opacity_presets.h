// SPDX-License-Identifier: MIT
/// Presets of colors and opacities for volumes of common kinds of data. Pure functions, any thread.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/components.h"

namespace catena::scene {

/// Colors and opacities for one kind of data.
struct OpacityPreset {
  std::string_view name;       ///< "ct-bone"
  std::string_view help;       ///< What it shows, a noun phrase
  bool is_relative = true;     ///< True: values 0 to 1 stand for the display range of the data; false: Hounsfield units
  bool is_projection = false;  ///< Maximum intensity projection instead of a shaded volume
  std::vector<TransferFunction::ColorPoint> colors;       ///< Values rising
  std::vector<TransferFunction::OpacityPoint> opacities;  ///< Values rising; alpha per smallest voxel edge
};

/// Returns all presets.
const std::vector<OpacityPreset>& opacity_presets();
/// Returns the preset of that name; nullptr: none.
const OpacityPreset* find_opacity_preset(std::string_view name);
/// Returns the names of all presets.
std::vector<std::string_view> opacity_preset_names();
/// Returns the preset for data whose display range is lo..hi.
OpacityPreset scaled_to(OpacityPreset preset, double lo, double hi);

}  // namespace catena::scene
