/// The tables of docs/scene.md.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/schema/key.h"

namespace catena::schema {

/// What a key takes, in a word or two: "number", "3 numbers", "value or map".
std::string type_words(const Key& key);
/// | key | type | unit | range | default | meaning |, a row a key; of keys with an object, the object's keys are not in it.
std::string markdown_table(const Keys& keys);

/// All tables of a component with their names: "volumes", "fields/raw" (a variant), "slices.contours" (an object in it).
std::vector<std::pair<std::string, std::string>> markdown_tables(const Component& component);

}  // namespace catena::schema
