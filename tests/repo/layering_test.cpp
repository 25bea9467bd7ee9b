// SPDX-License-Identifier: MIT
/// Every #include of the tree against the edges declared in CMakeLists.txt (written to modules.txt at configure time).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/support.h"

namespace layering_test {

namespace fs = std::filesystem;
namespace test = catena::test;
using Edges = std::map<std::string, std::set<std::string>>;

Edges declared_edges() {
  Edges edges;
  std::ifstream in(test::binary_dir() + "/modules.txt");
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    std::istringstream words(line.substr(colon + 1));
    std::set<std::string>& to = edges[line.substr(0, colon)];
    for (std::string word; words >> word;) to.insert(word);
  }
  return edges;
}

// edges are transitive: scene -> flow -> field -> base
std::set<std::string> reachable(const Edges& edges, const std::string& module) {
  std::set<std::string> seen{module}, todo{module};
  while (!todo.empty()) {
    const std::string next = *todo.begin();
    todo.erase(todo.begin());
    const auto it = edges.find(next);
    if (it == edges.end()) continue;
    for (const std::string& to : it->second)
      if (seen.insert(to).second) todo.insert(to);
  }
  return seen;
}

// "engine/app/viewer/x.h" belongs to module engine/app: the longest declared folder that contains it
std::string module_of(const Edges& edges, const std::string& path) {
  std::string best;
  for (const auto& [module, to] : edges)
    if (path.starts_with(module + "/") && module.size() > best.size()) best = module;
  if (best.empty() && path.starts_with("shaders/shared/")) return "shaders/shared";
  return best;
}

struct Include {
  std::string from, to;  ///< paths from the repository root
};

// path of an #include line, or empty
std::string included_path(const std::string& line) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const auto word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return {};
  const auto open = line.find_first_of("\"<", word), close = line.find_first_of("\">", open + 1);
  return open == std::string::npos || close == std::string::npos ? std::string() : line.substr(open + 1, close - open - 1);
}

std::vector<Include> all_includes() {
  std::vector<Include> found;
  for (const char* top : {"engine", "haptics", "render"})
    for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() + "/" + top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);)
        if (const std::string path = included_path(line); !path.empty())
          found.push_back({fs::relative(entry.path(), test::source_dir()).string(), path});
    }
  return found;
}

bool begins_with_any(const std::string& path, const std::vector<std::string>& folders) {
  return std::ranges::any_of(folders, [&](const std::string& folder) { return path.starts_with(folder); });
}
bool ours(const std::string& path) { return begins_with_any(path, {"engine/", "haptics/", "render/", "shaders/", "tests/"}); }

TEST(Layering, EveryIncludeFollowsADeclaredEdge) {
  const Edges edges = declared_edges();
  ASSERT_GT(edges.size(), 10u);
  int checked = 0;
  for (const Include& include : all_includes()) {
    const std::string from = module_of(edges, include.from);
    ASSERT_FALSE(from.empty()) << include.from << " is in no declared module";
    if (!ours(include.to) || edges.at(from).contains("ALL")) continue;
    const std::string to = module_of(edges, include.to);
    EXPECT_TRUE(!to.empty() && reachable(edges, from).contains(to))
        << include.from << " includes " << include.to << ": no edge " << from << " -> " << to;
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(Layering, ProjectHeadersAreIncludedFromTheRepositoryRoot) {
  for (const Include& include : all_includes()) {
    const bool sibling = include.to.find('/') == std::string::npos &&
                         fs::exists(fs::path(test::source_dir()) / fs::path(include.from).parent_path() / include.to);
    EXPECT_FALSE(sibling) << include.from << " includes " << include.to << ": write the path from the repository root";
    EXPECT_FALSE(include.to.starts_with("..")) << include.from;
  }
}

TEST(Layering, OnlyTheProgramAndTheTopModulesUseBothHapticsAndRender) {
  const Edges edges = declared_edges();
  std::set<std::string> above;
  for (const auto& [module, to] : edges) {
    if (to.contains("ALL")) continue;
    bool haptics = false, render = false;
    for (const std::string& r : reachable(edges, module)) {
      haptics = haptics || r.starts_with("haptics/");
      render = render || r.starts_with("render/");
    }
    if (haptics && render) above.insert(module);
  }
  EXPECT_TRUE(above.empty()) << *above.begin() << " sees both haptics and render";
  EXPECT_FALSE(reachable(edges, "haptics/build").contains("render/frame"));
  EXPECT_FALSE(reachable(edges, "render/extract").contains("haptics/chain"));
  // the two modules that build from the scene
  EXPECT_TRUE(edges.at("haptics/build").contains("engine/scene"));
  EXPECT_TRUE(edges.at("render/extract").contains("engine/scene"));
}

TEST(Layering, HeavyLibrariesStayInTheirModules) {
  const std::pair<std::vector<std::string>, std::vector<std::string>> places[] = {
      // libraries, folders that may include them
      {{"openvdb/"}, {"engine/io/vdb/"}},
      {{"vtk", "itk", "gdcm", "zip.h", "gifti_io.h"}, {"engine/io/vtk/"}},
      {{"nanovdb/"}, {"engine/field/", "engine/io/"}},
      {{"nifti1_io.h"}, {"engine/io/volume/"}},
      {{"json/"}, {"engine/base/json"}},
      {{"tbb/"}, {"engine/base/threads"}},
      {{"vulkan/"}, {"render/", "engine/app/viewer/"}},
      {{"GLFW/"}, {"engine/app/viewer/"}},
      {{"seccomp.h"}, {"engine/io/sandbox/"}},
      {{"png.h", "turbojpeg.h"}, {"render/image/"}},
      {{"ft2build.h", "fontconfig/"}, {"render/text/"}},
      {{"CLI/"}, {"engine/app/"}},
      {{"openxr/"}, {"render/xr/"}},
      {{"boost/"}, {"engine/study/statistics/distributions.cpp", "engine/app/server/http/"}}};
  std::map<std::string, std::set<std::string>> users;  // files by library
  for (const Include& include : all_includes())
    for (const auto& [libraries, folders] : places)
      for (const std::string& library : libraries)
        if (include.to.starts_with(library)) {
          users[library].insert(include.from);
          EXPECT_TRUE(begins_with_any(include.from, folders)) << include.from << " includes " << library;
        }
  EXPECT_LE(users["openvdb/"].size(), 5u) << "openvdb headers cost 10 s of build each";
  for (const char* library : {"openvdb/", "vulkan/", "json/"}) EXPECT_FALSE(users[library].empty()) << library;
}

}  // namespace layering_test
