/// The JSON Schema (draft 2020-12) of what keys describe: an editor that is given it checks a scene while it is written, completes its
/// keys, and shows their sentences.
#pragma once
#include <string>

#include "engine/schema/key.h"

namespace catena::schema {

/// Of one value, on one line.
std::string json_schema(const Key& key);
/// Of an object with these keys and no others. `more`: members of its "properties" before them, JSON text.
std::string object_schema(const Keys& keys, const std::string& help = {}, const std::string& more = {});
/// Of a part of the scene.
std::string json_schema(const Component& component);
/// Of the whole scene: a document of its own. A scene may name its schema itself, as "$schema".
std::string json_schema(const std::vector<Component>& components, const std::string& title);

}  // namespace catena::schema
