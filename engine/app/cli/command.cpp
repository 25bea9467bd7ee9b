// SPDX-License-Identifier: MIT
#include "engine/app/cli/command.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "engine/scene/follow_files.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

bool is_scene_file(const std::string& path) { return path.ends_with(".json"); }

Result<std::vector<scene::FieldOverride>> parse_field_overrides(const std::vector<std::string>& field_options) {
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

void print_scene_notes(const scene::Scene& scene) { print_scene_notes({}, scene.notes); }

void print_scene_notes(const std::string& path, const std::vector<std::string>& notes) {
  constexpr std::size_t kMaximum = 10;
  static std::mutex mutex;
  static std::set<std::string> printed_notes;
  const std::scoped_lock lock(mutex);
  std::size_t count = 0;
  for (const std::string& note : notes) {
    const std::string text = path.empty() ? note : path + ": " + note;
    if (printed_notes.insert(text).second && ++count <= kMaximum) print_message("note: " + text);
  }
  if (count > kMaximum) print_message(fmt::format("note: {} more notes", count - kMaximum));
}

Result<scene::Scene> open_scene(const std::string& path, const std::vector<std::string>& field_options, const scene::FileColors& colors,
                                const std::string& grid, int step) {
  CATENA_TRY(const std::vector<scene::FieldOverride> overrides, parse_field_overrides(field_options));
  if (is_scene_file(path)) {
    if (!grid.empty()) return Error{path + ": --grid applies only to a data file; a scene names its grids"};
    if (colors.is_given())
      return Error{path + ": options of colours, labels and --over apply only to a data file; a scene states its colours itself"};
    auto scene = scene::read_scene(path, overrides);
    if (scene) print_scene_notes(*scene);
    return scene;
  }
  if (!overrides.empty()) return Error{path + ": --field applies only to a scene file (.json)"};
  return scene::scene_for_file(path, grid, colors, std::max(0, step));
}

Result<scene::Scene> open_followed_scene(std::string& source, const std::vector<std::string>& field_options, const std::string& grid,
                                         double seconds) {
  const std::int64_t end_ns = seconds > 0 ? now_ns() + static_cast<std::int64_t>(1e9 * seconds) : std::numeric_limits<std::int64_t>::max();
  if (!is_scene_file(source)) {
    CATENA_TRY(source, scene::find_followable_path(source));
  }
  bool is_reported = false;
  for (;;) {
    auto opened = open_scene(source, field_options, {}, grid);
    if (opened && !scene::start_following(*opened))
      return Error{source +
                   ": --follow: no field of it can get new time steps; a field of a pattern, or of a file with time steps, was expected"};
    if (opened || opened.error().system_failure || is_scene_file(source) || !scene::may_be_incomplete(source) || now_ns() > end_ns)
      return opened;
    if (!std::exchange(is_reported, true)) print_message("waiting for a complete file (" + opened.error().message + ")");
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}

Outcome check_step(int step, int last, const std::string& option, const std::string& source) {
  if (step <= last) return Done{};
  return Error{last == 0 ? fmt::format("{}: no field of {} has time steps", option, source)
                         : fmt::format("{}: the last step of {} is {}, counted from 0", option, source, last)};
}

Outcome go_to_step(scene::Scene& scene, int step, const std::string& option) {
  if (step < 0) return Done{};
  std::vector<scene::Entity> fields;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) { fields.push_back(e); });
  scene::set_step(scene, step);
  for (const scene::Entity e : fields) {
    CATENA_TRY(const field::AnyField loaded, scene::resolve_field(scene, e, scene.entities.get<scene::FieldSource>(e).where));
  }
  return check_step(step, scene::step_count(scene) - 1, option, scene.path);
}

Result<std::vector<field::GridInfo>> read_grid_infos(const std::string& path, const std::string& grid, int step) {
  CATENA_TRY(std::vector<field::GridInfo> grids, field::describe_grids(path, step));
  if (grid.empty()) return grids;
  for (const auto& way : {&field::GridInfo::name, &field::GridInfo::series_number})
    if (const auto found = std::ranges::find(grids, grid, way); found != grids.end()) return std::vector{*found};
  std::vector<std::string> names;
  for (const field::GridInfo& one : grids) names.push_back(one.series_number + (one.series_number.empty() ? "" : " ") + one.name);
  const std::string known = join_words({names.begin(), names.end()});
  // all volumes of one DICOM series
  std::erase_if(grids, [&](const field::GridInfo& one) { return !one.series_number.starts_with(grid + "."); });
  if (!grids.empty()) return grids;
  return Error{one_line(path + ": there is no grid " + in_quotes(grid) + ", the file has: " + known)};
}

std::string format_bytes(double bytes) {
  const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  int unit = 0;
  for (; bytes >= 1024 && unit < 4; ++unit) bytes /= 1024;
  return unit == 0 ? fmt::format("{:.0f} B", bytes) : fmt::format("{:.2f} {}", bytes, units[unit]);
}

constexpr std::int64_t kQuietNs = 1'000'000'000, kQuietElsewhereNs = 10 * kQuietNs;

void print_reading_progress(const std::string& path, double seconds, bool ended) {
  static std::mutex mutex;
  static bool shown = false;
  static double next_s = 1e-9 * kQuietElsewhereNs;
  const std::scoped_lock lock(mutex);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  set_activity(ended ? std::string() : fmt::format("reading {}: {:.0f} s", path, seconds));
  if (ended) {
    if (std::exchange(shown, false) && terminal) print_nonblocking(STDERR_FILENO, "\r\033[K");
    next_s = 1e-9 * kQuietElsewhereNs;
    return;
  }
  if (seconds < 1e-9 * static_cast<double>(terminal ? kQuietNs : kQuietElsewhereNs)) return;
  if (terminal) {
    print_nonblocking(STDERR_FILENO, fmt::format("\rreading {}: {:.0f} s", sanitize_for_terminal(path), seconds));
  } else if (seconds >= next_s) {
    print_line(fmt::format("reading {}: {:.0f} s so far", path, seconds));
    next_s *= 3;
  }
  shown = true;
}

ProgressLine::ProgressLine(std::string what, double total)
    : task_name_(std::move(what)), total_(total), start_ns_(now_ns()), is_terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (is_shown_ && is_terminal_) std::fputs("\n", stderr);
}

void ProgressLine::update(double done, std::string_view step_label) {
  const std::int64_t now = now_ns();
  if (total_ <= 0 || now - start_ns_ < (is_terminal_ ? kQuietNs : kQuietElsewhereNs)) return;
  const double part = done / total_ < 1 ? done / total_ : 1;
  if (is_terminal_) {
    if (now - last_update_ns_ < 200'000'000 && part < 1) return;
    std::fputs(fmt::format("\r{}: {:3.0f} % {:<16}", sanitize_for_terminal(task_name_), 100 * part, step_label).c_str(), stderr);
    std::fflush(stderr);
  } else {
    const int tenth = static_cast<int>(10 * part);
    if (tenth <= printed_tenths_) return;
    printed_tenths_ = tenth;
    print_line(fmt::format("{}: {:.0f} %{}{}", task_name_, 100 * part, step_label.empty() ? "" : ", ", step_label));
  }
  is_shown_ = true;
  last_update_ns_ = now;
}

void print_tracing_progress(const std::string& field, std::size_t seeds, std::size_t of) {
  thread_local std::optional<ProgressLine> shown;
  if (of == 0) return shown.reset();
  if (!shown) shown.emplace("streamlines of " + field, static_cast<double>(of));
  shown->update(static_cast<double>(seeds));
}

void print_level_progress(const std::string& path, double part) {
  static std::mutex mutex;
  static std::map<std::string, ProgressLine> shown;
  const std::scoped_lock lock(mutex);
  set_activity(part < 0 ? std::string() : fmt::format("coarser levels of {}: {:.0f} %", path, 100 * part));
  if (part < 0) {
    shown.erase(path);
    return;
  }
  shown.try_emplace(path, "coarser levels of " + path, 1).first->second.update(part);
}

void print_brick_progress(std::size_t done, std::size_t of) {
  static std::optional<ProgressLine> shown;
  if (!shown) shown.emplace("bricks of the image", 1);
  shown->update(static_cast<double>(done) / static_cast<double>(of), fmt::format("{} of {}", done, of));
  if (done == of) shown.reset();
}

}  // namespace catena::app
