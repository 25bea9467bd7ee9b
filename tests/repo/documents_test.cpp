// SPDX-License-Identifier: MIT
/// Tests of the documents, all .md files of the tree: every relative link leads to a file and a heading; every file and every Suite.Case
/// that they name exists; prose is short; a guide has an image; README.md shows the scene of assets/scenes/first.json.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace documents_test {

namespace fs = std::filesystem;
namespace test = catena::test;

/// Every .md file of the tree, relative to its root.
std::vector<std::string> documents() {
  std::vector<std::string> found;
  for (auto it = fs::recursive_directory_iterator(test::source_dir()); it != fs::recursive_directory_iterator(); ++it) {
    const std::string name = it->path().filename().string();
    if (it->is_directory() && (name.starts_with(".") || (it.depth() == 0 && (name == "build" || name == "out")))) {
      it.disable_recursion_pending();
    } else if (name.ends_with(".md")) {
      found.push_back(fs::relative(it->path(), test::source_dir()).string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string contents(const std::string& document) { return test::read_file(test::source_dir() + "/" + document); }

bool in_tree(const std::string& path) { return fs::exists(test::source_dir() + "/" + path); }

/// Returns the first group of each match.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), expression); it != std::sregex_iterator(); ++it) found.push_back((*it)[1]);
  return found;
}

/// Returns the anchor of a heading: "the-scenes-device" for "The scene's `device`".
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(c));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

std::set<std::string> anchors_of(const std::string& document) {
  std::set<std::string> anchors;
  std::istringstream in(contents(document));
  for (std::string line; std::getline(in, line);)
    if (const auto text = line.find_first_not_of('#'); line.starts_with("#") && text != std::string::npos && line[text] == ' ')
      anchors.insert(anchor_of(line.substr(text + 1)));
  return anchors;
}

TEST(Documents, EveryLinkIsValid) {
  int checked = 0;
  for (const std::string& document : documents())
    for (const std::string& link : matches(contents(document), R"(\]\(([^)\s]+)\))")) {
      if (link.starts_with("http")) continue;
      const auto hash = link.find('#');
      const std::string file = link.substr(0, hash);
      const std::string to = file.empty() ? document : (fs::path(document).parent_path() / file).lexically_normal().string();
      ++checked;
      ASSERT_TRUE(in_tree(to)) << document << " links to " << link;
      if (hash == std::string::npos || !to.ends_with(".md")) continue;
      EXPECT_TRUE(anchors_of(to).contains(link.substr(hash + 1))) << document << " links to " << link;
    }
  EXPECT_GT(checked, 40);
}

TEST(Documents, EveryPageIsReachableFromTheReadme) {
  std::set<std::string> reached, open{"README.md"};
  while (!open.empty()) {
    const std::string page = *open.begin();
    open.erase(open.begin());
    if (!reached.insert(page).second) continue;
    for (const std::string& link : matches(contents(page), R"(\]\(([^)#\s]+\.md)[^)]*\))"))
      open.insert((fs::path(page).parent_path() / link).lexically_normal().string());
  }
  for (const std::string& document : documents()) EXPECT_TRUE(reached.contains(document) || !document.starts_with("docs/")) << document;
}

TEST(Documents, EveryNamedFileExists) {
  int checked = 0;
  for (const std::string& document : documents())
    for (const std::string& path : matches(contents(document), R"(`((?:engine|haptics|render|shaders|tests|assets)/[\w./-]+)`)")) {
      if (path.find("NAME") != std::string::npos) continue;
      ++checked;
      EXPECT_TRUE(in_tree(path)) << document << " names " << path;
    }
  EXPECT_GT(checked, 40);
}

TEST(Documents, EveryNamedTestExists) {
  std::string cases;  // " Suite.Case" for every test
  for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() + "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = test::read_file(entry.path().string());
    for (auto at = text.find("\nTEST"); at != std::string::npos; at = text.find("\nTEST", at + 1)) {
      const auto begin = text.find('(', at), comma = text.find(',', begin), end = text.find(')', begin);
      if (end == std::string::npos || comma > end) continue;
      cases += ' ' + text.substr(begin + 1, comma - begin - 1) + '.' + text.substr(comma + 2, end - comma - 2);
    }
  }
  int checked = 0;
  for (const std::string& document : documents())
    for (std::string name : matches(contents(document), R"(`([A-Z]\w+\.[A-Z]\w*\*?|[A-Z]\w+\.\*)`)")) {
      if (name == "Suite.Case" || name == "NumberN.*") continue;  // placeholders
      ++checked;
      const bool all = name.ends_with("*");
      if (all) name.pop_back();
      EXPECT_NE((cases + ' ').find(' ' + name + (all ? "" : " ")), std::string::npos) << document << " names " << name;
    }
  EXPECT_GT(checked, 20);
}

/// A paragraph of prose or a list item, and its first line.
struct Paragraph {
  int line = 0;
  std::string text;
};

/// Returns the prose of a document: its paragraphs without tables, headings, code blocks and HTML comments, links as their text.
std::vector<Paragraph> prose(const std::string& document) {
  static const std::regex item(R"(^\s*(?:[-*+]|\d+[.)])\s+)"), quote(R"(^\s*>\s*)"), link(R"(!?\[([^\]]*)\]\([^)]*\))");
  std::vector<Paragraph> found;
  std::istringstream in(contents(document));
  bool is_code = false, is_comment = false, continues = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(' ');
    const std::string text = begin == std::string::npos ? "" : line.substr(begin);
    const bool is_fence = !is_comment && text.starts_with("```");
    if (is_fence) is_code = !is_code;
    if (!is_code && text.starts_with("<!--")) is_comment = true;
    const bool is_prose = !is_code && !is_fence && !is_comment && !text.empty() && text.find_first_of("#|") != 0;
    if (is_comment && text.find("-->") != std::string::npos) is_comment = false;
    const bool begins_item = std::regex_search(line, item);
    if (!is_prose || (!continues && begin >= 4 && !begins_item)) {  // or indented code blocks
      continues = false;
      continue;
    }
    if (!continues || begins_item) found.push_back({number, {}});
    continues = true;
    found.back().text += std::regex_replace(line, begins_item ? item : quote, "") + " ";
  }
  for (Paragraph& paragraph : found) paragraph.text = std::regex_replace(paragraph.text, link, "$1");
  return found;
}

int word_count(const std::string& text) {
  std::istringstream in(text);
  int count = 0;
  for (std::string word; in >> word;) ++count;
  return count;
}

TEST(Documents, ProseIsShort) {
  constexpr int kMaxParagraph = 80, kMaxSentence = 30;  // words
  static const std::regex end(R"([.!?]["”)\]*_`]*\s+)");
  int checked = 0;
  for (const std::string& document : documents())
    for (const Paragraph& paragraph : prose(document)) {
      ++checked;
      const std::string at = document + ":" + std::to_string(paragraph.line) + ": " + paragraph.text.substr(0, 60);
      EXPECT_LE(word_count(paragraph.text), kMaxParagraph) << at;
      for (auto it = std::sregex_token_iterator(paragraph.text.begin(), paragraph.text.end(), end, -1); it != std::sregex_token_iterator();
           ++it)
        EXPECT_LE(word_count(it->str()), kMaxSentence) << at << "\n" << it->str();
    }
  EXPECT_GT(checked, 500);
}

TEST(Documents, AGuideIsShortAndHasAnImage) {
  int checked = 0;
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/docs/user")) {
    if (entry.path().extension() != ".md") continue;
    const std::string text = test::read_file(entry.path().string());
    ++checked;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150) << entry.path();
    EXPECT_NE(text.find("!["), std::string::npos) << entry.path();
  }
  EXPECT_GT(checked, 10);
}

TEST(Documents, BenchmarksMatchTheirTables) {
  const test::ProgramResult made = test::run_program("/usr/bin/python3", {test::source_dir() + "/docs/benchmarks/make.py", "--check"});
  EXPECT_EQ(made.exit_code, 0) << made.out << made.err;
}

TEST(Documents, TheReadmeIsShortAndShowsTheFirstScene) {
  const std::string readme = contents("README.md");
  EXPECT_LE(std::count(readme.begin(), readme.end(), '\n'), 85);
  EXPECT_NE(readme.find("```json\n" + contents("assets/scenes/first.json") + "```"), std::string::npos);
}

}  // namespace documents_test
