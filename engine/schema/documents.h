/// The JSON Schema (draft 2020-12) of what keys describe: an editor that is given it checks a scene while it is written, completes its
/// keys, and shows their sentences.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/schema/key.h"

namespace catena::schema {

/// Of one value, on one line.
std::string json_schema(const Key& key);
/// Of an object with these keys and no others. `more`: members of its "properties" before them, JSON text.
std::string object_schema(const Keys& keys, const std::string& help = {}, const std::string& more = {});
/// Of a part of the scene.
std::string json_schema(const Section& component);
/// Of the whole scene: a document of its own. A scene may name its schema itself, as "$schema".
std::string json_schema(const std::vector<Section>& components, const std::string& title);

/// The tables of docs/scene.md.

/// What a key takes, in a word or two: "number", "3 numbers", "value or map".
std::string describe_type(const Key& key);
/// | key | type | unit | range | default | meaning |, a row a key; of keys with an object, the object's keys are not in it.
std::string markdown_table(const Keys& keys);

/// All tables of a component with their names: "volumes", "fields/raw" (a variant), "slices.contours" (an object in it).
std::vector<std::pair<std::string, std::string>> markdown_tables(const Section& component);

/// What `keys` of a command prints: sentence and tables of the part of that name, of all parts where it is empty, with `behind` a table. An
/// Error: "COMMAND: "x" is no part of WHOLE; one of ... was expected".
Result<std::string> format_keys(const std::vector<Section>& parts, const std::string& name, const std::string& command,
                                const std::string& whole, const char* behind = "");

}  // namespace catena::schema
