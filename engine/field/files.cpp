#include "engine/field/files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/base/too_many_files.h"
#include "engine/field/loaders.h"

namespace catena::field {

Result<std::uint64_t> readable_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return Error{fmt::format("{}: there is no such file", path)};
  if (std::filesystem::is_directory(status)) return Error{fmt::format("{}: this is a folder, expected a file", path)};
  if (!std::filesystem::is_regular_file(status)) return Error{fmt::format("{}: this is not a regular file", path)};
  const std::uint64_t size = std::filesystem::file_size(path, error);
  errno = 0;
  if (error || !std::ifstream(path, std::ios::binary)) {
    const int why = errno;
    return Error{fmt::format("{}: cannot be opened ({})", path, std::strerror(why)), too_many_files(why)};
  }
  if (size == 0) return Error{fmt::format("{}: the file is empty", path)};
  return size;
}

std::string stem_of(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  std::string_view ending;
  return name.substr(0, format_of(name, &ending) != nullptr ? name.size() - ending.size() : name.rfind('.'));
}

}  // namespace catena::field
