/// The words that go with numbers: "unit": "m/s" of a field, "length_unit": "mm" of the scene. They change no number. Stated in the scene,
/// else what the data files say (engine/io/volume/units.h). Frame thread.
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Of a field's values, as the scene states it: a component beside FieldSource.
struct Unit {
  std::string symbol;
};
/// Of the world's lengths: a component that at most one entity has.
struct LengthUnit {
  std::string symbol;
};

/// Empty: nobody says.
std::string unit_of(const Scene& scene, Entity field);
std::string length_unit(const Scene& scene);
/// "m/s" as " m/s"; empty as empty.
std::string unit_suffix(const std::string& unit);

/// "unit" of a field's node.
Outcome read_unit(Scene& scene, Entity field, const json::Node& node);

}  // namespace catena::scene
