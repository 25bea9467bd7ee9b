// SPDX-License-Identifier: MIT
/// Documents generated from keys: the JSON Schema (draft 2020-12), with which an editor checks a scene while it is written, completes its
/// keys and shows their help; the Markdown tables of docs/reference/scene.md; and the output of a `keys` command.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/schema/key.h"

namespace catena::schema {

/// Returns the schema of one value, on one line.
std::string json_schema(const Key& key);
/// Returns the schema of an object that has these keys and no others. `more`: additional members of its "properties", placed before them,
/// as JSON text.
std::string object_schema(const Keys& keys, const std::string& help = {}, const std::string& more = {});
/// Returns the schema of one section of the scene.
std::string json_schema(const Section& component);
/// Returns the schema of the whole scene as a document of its own. A scene may name its schema in its key "$schema".
std::string json_schema(const std::vector<Section>& components, const std::string& title);

/// The tables of docs/reference/scene.md.

/// Returns a short name of the value type of a key: "number", "3 numbers", "value or map".
std::string describe_type(const Key& key);
/// Returns an example of a key's value as JSON text, of its type and within its limits. Names are placeholders.
std::string example_value(const Key& key);
/// Returns a table | key | type | unit | range | default | example | meaning | with one row per key. The keys of nested objects are not
/// included.
std::string markdown_table(const Keys& keys);

/// Returns all tables of a section with their names: "volumes", "fields/raw" (a variant), "slices.contours" (a nested object).
std::vector<std::pair<std::string, std::string>> markdown_tables(const Section& component);

/// Returns the output of the `keys` subcommand of `command`: help and tables of the section `name`, or of all sections when it is empty,
/// with `behind` appended to each table. Error: "COMMAND: "x" is not a part of DOCUMENT; one of ... was expected".
Result<std::string> format_keys(const std::vector<Section>& parts, const std::string& name, const std::string& command,
                                const std::string& document_name, const char* behind = "");

}  // namespace catena::schema
