// SPDX-License-Identifier: MIT
#include "tests/support/support.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/base/result.h"

namespace catena::test {

// The only test source compiled with absolute paths, so that a compiler cache works for every checkout.
const std::string& source_dir() {
  static const std::string path = CATENA_SOURCE_DIR;
  return path;
}

const std::string& binary_dir() {
  static const std::string path = CATENA_BINARY_DIR;
  return path;
}

const std::string& program_path() {
  static const std::string path = binary_dir() + "/catena";
  return path;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "catena-test-XXXXXX").string();
  CATENA_ASSERT(mkdtemp(pattern.data()) != nullptr);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  CATENA_ASSERT(out.good());
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

std::string shared_data(const std::string& name) {
  const auto path = std::filesystem::path(source_dir()).parent_path() / "shared" / "data" / name;
  return std::filesystem::exists(path) ? path.string() : std::string();
}

}  // namespace catena::test
