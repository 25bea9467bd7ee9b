#include "engine/app/run_files.h"

#include <cstdlib>
#include <filesystem>

namespace catena::app {

namespace fs = std::filesystem;

std::string user_folder(const char* variable, const char* under_home) {
  const char *stated = std::getenv(variable), *home = std::getenv("HOME");
  if (stated != nullptr && fs::path(stated).is_absolute()) return (fs::path(stated) / "catena").string();
  if (home != nullptr && fs::path(home).is_absolute()) return (fs::path(home) / under_home / "catena").string();
  return {};
}

std::vector<std::string> inputs_of(const scene::Scene& scene) {
  std::vector<std::string> inputs{scene.path};
  inputs.insert(inputs.end(), scene.files.begin(), scene.files.end());
  // of a scene that was made for a data file, and not read from a text
  scene.world.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    if (source.file) inputs.push_back(source.file->path);
  });
  scene.world.each<scene::MeshSource>([&](scene::Entity, const scene::MeshSource& source) { inputs.push_back(source.path); });
  scene.world.each<scene::DrawnCurves>([&](scene::Entity, const scene::DrawnCurves& source) { inputs.push_back(source.path); });
  scene.world.each<scene::DrawnPoints>([&](scene::Entity, const scene::DrawnPoints& source) { inputs.push_back(source.path); });
  return inputs;
}

void RunFiles::reads(const std::string& path) {
  if (!path.empty()) inputs_.push_back(path);
}

void RunFiles::reads(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) reads(path);
}

void RunFiles::reads(const scene::Scene& scene) { reads(inputs_of(scene)); }

void RunFiles::reads_device(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon != std::string::npos) reads(name.substr(colon + 1));
}

void RunFiles::reads_folder(const std::string& folder) {
  std::error_code code;
  if (folder.empty()) return;
  for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
    if (it->is_regular_file(code)) reads(it->path().string());
}

void RunFiles::writes(const std::string& option, const std::string& path) { outputs_.push_back({option, path}); }

}  // namespace catena::app
