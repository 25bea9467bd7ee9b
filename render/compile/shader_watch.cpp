#include "render/compile/shader_watch.h"

#include <algorithm>
#include <optional>

namespace catena::render {
namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& name) { return "passes/" + name; }

}  // namespace

Result<ShaderWatch> ShaderWatch::open(const std::string& folder, std::vector<std::string> names) {
  ShaderWatch watch;
  watch.folder_ = folder;
  watch.names_ = std::move(names);
  std::error_code error;
  for (const std::string& name : watch.names_)
    if (!fs::is_regular_file(folder + "/" + file_of(name), error))
      return Error{folder + "/" + file_of(name) + ": not found; expected the program's folder of shaders, with all of them"};
  return watch;
}

std::map<std::string, ShaderWatch::Stamp> ShaderWatch::stamps() const {
  std::map<std::string, Stamp> found;
  // a file that is being replaced may be gone for a moment: it is looked at again the next time
  for (const char* part : {"passes", "lib", "shared"}) {
    std::error_code error;
    for (fs::directory_iterator at(folder_ + "/" + part, error), end; !error && at != end; at.increment(error)) {
      std::error_code gone;
      const Stamp stamp = at->last_write_time(gone);
      if (!gone) found[std::string(part) + "/" + at->path().filename().string()] = stamp;
    }
  }
  return found;
}

ShaderNews ShaderWatch::poll() {
  std::set<std::string> touched;
  for (const auto& [file, stamp] : stamps()) {
    const auto [at, is_new] = seen_.try_emplace(file, stamp);
    if (!is_new && at->second == stamp) continue;
    at->second = stamp;
    touched.insert(file);
  }
  ShaderNews news;
  if (touched.empty()) return news;
  for (const std::string& name : names_) {
    std::set<std::string>& files = files_[name];
    const bool concerns = files.empty() || std::ranges::any_of(touched, [&](const std::string& file) { return files.contains(file); });
    if (!concerns) continue;
    auto compiled = compile_shader(folder_, file_of(name));
    if (!compiled) {
      if (std::ranges::find(news.errors, compiled.error().message) == news.errors.end()) news.errors.push_back(compiled.error().message);
      continue;
    }
    files = {compiled->files.begin(), compiled->files.end()};
    news.changed.push_back({name, std::move(compiled->words)});
  }
  return news;
}

}  // namespace catena::render
