// SPDX-License-Identifier: MIT
/// The tutorials: the blocks of the pages are run with the installed program, and their output must be the page's. In a page
///   "Save as `NAME`:" and a block   is a file
///   ```sh                           is run by bash, in the page's own folder; it must succeed
///   ```text after it                is the output, including errors; ... stands for any text in a line, or alone for any lines
/// Other blocks are not run. Every image that a block writes must not be empty.
#include <gtest/gtest.h>
#include <unistd.h>

#include <regex>
#include <set>
#include <sstream>

#include "engine/base/clock.h"
#include "render/image/image.h"
#include "tests/package/installed.h"
#include "tests/support/drive_window.h"

namespace tutorials_test {

namespace fs = std::filesystem;
namespace test = catena::test;

struct Block {
  std::string language, text, file;
  int line = 0;
};

struct Page {
  std::vector<Block> blocks;
  std::string prose, blocks_text;
};

Page read_page(const std::string& path) {
  Page page;
  std::istringstream in(test::read_file(test::source_dir() + "/" + path));
  const std::regex save("Save as `([\\w.-]+)`:\\s*$");
  std::string line, last;
  bool inside = false;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) {
        Block block;
        block.language = line.substr(3);
        block.line = number;
        std::smatch match;
        if (std::regex_search(last, match, save)) block.file = match[1];
        page.blocks.push_back(block);
      }
    } else if (inside) {
      page.blocks.back().text += line + "\n";
      page.blocks_text += line + "\n";
    } else if (!line.empty()) {
      page.prose += line + "\n";
    }
    if (!line.empty()) last = line;
  }
  EXPECT_FALSE(inside) << path << ": a block does not end";
  return page;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  const std::regex progress("[\\w ]+: +\\d+ %");  // printed only for work of more than a second
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!std::regex_match(line, progress)) lines.push_back(line);
  return lines;
}

bool same_line(const std::string& stated, const std::string& printed) {
  std::string pattern = std::regex_replace(stated, std::regex(R"([\^$\\*+?()\[\]{}|])"), R"(\$&)");
  pattern = std::regex_replace(pattern, std::regex(R"(\.\.\.)"), "\x01");
  pattern = std::regex_replace(pattern, std::regex(R"(\.)"), R"(\.)");
  pattern = std::regex_replace(pattern, std::regex("\x01"), ".*");
  return std::regex_match(printed, std::regex(pattern));
}

bool same(const std::vector<std::string>& stated, std::size_t i, const std::vector<std::string>& printed, std::size_t j) {
  if (i == stated.size()) return j == printed.size();
  if (stated[i] == "...") {
    for (std::size_t k = j; k <= printed.size(); ++k)
      if (same(stated, i + 1, printed, k)) return true;
    return false;
  }
  return j < printed.size() && same_line(stated[i], printed[j]) && same(stated, i + 1, printed, j + 1);
}

void pictures_hold_something(const std::string& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".png") continue;
    const auto picture = catena::render::read_png(entry.path().string());
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_GT(fs::file_size(entry.path()), 1500u) << entry.path() << " is all of one colour";
  }
}

/// Checks that each number with a unit in the prose occurs in a block, possibly with more digits.
void numbers_are_said(const Page& page, const std::string& path) {
  const std::regex number(R"((\d+(?:\.\d+)?) (?:N/m|N|mm|m|s|units?|voxels?|Hz)\b)");
  for (auto it = std::sregex_iterator(page.prose.begin(), page.prose.end(), number); it != std::sregex_iterator(); ++it) {
    const std::string digits = std::regex_replace((*it)[1].str(), std::regex(R"(\.)"), R"(\.)");
    EXPECT_TRUE(std::regex_search(page.blocks_text, std::regex("(^|[^0-9.])" + digits))) << path << " says \"" << it->str() << "\"";
  }
}

/// Prefix that runs a command on a display and as a user other than root, who owns the folder but not the compiler's cache.
std::vector<std::string> user_at_a_display(const std::string& folder) {
  std::vector<std::string> words{"sh", test::source_dir() + "/tests/support/on_display.sh", "1000x700x24", "env", "HOME=" + folder};
  if (::geteuid() != 0) return words;
  fs::permissions(fs::path(folder).parent_path(), fs::perms(0755));
  EXPECT_EQ(::chown(folder.c_str(), 65534, 65534), 0);
  words.insert(words.end(), {"LAUNCHER=", "setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
  return words;
}

/// Runs the blocks of docs/user/IN/NAME.md.
void follow(const std::string& name, const std::string& in = "tutorials/", bool has_window = false) {
  const std::string path = "docs/user/" + in + name + ".md";
  const Page page = read_page(path);
  test::TemporaryFolder folder;
  const std::string work = folder / name;
  fs::create_directories(work);
  const std::vector<std::string> before = has_window ? user_at_a_display(work) : std::vector<std::string>();
  int ran = 0;
  test::install_prefix();
  const std::int64_t begin = catena::now_ns();
  const auto seconds = [&] { return 1e-3 * catena::ms_since(begin); };
  double first = 0;
  for (std::size_t i = 0; i < page.blocks.size(); ++i) {
    const Block& block = page.blocks[i];
    if (!block.file.empty()) test::write_file(work + "/" + block.file, block.text);
    const bool is_printed = block.language != "text" || (i > 0 && page.blocks[i - 1].language == "sh");
    EXPECT_TRUE(is_printed) << path << ":" << block.line << ": nothing prints this";
    if (block.language != "sh") continue;
    const test::ProgramResult result = test::run_shell(work, block.text, before);
    ASSERT_EQ(result.exit_code, 0) << path << ":" << block.line << "\n" << result.out;
    if (i + 1 < page.blocks.size() && page.blocks[i + 1].language == "text") {
      const std::string& stated = page.blocks[i + 1].text;
      EXPECT_TRUE(same(lines_of(stated), 0, lines_of(result.out), 0)) << path << ":" << block.line << " says\n"
                                                                      << stated << "and got\n"
                                                                      << result.out;
      if (!(first > 0)) first = seconds();
    }
    ++ran;
  }
  EXPECT_GE(ran, 2) << path;
  pictures_hold_something(work);
  numbers_are_said(page, path);
  std::printf("%s: the first result after %.1f s, all of it in %.1f s\n", name.c_str(), first, seconds());
}

TEST(Tutorials, FirstPicture) { follow("first-picture"); }
TEST(Tutorials, FirstForce) { follow("first-force"); }
TEST(Tutorials, OwnData) { follow("own-data"); }
TEST(Tutorials, OwnConstraint) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  follow("own-constraint", "tutorials/", true);
}
TEST(Tutorials, OwnExperiment) { follow("own-experiment"); }
TEST(Tutorials, VorticesInAJet) { follow("vortices-in-a-jet"); }
TEST(Tutorials, FromPython) {
  if (std::string(CATENA_PYTHON_FOLDER).empty()) GTEST_SKIP() << "the Python module was not built";
  follow("from-python");
}

TEST(Tutorials, FromOtherPrograms) {
  for (const char* name : {"from-chai3d", "from-h3d", "from-paraview"}) follow(name, "");
  if (!std::string(CATENA_PYTHON_FOLDER).empty()) follow("from-vtk", "");
}

TEST(Tutorials, EveryPageHasATest) {
  std::set<std::string> pages;
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/docs/user/tutorials")) pages.insert(entry.path().stem());
  EXPECT_EQ(pages, (std::set<std::string>{"first-force", "first-picture", "from-python", "own-constraint", "own-data", "own-experiment",
                                          "vortices-in-a-jet"}));
}

TEST(Tutorials, DetectsDifferentOutput) {
  EXPECT_TRUE(same({"a 1.5 (x) ...", "...", "end"}, 0, {"a 1.5 (x) b", "c", "d", "end"}, 0));
  EXPECT_FALSE(same({"a 1.5"}, 0, {"a 1x5"}, 0));
  EXPECT_FALSE(same({"a"}, 0, {"a", "b"}, 0));
  EXPECT_FALSE(same({"...", "b"}, 0, {"a"}, 0));
}

}  // namespace tutorials_test
