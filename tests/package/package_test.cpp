// SPDX-License-Identifier: MIT
/// The installed package: programs that are built against the installation below the build folder, independent of the source tree.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/package/installed.h"

namespace package_test {

namespace fs = std::filesystem;
namespace test = catena::test;

const std::string& prefix() { return test::install_prefix(); }
std::string library() { return prefix() + "/" + CATENA_LIBDIR + "/libcatena.so"; }

/// Output of a program, which must succeed.
std::string output_of(const std::vector<std::string>& words) {
  const test::ProgramResult result = test::run_program(words[0], {words.begin() + 1, words.end()});
  EXPECT_EQ(result.exit_code, 0) << testing::PrintToString(words) << result.err;
  return result.out;
}

/// Builds a project against the installation. The folder is kept, so that unchanged parts are not rebuilt.
bool build_outside(const std::string& source, const std::string& name) {
  const std::string folder = test::binary_dir() + "/outside/" + name;
  std::vector<std::string> configure{
      "--fresh", "-S", source, "-B", folder, "-G", "Ninja", "-DCMAKE_PREFIX_PATH=" + prefix(), "-DCMAKE_BUILD_TYPE=None"};
  if (std::string(CATENA_LAUNCHER).size() > 0) configure.push_back(std::string("-DCMAKE_CXX_COMPILER_LAUNCHER=") + CATENA_LAUNCHER);
  return test::run_cmake(configure) && test::run_cmake({"--build", folder, "--parallel", "2"});
}

std::vector<std::string> public_headers() {
  std::vector<std::string> headers;
  std::ifstream in(test::source_dir() + "/engine/cmake/public_headers.txt");
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#') headers.push_back(line);
  headers.emplace_back("engine/base/export.h");  // generated
  return headers;
}

/// Text of a public header; export.h is generated.
std::string header_text(const std::string& header) {
  const std::string generated = test::binary_dir() + "/generated/" + header;
  return test::read_file(test::exists(generated) ? generated : test::source_dir() + "/" + header);
}

void write_if_changed(const std::string& path, const std::string& text) {
  if (!test::exists(path) || test::read_file(path) != text) test::write_file(path, text);
}

struct Package : testing::Test {
  static void SetUpTestSuite() { prefix(); }
  test::TemporaryFolder folder;

  /// Path of an example built by build_outside.
  static test::ProgramResult example(const std::string& name, const std::vector<std::string>& arguments = {}) {
    return test::run_program(test::binary_dir() + "/outside/examples/" + name, arguments);
  }
};

TEST_F(Package, PublicHeadersIncludeOnlyPublicOnesAndFewLibraries) {
  const std::vector<std::string> headers = public_headers();
  const std::set<std::string> all(headers.begin(), headers.end());
  EXPECT_EQ(all.size(), headers.size()) << "a header is listed twice";
  const std::regex include(R"(\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  for (const std::string& header : headers) {
    std::istringstream in(header_text(header));
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (!std::regex_match(line, match, include)) continue;
      const std::string path = match[2];
      if (match[1] == "\"") {
        EXPECT_TRUE(all.contains(path)) << header << " includes " << path << ", which is not public";
      } else if (path.find('/') != std::string::npos || path.ends_with(".h")) {
        EXPECT_TRUE(path.starts_with("glm/") || path.starts_with("fmt/") || path == "vulkan/vulkan.h")
            << header << " includes " << path << ": GLM, fmt and Vulkan were expected";
      }
    }
  }
}

TEST_F(Package, OnlyPublicHeadersAreInstalledAndEachIsSelfContained) {
  const std::vector<std::string> headers = public_headers();
  std::set<std::string> installed;
  const std::string at = prefix() + "/include/catena";
  for (const auto& entry : fs::recursive_directory_iterator(at))
    if (entry.is_regular_file()) installed.insert(fs::relative(entry.path(), at).string());
  EXPECT_EQ(installed, std::set<std::string>(headers.begin(), headers.end()));

  const std::string project = test::binary_dir() + "/outside/headers-alone";
  fs::create_directories(project);
  std::string text = "cmake_minimum_required(VERSION 3.25)\nproject(alone CXX)\nfind_package(catena REQUIRED)\nadd_library(alone OBJECT";
  for (const std::string& header : headers) {
    const std::string file = std::regex_replace(header, std::regex("[/.]"), "_") + ".cpp";
    write_if_changed(project + "/" + file, "#include \"" + header + "\"\n");
    text += "\n  " + file;
  }
  text +=
      ")\ntarget_link_libraries(alone catena::haptics catena::render)\ntarget_compile_options(alone PRIVATE -O0 -Wall -Wextra -Werror)\n";
  write_if_changed(project + "/CMakeLists.txt", text);
  build_outside(project, "headers");
}

TEST_F(Package, TheLibraryExportsOnlyDeclarationsOfPublicHeaders) {
  std::string text;
  for (const std::string& header : public_headers()) text += header_text(header);
  std::set<std::string> words;
  const std::regex word("[A-Za-z_][A-Za-z0-9_]*");
  for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it) words.insert(it->str());
  std::istringstream in(output_of({"/usr/bin/nm", "-DC", "--defined-only", library()}));
  const std::regex symbol(
      R"(\S+ (\S) (?:(?:vtable|typeinfo|typeinfo name|non-virtual thunk) (?:for|to) )?catena::((?:[a-z_]+::)*)(\w+).*)");
  int seen = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find(" A CATENA_") != std::string::npos) continue;  // the version symbol
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, symbol)) << line;
    EXPECT_TRUE(words.contains(match[3])) << line << ": no public header has this name";
    EXPECT_NE(match[2], "app::") << line;
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

TEST_F(Package, TheProgramExportsTheLibrarysSymbolsToPlugins) {
  const auto names = [](const std::string& file) {
    std::set<std::string> found;
    std::istringstream in(output_of({"/usr/bin/nm", "-D", "--defined-only", "--without-symbol-versions", file}));
    for (std::string address, kind, name; in >> address >> kind >> name;)
      if (name.starts_with("_Z")) found.insert(name);
    return found;
  };
  const std::set<std::string> of_program = names(prefix() + "/bin/catena"), of_library = names(library());
  EXPECT_GT(of_library.size(), 500u);
  for (const std::string& name : of_library) EXPECT_TRUE(of_program.contains(name)) << name;
}

TEST_F(Package, TheLibraryHasItsSoname) {
  const std::string elf = output_of({"/usr/bin/readelf", "-d", library()});
  EXPECT_NE(elf.find("[libcatena.so." CATENA_SOVERSION "]"), std::string::npos) << elf;
  for (const char* heavy : {"openvdb", "libvtk", "libITK", "glfw", "imgui"}) EXPECT_EQ(elf.find(heavy), std::string::npos) << heavy;
}

TEST_F(Package, ExamplesBuildAndRunOutsideOfTheTree) {
  ASSERT_TRUE(build_outside(prefix() + "/" + CATENA_DOCDIR + "/docs/examples", "examples"));
  // 500 N/m times 0.05 m per unit times 0.3 units; the proxy is on the ball of radius 0.5
  EXPECT_EQ(example("constraint").out, "probe at 0.200, proxy at 0.500, force 7.500 N\n");
  const test::ProgramResult loop = example("own_loop");
  EXPECT_EQ(loop.exit_code, 0) << loop.err;
  for (const char* link : {"line: OK", "skin: OK"}) EXPECT_NE(loop.out.find(link), std::string::npos) << loop.out;
  int count = 0, voxels = 0;
  double area = 0, volume = 0;
  const std::string measured = example("measure").out;
  ASSERT_EQ(std::sscanf(measured.c_str(), "%d part of %d voxels, area %lf, volume %lf", &count, &voxels, &area, &volume), 4) << measured;
  EXPECT_EQ(count, 1);
  EXPECT_NEAR(area, 1257, 8);  // 4 pi 10^2
  EXPECT_NEAR(volume, 4189, 40);
  EXPECT_NEAR(voxels, 4189, 40);
  EXPECT_EQ(example("function").out.substr(0, 9), "OK: proxy");
  // at rest the hand's spring force, 100 N/m (-0.01 - z), equals the floor's
  const test::ProgramResult device = example("device");
  double z = 0, force = 0;
  ASSERT_EQ(std::sscanf(device.out.c_str(), "after 3000 ticks the hand is at %lf m, the floor pushes with %lf N", &z, &force), 2)
      << device.out << device.err;
  EXPECT_LT(z, 0);
  EXPECT_NEAR(force, 100 * (0.01 + z), 0.02);
  EXPECT_EQ(example("embedding").out, "an image of 160 x 120, TRANSFER_SRC_OPTIMAL, timeline reached\n");

  // a .vdb file is read by the installed helper
  const std::string vdb = folder / "hill.vdb", png = folder / "hill.png";
  output_of({prefix() + "/bin/catena", "generate", "hill", "-o", vdb, "--resolution", "16"});
  EXPECT_FALSE(test::exists(prefix() + "/bin/catena-read"));
  const test::ProgramResult picture = example("picture", {vdb, png});
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
  EXPECT_EQ(test::read_file(png).substr(1, 3), "PNG");
  const test::ProgramResult none = example("picture", {folder / "none.vdb", png});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;
}

TEST_F(Package, LinksBetweenInstalledDocumentsAreValid) {
  const fs::path root = prefix() + "/" + CATENA_DOCDIR;
  const std::regex link(R"re((\]\(|src=")([^)#" \n]+))re"), code(R"re(```[^`]*```|`[^`\n]*`)re");
  int links = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".md") continue;
    const std::string text = std::regex_replace(test::read_file(entry.path().string()), code, "");
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string to = (*it)[2];
      if (to.starts_with("http")) continue;
      EXPECT_TRUE(fs::exists(entry.path().parent_path() / to)) << entry.path() << " links to " << to;
      ++links;
    }
  }
  EXPECT_GT(links, 100);
  for (const char* name : {"README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "LICENSE", "docs/reference/scene.md"})
    EXPECT_TRUE(fs::exists(root / name)) << name;
}

TEST_F(Package, ScenesAreInstalledExceptTheDataFolder) {
  const std::string scenes = prefix() + "/" + CATENA_DATADIR + "/catena/scenes";
  for (const auto& entry : fs::directory_iterator(test::source_dir() + "/assets/scenes")) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(test::exists(scenes + "/" + name), name != "data") << name;
  }
}

TEST_F(Package, EveryCommandHasAManualPageWithItsOptions) {
  const std::string manual = prefix() + "/" + CATENA_MANDIR + "/man1/";
  const test::ProgramResult help = test::run_catena({"--help"});
  const std::size_t at = help.out.find("Subcommands:");
  ASSERT_NE(at, std::string::npos) << help.out;
  EXPECT_EQ(help.out.find("documents"), std::string::npos);
  std::istringstream in(help.out.substr(at));
  std::string line;
  std::getline(in, line);
  int commands = 0;
  while (std::getline(in, line) && line.starts_with("  ") && line[2] != ' ') {
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    ASSERT_TRUE(test::exists(manual + "catena-" + name + ".1")) << name;
    EXPECT_NE(test::read_file(manual + "catena.1").find("catena\\-" + name + "(1)"), std::string::npos) << name;
    ++commands;
  }
  EXPECT_GE(commands, 10);
  const std::string first = test::read_file(manual + "catena.1");
  EXPECT_NE(first.find(".SH NAME\ncatena \\- see a scientific field and feel it with a hand\n"), std::string::npos) << first;
  EXPECT_NE(first.find("\\fBcatena\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n"), std::string::npos) << first;
  EXPECT_NE(test::read_file(manual + "catena-devices.1").find("\\fBcatena devices\\fR [\\fICOMMAND\\fR]"), std::string::npos);
  const std::string page = test::read_file(manual + "catena-render.1");
  for (const char* words : {".SH NAME\ncatena\\-render \\- ", "\\fB\\-\\-size\\fR", ".SH EXIT STATUS"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

TEST_F(Package, TheShellCompletionKnowsCommandsAndOptions) {
  const auto completed = [](const std::string& words, int at) {
    const std::string script = "source " + prefix() + "/" + CATENA_DATADIR + "/bash-completion/completions/catena && COMP_WORDS=(" + words +
                               ") COMP_CWORD=" + std::to_string(at) + " && _catena && echo \"${COMPREPLY[@]}\"";
    const test::ProgramResult result = test::run_program("/bin/bash", {"-c", script});
    EXPECT_EQ(result.err, "");
    return result.out;
  };
  EXPECT_EQ(completed("catena ren", 1), "render\n");
  EXPECT_EQ(completed("catena replay --prob", 2), "--probe\n");
  EXPECT_NE(completed("catena study r", 2).find("run"), std::string::npos);
  EXPECT_EQ(completed("catena docu", 1), "\n");
}

TEST_F(Package, ProjectsCanAddTheSourceTree) {
  const std::string project = folder / "project";
  fs::create_directories(project);
  fs::create_directory_symlink(test::source_dir(), project + "/catena");
  test::write_file(project + "/main.cpp", "int main() {}\n");
  test::write_file(project + "/CMakeLists.txt",
                   "cmake_minimum_required(VERSION 3.25)\nproject(outer CXX)\nadd_subdirectory(catena)\nadd_executable(main main.cpp)\n"
                   "target_link_libraries(main PRIVATE catena::field catena::flow catena::haptics catena::render)\n");
  test::run_cmake({"-S", project, "-B", folder / "build", "-G", "Ninja"});
}

}  // namespace package_test
