// SPDX-License-Identifier: MIT
#include "engine/app/cli/plugins.h"

#include <fmt/core.h>
#include <sys/auxv.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/app/cli/io_conflicts.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "haptics/plugin/load.h"

namespace catena::app {

namespace fs = std::filesystem;
namespace log = haptics::log;
namespace plugin = haptics::plugin;

namespace {

constexpr const char* kVariable = "CATENA_PLUGINS";

/// Loads the plug-ins of CATENA_PLUGINS. Paths must be absolute: a relative one could load a file from an untrusted folder, such as an
/// unpacked archive.
Outcome load_from_environment() {
  const char* const stated = std::getenv(kVariable);
  std::string rest = stated == nullptr ? "" : stated;
  while (!rest.empty()) {
    const std::string path = rest.substr(0, rest.find(':'));
    rest.erase(0, path.size() + 1);
    if (path.empty()) continue;
    if (!fs::path(path).is_absolute())
      return Error{
          one_line(std::string(kVariable) + ": " + path + ": is a relative path; absolute paths, separated by colons, were expected")};
    if (const Outcome loaded = plugin::load(path); !loaded) return Error{std::string(kVariable) + ": " + loaded.error().message};
  }
  return Done{};
}

/// Returns the plug-ins of the user's folder; none in a set-user-ID program, which must not read folders with its privileges.
std::vector<std::string> files_of_folder() {
  std::vector<std::string> files;
  const std::string data = user_folder("XDG_DATA_HOME", ".local/share");
  std::error_code code;
  if (!data.empty() && ::getauxval(AT_SECURE) == 0)
    for (fs::directory_iterator entry(data + "/plugins", code), end; !code && entry != end; entry.increment(code))
      if (entry->path().extension() == ".so") files.push_back(entry->path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

Outcome load_plugins(const std::vector<std::string>& named) {
  for (const std::string& path : named)
    if (const Outcome loaded = plugin::load(path); !loaded) return Error{"--plugin " + loaded.error().message};
  CATENA_CHECK(load_from_environment());
  for (const std::string& path : files_of_folder())
    if (const Outcome loaded = plugin::load(path); !loaded) print_message("note: plug-in not loaded: " + loaded.error().message);
  return Done{};
}

std::vector<log::LogPlugin> plugins_for_log() {
  std::vector<log::LogPlugin> out;
  for (const plugin::LoadedPlugin& one : plugin::loaded_plugins()) out.push_back({one.file, one.hash, one.types});
  return out;
}

Outcome check_plugins(const std::vector<log::LogPlugin>& recorded, const scene::Scene& scene) {
  const auto giver = [](const auto& plugins, const std::string& type) {
    return std::find_if(plugins.begin(), plugins.end(),
                        [&](const auto& one) { return std::find(one.types.begin(), one.types.end(), type) != one.types.end(); });
  };
  std::string missing;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    const auto then = giver(recorded, link.type);
    if (then == recorded.end() || !missing.empty()) return;
    const auto now = giver(plugin::loaded_plugins(), link.type);
    if (now != plugin::loaded_plugins().end() && now->hash == then->hash) return;
    missing = fmt::format("link {} ran in the plug-in {}; ", in_quotes(link.name), plugin_label(*then)) +
              (now == plugin::loaded_plugins().end()
                   ? "--plugin with this file was expected"
                   : fmt::format("this file was expected, but {} is loaded", plugin_label({now->file, now->hash, {}})));
  });
  return missing.empty() ? Outcome(Done{}) : Error{missing};
}

std::string plugin_label(const log::LogPlugin& plugin) {
  return fmt::format("{} ({:016x})", sanitize_for_terminal(plugin.file), plugin.hash);
}

}  // namespace catena::app
