#include "engine/base/output_check.h"

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

namespace catena {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxSymlinks = 40;

/// What a name leads to: a thing on the disk, or the place where one would be made.
using Identity = std::tuple<dev_t, ino_t, std::string>;

/// None: a device, a pipe, or a name of nothing.
std::optional<Identity> identity_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  struct stat about {};
  if (::stat(name.c_str(), &about) == 0) {
    if (!S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode)) return std::nullopt;
    return Identity{about.st_dev, about.st_ino, {}};
  }
  // a link to nothing is the place that it names
  std::error_code code;
  fs::path place = fs::absolute(name, code);
  for (int k = 0; k < kMaxSymlinks && fs::is_symlink(place, code); ++k) {
    const fs::path to = fs::read_symlink(place, code);
    place = to.is_absolute() ? to : place.parent_path() / to;
  }
  const fs::path folder = place.parent_path();
  if (::stat(folder.c_str(), &about) == 0) return Identity{about.st_dev, about.st_ino, "/" + place.filename().string()};
  return Identity{0, 0, fs::weakly_canonical(place, code).string()};
}

Outcome check_place(const std::string& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) return Error{path + ": is a folder: expected a file name to write to"};
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) return Error{path + ": the folder " + folder.string() + " does not exist"};
  return Done{};
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
  const auto first = identity_of(a);
  return first && first == identity_of(b);
}

Outcome check_outputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs) {
  std::map<Identity, const std::string*> read;
  for (const std::string& input : inputs)
    if (const auto identity = identity_of(input)) read.emplace(*identity, &input);
  std::map<Identity, const Output*> written;
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    CATENA_CHECK(check_place(output.path));
    const auto identity = identity_of(output.path);
    if (!identity) continue;
    if (read.contains(*identity)) return Error{output.path + ": is also an input: expected another name for the output"};
    const auto [at, fresh] = written.emplace(*identity, &output);
    if (!fresh)
      return Error{output.path + ": " + at->second->option + " and " + output.option + " name one file: expected " +
                   (at->second->option == output.option ? "one a frame" : "two")};
  }
  return Done{};
}

Outcome check_output(const std::string& path, const std::vector<std::string>& inputs) {
  if (path.empty()) return Error{"the output's name is empty: expected a file name"};
  return check_outputs({{"", path}}, inputs);
}

}  // namespace catena
