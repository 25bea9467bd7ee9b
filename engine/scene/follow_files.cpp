// SPDX-License-Identifier: MIT
#include "engine/scene/follow_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>

#include "engine/base/input_files.h"
#include "engine/base/natural_sort.h"
#include "engine/base/text.h"
#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"

namespace catena::scene {
namespace {

namespace fs = std::filesystem;

/// A file that has not changed for this long counts as completely written.
constexpr std::int64_t kSettledNs = 1'000'000'000;

std::int64_t age_ns(std::int64_t changed) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() - changed;
}

/// Returns false if the file has changed within kSettledNs, or does not exist.
bool is_settled(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return false;
  return S_ISDIR(about.st_mode) || age_ns(modified_ns(about)) >= kSettledNs;
}

/// Returns whether a step can be read completely. A field is added to the cache, so that it is shown without being read twice.
bool is_readable(const FollowedSource& one, const field::LoadRequest& request) {
  switch (one.kind) {
    case FollowedSource::Kind::field: {
      const auto loaded = field::load(request);
      const bool complete = loaded && (loaded->newest_mtime_ns == 0 || age_ns(loaded->newest_mtime_ns) >= kSettledNs);
      if (complete) field::add_to_cache(request, *loaded);
      return complete;
    }
    case FollowedSource::Kind::mesh:
      return bool(mesh::load_mesh(request.path, {}, request.step));
    case FollowedSource::Kind::curves:
      return bool(curves::load_curves(request.path, request.step));
    case FollowedSource::Kind::points:
      return bool(curves::load_points(request.path, request.step));
  }
  return false;
}

bool find_new_files(FollowedSource& one) {
  std::vector<std::string> files;
  bool has_new = false;
  const auto name_of = [](const std::string& path) { return fs::path(path).filename().string(); };
  for (const std::string& file : expand_pattern(one.pattern)) {
    const bool known = std::ranges::find(one.series, file) != one.series.end();
    field::LoadRequest request = one.request;
    request.path = file;
    request.step = 0;
    if (!known && (!is_numbered_series({name_of(one.series.front()), name_of(file)}) || !is_settled(file) || !is_readable(one, request)))
      continue;
    files.push_back(file);
    has_new = has_new || !known;
  }
  if (has_new) one.series = std::move(files);
  return has_new;
}

bool find_new_times(FollowedSource& one) {
  const std::vector<double> times = field::read_times(one.request.path);
  const std::size_t before = one.times.size();
  if (!std::equal(one.times.begin(), one.times.end(), times.begin(),
                  times.begin() + static_cast<std::ptrdiff_t>(std::min(before, times.size()))))
    return false;  // the file has been replaced by another one
  for (std::size_t step = before; step < times.size(); ++step) {
    field::LoadRequest request = one.request;
    request.step = static_cast<std::int32_t>(step);
    if (!is_settled(request.path) || !is_readable(one, request)) break;
    one.times.push_back(times[step]);
  }
  return one.times.size() > before;
}

/// Returns whether more time steps can be added to a file of this format.
bool can_grow(const std::string& path) {
  std::error_code code;
  return std::ranges::any_of(std::initializer_list<std::string_view>{".pvd", ".series", ".foam", ".case", ".encas", ".nc", ".cdf"},
                             [&](std::string_view ending) { return has_extension(path, ending); }) ||
         fs::is_directory(path, code);
}

void drop_newest(std::vector<std::string>& series) {
  if (series.size() > 1) series.pop_back();
  while (series.size() > 1 && !is_settled(series.back())) series.pop_back();
}

/// Calls `visit(kind, name, part)` for each mesh, each curve set and each point set.
template <class S, class Visit>
void each_shape_kind(S& scene, const Visit& visit) {
  const auto call = [&](FollowedSource::Kind kind) {
    return [&, kind](Entity e, auto& part) { visit(kind, scene.entities.template get<Name>(e).value, part); };
  };
  scene.entities.template each<MeshSource>(call(FollowedSource::Kind::mesh));
  scene.entities.template each<CurvesSource>(call(FollowedSource::Kind::curves));
  scene.entities.template each<PointsSource>(call(FollowedSource::Kind::points));
}

}  // namespace

bool start_following(Scene& scene) {
  bool any = false;
  scene.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    if (source.has_own_step || !source.file || (source.pattern.empty() && !can_grow(source.file->path))) return;
    source.follows = any = true;
    drop_newest(source.series);
    assign_step(source, scene.time.step);
  });
  each_shape_kind(scene, [&](FollowedSource::Kind, const std::string&, auto& part) {
    FileSteps& steps = part.steps;
    if (steps.pattern.empty() && !can_grow(part.path)) return;
    steps.follows = any = true;
    drop_newest(steps.series);
    assign_step(part, scene.time.step);
  });
  return any;
}

std::vector<FollowedSource> followed_sources(const Scene& scene) {
  std::vector<FollowedSource> all;
  scene.entities.each<FieldSource>([&](Entity e, const FieldSource& source) {
    if (!source.follows || source.loaded.get() == nullptr) return;
    const std::span<const double> times = step_times(source);
    all.push_back({FollowedSource::Kind::field,
                   scene.entities.get<Name>(e).value,
                   source.pattern,
                   source.series,
                   *source.file,
                   {times.begin(), times.end()}});
  });
  each_shape_kind(scene, [&](FollowedSource::Kind kind, const std::string& name, const auto& part) {
    if (!part.steps.follows || !part.loaded) return;
    field::LoadRequest request;
    request.path = part.path;
    all.push_back({kind, name, part.steps.pattern, part.steps.series, request, part.steps.times});
  });
  return all;
}

bool poll_steps(FollowedSource& source) { return source.pattern.empty() ? find_new_times(source) : find_new_files(source); }

bool apply_steps(Scene& scene, const std::vector<FollowedSource>& found) {
  const int before = step_count(scene);
  scene.entities.each<FieldSource>([&](Entity e, FieldSource& source) {
    for (const FollowedSource& one : found) {
      if (one.kind != FollowedSource::Kind::field || one.name != scene.entities.get<Name>(e).value || one.pattern != source.pattern)
        continue;
      if (!source.follows || (one.pattern.empty() && one.request.path != source.file->path)) continue;
      source.series = one.series;
      source.known_times = one.times;
    }
  });
  each_shape_kind(scene, [&](FollowedSource::Kind kind, const std::string& name, auto& part) {
    for (const FollowedSource& one : found) {
      if (one.kind != kind || one.name != name || one.pattern != part.steps.pattern || !part.steps.follows) continue;
      if (one.pattern.empty() && one.request.path != part.path) continue;
      part.steps.series = one.series;
      part.steps.times = one.times;
    }
  });
  return step_count(scene) > before;
}

Result<std::string> find_followable_path(const std::string& path) {
  if (can_grow(path) || (is_pattern(path) && fs::path(path).filename().string().find('*') != std::string::npos)) return path;
  const fs::path first(first_file(path));
  if (std::error_code code; !fs::exists(first, code))
    return Error{one_line(path + ": there is no such file; for files that do not exist yet a pattern (\"wake_*.vtu\") was expected")};
  const auto [before, after] = split_at_last_number(first.filename().string());
  if (after.empty())
    return Error{one_line(path +
                          ": steps cannot be added to this file; a file with a number in its name, a pattern (\"wake_*.vtu\"), a .pvd, a "
                          ".series or an OpenFOAM case was expected")};
  return (first.parent_path() / (before + "*" + after)).string();
}

bool may_be_incomplete(const std::string& path) {
  constexpr std::int64_t kMaxPauseNs = 10 * kSettledNs;
  struct stat about {};
  if (::stat(first_file(path).c_str(), &about) != 0) return is_pattern(path);
  return age_ns(modified_ns(about)) < kMaxPauseNs;
}

}  // namespace catena::scene
