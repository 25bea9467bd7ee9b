#include "engine/app/command.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "engine/base/clock.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"

namespace catena::app {

bool is_scene_file(const std::string& path) { return path.ends_with(".json"); }

Result<std::vector<scene::FieldOverride>> field_overrides(const std::vector<std::string>& field_options) {
  std::vector<scene::FieldOverride> overrides;
  for (const std::string& option : field_options) {
    const auto equals = option.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == option.size())
      return Error{"--field " + option + ": expected NAME=FILE or NAME=FILE:GRID"};
    scene::FieldOverride entry{option.substr(0, equals), option.substr(equals + 1), {}};
    const auto colon = entry.file.rfind(':');
    std::error_code code;
    if (colon != std::string::npos && !std::filesystem::exists(entry.file, code)) {
      entry.grid = entry.file.substr(colon + 1);
      entry.file.resize(colon);
    }
    overrides.push_back(std::move(entry));
  }
  return overrides;
}

// a scene may write the same thing a hundred times
void tell_new_notes(const scene::Scene& scene, std::size_t told) {
  if (scene.notes.size() <= told) return;
  const std::size_t rest = scene.notes.size() - told - 1;
  tell_from_catena("note: " + scene.notes[told] + (rest > 0 ? " (and " + std::to_string(rest) + " more)" : ""));
}

Result<scene::Scene> open_scene(const std::string& path, const std::vector<std::string>& field_options, const scene::NamedColors& colors,
                                const std::string& grid) {
  CATENA_TRY(const std::vector<scene::FieldOverride> overrides, field_overrides(field_options));
  if (is_scene_file(path)) {
    if (!grid.empty()) return Error{path + ": --grid goes with a data file; a scene names its grids"};
    if (!colors.map.empty() || colors.range) return Error{path + ": --colormap and --range go with a data file; a scene says its colours"};
    auto scene = scene::read_scene(path, overrides);
    if (scene) tell_new_notes(*scene, 0);
    return scene;
  }
  if (!overrides.empty()) return Error{path + ": --field goes with a scene file (.json)"};
  return scene::scene_for_file(path, grid, colors);
}

std::string human_bytes(double bytes) {
  const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  int unit = 0;
  for (; bytes >= 1024 && unit < 4; ++unit) bytes /= 1024;
  return unit == 0 ? fmt::format("{:.0f} B", bytes) : fmt::format("{:.2f} {}", bytes, units[unit]);
}

constexpr std::int64_t kQuietNs = 1'000'000'000, kQuietElsewhereNs = 10 * kQuietNs;

Progress::Progress(std::string what, double total)
    : what_(std::move(what)), total_(total), start_(now_ns()), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_ && terminal_) std::fputs("\n", stderr);
}

void Progress::at(double done, std::string_view doing) {
  const std::int64_t now = now_ns();
  if (total_ <= 0 || now - start_ < (terminal_ ? kQuietNs : kQuietElsewhereNs)) return;
  const double part = done / total_ < 1 ? done / total_ : 1;
  if (terminal_) {
    if (now - last_ < 200'000'000 && part < 1) return;
    std::fputs(fmt::format("\r{}: {:3.0f} % {:<16}", printable(what_), 100 * part, doing).c_str(), stderr);
    std::fflush(stderr);
  } else {
    const int tenth = static_cast<int>(10 * part);
    if (tenth <= tenths_) return;
    tenths_ = tenth;
    tell(fmt::format("{}: {:.0f} %{}{}", what_, 100 * part, doing.empty() ? "" : ", ", doing));
  }
  shown_ = true;
  last_ = now;
}

}  // namespace catena::app
