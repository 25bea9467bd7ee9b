// SPDX-License-Identifier: MIT
// The reference documents are current. Every table of keys between "<!-- keys: NAME -->" and "<!-- end -->" in docs/reference/scene.md
// and docs/reference/study.md equals the table generated from the components' descriptions, and no table is missing. The same holds for
// the tables of options between "<!-- options: COMMAND -->" and "<!-- end -->" in docs/reference/command-line.md.
// CATENA_WRITE_DOCUMENTS=1 in the environment writes the tables (./run docs).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "engine/app/cli/command_reference.h"
#include "engine/app/cli/scene_schema.h"
#include "engine/base/json.h"
#include "engine/schema/documents.h"
#include "engine/study/study.h"
#include "tests/support/support.h"

namespace scene_document_test {

using namespace catena;

constexpr std::string_view kKeys = "<!-- keys: ", kOptions = "<!-- options: ", kBegun = " -->\n", kEnd = "<!-- end -->";

/// The text with current tables; `named` gets the names of its tables. `marker` is the beginning of the line before a table.
std::string with_tables(const std::string& text, std::string_view marker, const std::map<std::string, std::string>& tables,
                        std::set<std::string>& named) {
  std::string out;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = text.find(marker, at);
    if (begin == std::string::npos) return out + text.substr(at);
    const std::size_t name_at = begin + marker.size(), name_end = text.find(kBegun, name_at), end = text.find(kEnd, name_end);
    EXPECT_NE(end, std::string::npos);
    if (end == std::string::npos) return text;
    const std::string name = text.substr(name_at, name_end - name_at);
    const auto table = tables.find(name);
    EXPECT_NE(table, tables.end()) << "the document has a table \"" << name << "\", which nothing has";
    named.insert(name);
    out += text.substr(at, name_end + kBegun.size() - at) + "\n" + (table == tables.end() ? "" : table->second) + "\n";
    at = end;
  }
}

void check_document(const std::string& document, std::string_view marker, const std::map<std::string, std::string>& tables) {
  const std::string path = test::source_dir() + "/" + document, text = test::read_file(path);
  std::set<std::string> named, shown;
  const std::string right = with_tables(text, marker, tables, named);
  for (const std::string& name : named)
    if (tables.contains(name)) shown.insert(tables.at(name));
  for (const auto& [name, table] : tables) EXPECT_TRUE(shown.contains(table)) << document << " has no table \"" << name << "\"";
  if (std::getenv("CATENA_WRITE_DOCUMENTS") != nullptr)
    test::write_file(path, right);
  else
    EXPECT_TRUE(text == right) << document << " is not current; ./run docs writes it";
}

std::map<std::string, std::string> key_tables(const std::vector<schema::Section>& components) {
  std::map<std::string, std::string> tables;
  for (const schema::Section& component : components)
    for (auto& [name, table] : schema::markdown_tables(component)) tables.emplace(name, table);
  return tables;
}

TEST(SceneDocument, SceneKeysAreCurrent) { check_document("docs/reference/scene.md", kKeys, key_tables(app::scene_file_components())); }

/// Whether a JSON value has the type of the key, with numbers within its limits.
bool has_type(const json::Node& value, const schema::Key& key) {
  switch (key.value_type) {
    case schema::ValueType::number:
    case schema::ValueType::integer:
      return value.kind == json::Kind::number && key.limits.contains(value.number);
    case schema::ValueType::boolean:
      return value.kind == json::Kind::boolean;
    case schema::ValueType::text:
      return value.kind == json::Kind::string;
    case schema::ValueType::choice:
      return value.kind == json::Kind::string && std::ranges::find(key.options, value.string) != key.options.end();
    case schema::ValueType::vector:
      return value.items.size() == static_cast<std::size_t>(key.count) &&
             std::ranges::all_of(value.items, [&](const json::Node& item) { return key.limits.contains(item.number); });
    case schema::ValueType::object:
      return std::ranges::all_of(value.members, [&](const auto& member) {
        const schema::Key* known = schema::find(*key.members, member.first);
        return known != nullptr && has_type(member.second, *known);
      });
    default:
      return true;
  }
}

TEST(SceneDocument, EveryExampleHasTheTypeOfItsKey) {
  int checked = 0;
  const auto check = [&](const auto& self, const schema::Keys& keys, const std::string& where) -> void {
    for (const schema::Key& key : keys) {
      const std::string text = schema::example_value(key);
      const auto value = json::parse(text, where + "." + key.name);
      ASSERT_TRUE(value) << value.error().message << "\n" << text;
      EXPECT_TRUE(has_type(*value, key)) << where << "." << key.name << ": " << text;
      ++checked;
      if (key.value_type == schema::ValueType::object) self(self, *key.members, where + "." + key.name);
    }
  };
  for (const schema::Section& section : app::scene_file_components()) {
    check(check, section.keys, section.name);
    for (const schema::Variant& variant : section.variants) check(check, variant.keys, section.name + "/" + variant.name);
  }
  EXPECT_GT(checked, 300);
}

TEST(SceneDocument, StudyKeysAreCurrent) { check_document("docs/reference/study.md", kKeys, key_tables(study::study_components())); }

TEST(SceneDocument, FormatsAreCurrent) { check_document("docs/reference/formats.md", "<!-- formats: ", {{"all", app::format_table()}}); }

TEST(SceneDocument, CommandLineOptionsAreCurrent) {
  std::map<std::string, std::string> tables;
  for (const auto& [name, table] : app::option_tables()) {
    // Every option has a value type that the table of types has.
    EXPECT_EQ(table.find("| ? |"), std::string::npos) << name << table;
    tables.emplace(name, table);
  }
  EXPECT_GE(tables.size(), 22u);
  check_document("docs/reference/command-line.md", kOptions, tables);
}

}  // namespace scene_document_test
