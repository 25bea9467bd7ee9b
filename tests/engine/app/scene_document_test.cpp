// SPDX-License-Identifier: MIT
// docs/reference/scene.md and docs/reference/study.md say what the readers read: every table of keys between "<!-- keys: NAME -->" and
// "<!-- end -->" is the one that the components' own descriptions make, and none is missing. CATENA_WRITE_DOCUMENTS=1 in the environment
// writes them anew (./run docs).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "engine/app/cli/scene_schema.h"
#include "engine/schema/documents.h"
#include "engine/study/study.h"
#include "tests/support/support.h"

namespace scene_document_test {

using namespace catena;

constexpr std::string_view kBegin = "<!-- keys: ", kBegun = " -->\n", kEnd = "<!-- end -->";

/// The text with its tables as they should be; the names of those it has.
std::string with_tables(const std::string& text, const std::map<std::string, std::string>& tables, std::set<std::string>& named) {
  std::string out;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = text.find(kBegin, at);
    if (begin == std::string::npos) return out + text.substr(at);
    const std::size_t name_at = begin + kBegin.size(), name_end = text.find(kBegun, name_at), end = text.find(kEnd, name_end);
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

void check_document(const std::string& document, const std::vector<schema::Section>& components) {
  std::map<std::string, std::string> tables;
  for (const schema::Section& component : components)
    for (auto& [name, table] : schema::markdown_tables(component)) tables.emplace(name, table);
  const std::string path = test::source_dir() + "/" + document, text = test::read_file(path);
  std::set<std::string> named, shown;
  const std::string right = with_tables(text, tables, named);
  for (const std::string& name : named) shown.insert(tables[name]);
  for (const auto& [name, table] : tables) EXPECT_TRUE(shown.contains(table)) << document << " has no table \"" << name << "\"";
  if (std::getenv("CATENA_WRITE_DOCUMENTS") != nullptr)
    test::write_file(path, right);
  else
    EXPECT_TRUE(text == right) << document << " is not current; ./run docs writes it";
}

TEST(SceneDocument, SaysWhatTheReadersRead) { check_document("docs/reference/scene.md", app::scene_file_components()); }

TEST(SceneDocument, SaysWhatAStudyMaySay) { check_document("docs/reference/study.md", study::study_components()); }

}  // namespace scene_document_test
