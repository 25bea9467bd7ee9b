/// The words that go with numbers: "unit": "m/s" of a field, "unit_length": "mm" of the scene. They change no number. Stated in the scene,
/// else what the data files say (engine/field/units.h). Frame thread.
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Of a field's values, as the scene states it: a component beside FieldSource.
struct Unit {
  std::string word;
};
/// Of the world's lengths: a component that at most one entity has.
struct UnitOfLength {
  std::string word;
};

/// Empty: nobody says.
std::string unit_of(const Scene& scene, Entity field);
std::string unit_length(const Scene& scene);
/// "m/s" as " m/s"; empty as empty.
std::string after_number(const std::string& unit);

/// "unit" of a field's node.
Outcome read_unit(Scene& scene, Entity field, const json::Node& node);

}  // namespace catena::scene
