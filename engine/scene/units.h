// SPDX-License-Identifier: MIT
/// Unit names shown after numbers: "unit": "m/s" of a field, "unit_length": "mm" of the scene. They do not change any number. If the scene
/// does not state them, those of the data files are used (engine/io/volume/units.h). Frame thread.
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Component of an entity with a FieldSource: unit of the field's values, as stated in the scene.
struct Unit {
  std::string symbol;  ///< At most 24 bytes
};
/// Component of at most one entity: unit of lengths in the world, as stated in the scene.
struct LengthUnit {
  std::string symbol;  ///< At most 24 bytes
};

/// Return the unit of a field's values, or of lengths; empty: not specified.
std::string unit_of(const Scene& scene, Entity field);
std::string length_unit(const Scene& scene);
/// Returns a unit as a suffix: " m/s" for "m/s"; empty for an empty unit.
std::string unit_suffix(const std::string& unit);

/// Reads "unit" of a field's node.
Outcome read_unit(Scene& scene, Entity field, const json::Node& node);

}  // namespace catena::scene
