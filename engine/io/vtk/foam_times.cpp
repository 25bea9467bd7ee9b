// SPDX-License-Identifier: MIT
#include "engine/io/vtk/foam_times.h"

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::vtk {
namespace {

namespace fs = std::filesystem;

/// Returns whether the file is a volume field, by the class in its header, which begins within the length of the license banner; a
/// compressed file counts by its name alone.
bool is_volume_field(const fs::path& path) {
  if (has_extension(path.string(), ".gz")) return true;
  std::array<char, 2048> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  const std::string_view text(head.data(), static_cast<std::size_t>(file.gcount()));
  return text.find("FoamFile") != std::string_view::npos && text.find(" vol") != std::string_view::npos;
}

void add_fields(const fs::path& folder, bool with_regions, std::set<std::string>& names) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    std::error_code ignored;
    const std::string name = at->path().filename().string();
    if (at->is_directory(ignored)) {
      if (with_regions && name != "uniform" && name != "polyMesh" && name != "lagrangian") add_fields(at->path(), false, names);
    } else if (at->is_regular_file(ignored) && is_volume_field(at->path())) {
      names.insert(has_extension(name, ".gz") ? name.substr(0, name.size() - 3) : name);
    }
  }
}

template <class Visit>
void each_time(const fs::path& folder, const Visit& visit) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    std::error_code ignored;
    const auto time = parse_double(at->path().filename().string());
    if (time && std::isfinite(*time) && at->is_directory(ignored)) visit(*time, at->path());
  }
}

}  // namespace

std::set<double> list_foam_times(const fs::path& folder) {
  std::set<double> times;
  each_time(folder, [&](double time, const fs::path&) { times.insert(time); });
  return times;
}

std::set<std::string> list_foam_fields(const fs::path& folder, double time) {
  std::set<std::string> names;
  each_time(folder, [&](double one, const fs::path& path) {
    if (one == time) add_fields(path, true, names);
  });
  return names;
}

}  // namespace catena::vtk
