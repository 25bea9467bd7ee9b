#include "tests/support/support.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/base/assert.h"

namespace catena::test {

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
  const auto path = std::filesystem::path(CATENA_SOURCE_DIR_FOR_SUPPORT).parent_path() / "shared" / "data" / name;
  return std::filesystem::exists(path) ? path.string() : std::string();
}

}  // namespace catena::test
