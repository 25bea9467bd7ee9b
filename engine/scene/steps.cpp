#include "engine/scene/steps.h"

#include <algorithm>
#include <filesystem>

namespace catena::scene {
namespace {

/// Numbers in names count by their value.
bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& s, std::size_t& at) {
      while (at < s.size() && s[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < s.size() && digit(s[at])) ++at;
      return std::string_view(s).substr(begin, at - begin);
    };
    const std::string_view x = number(a, i), y = number(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  const std::size_t left = a.size() - i, right = b.size() - j;
  return left != right ? left < right : a < b;
}

int steps_of(const FieldSource& source) {
  if (source.own_step || !source.file) return 1;
  if (!source.series.empty()) return static_cast<int>(source.series.size());
  return std::max(1, static_cast<int>(source.loaded.times.size()));
}

}  // namespace

bool is_pattern(const std::string& path) { return std::filesystem::path(path).filename().string().find('*') != std::string::npos; }

std::vector<std::string> files_of_pattern(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path whole(path);
  const std::string name = whole.filename().string();
  const std::size_t star = name.find('*');
  const std::string before = name.substr(0, star), after = name.substr(star + 1);
  const fs::path folder = whole.has_parent_path() ? whole.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string one = at->path().filename().string();
    std::error_code ignored;
    if (one.size() >= before.size() + after.size() && one.starts_with(before) && one.ends_with(after) && at->is_regular_file(ignored))
      names.push_back(one);
  }
  std::sort(names.begin(), names.end(), natural_less);
  for (std::string& one : names) one = (whole.parent_path() / one).string();
  return names;
}

int step_count(const Scene& scene) {
  int most = 1;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) { most = std::max(most, steps_of(source)); });
  return most;
}

std::optional<double> time_of_step(const Scene& scene) {
  std::optional<double> time;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (!time && steps_of(source) > 1 && static_cast<std::size_t>(scene.time.step) < source.loaded.times.size())
      time = source.loaded.times[static_cast<std::size_t>(scene.time.step)];
  });
  return time;
}

void put_step(FieldSource& source, int step) {
  if (source.own_step || !source.file) return;
  if (source.series.empty())
    source.file->step = step;
  else
    source.file->path = source.series[static_cast<std::size_t>(std::min(step, static_cast<int>(source.series.size()) - 1))];
}

bool set_step(Scene& scene, int step) {
  if (scene.time.step == step) return false;
  scene.time.step = step;
  bool changed = false;
  scene.world.each<FieldSource>([&](Entity, FieldSource& source) {
    if (!source.file) return;
    const field::LoadRequest before = *source.file;
    const std::size_t times = source.loaded.times.size();
    put_step(source, step);
    // a file without steps stays as it is
    const bool same = *source.file == before || (source.series.empty() && source.loaded.get() != nullptr && times < 2);
    if (same) return;
    source.loaded = source.drawn = {};
    source.stepped = true;
    changed = true;
  });
  if (changed) scene.made = World{};
  return changed;
}

std::vector<field::LoadRequest> requests_at(const Scene& scene, int step) {
  std::vector<field::LoadRequest> requests;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (source.loaded.get() == nullptr || steps_of(source) < 2) return;
    FieldSource ahead = source;
    put_step(ahead, step);
    requests.push_back(*ahead.file);
  });
  return requests;
}

}  // namespace catena::scene
