#include "engine/app/run_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/app/command.h"
#include "engine/base/input_files.h"
#include "engine/field/parts.h"
#include "engine/scene/file_pattern.h"
#include "haptics/device/registry.h"

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
    inputs.insert(inputs.end(), source.series.begin(), source.series.end());
    if (!source.labels_file.empty())
      for (const char* ending : {"", ".lut"})
        inputs.push_back(*ending == 0 ? source.labels_file : fs::path(source.labels_file).replace_extension(ending).string());
  });
  const auto add_shape = [&](scene::Entity, const auto& source) {
    if (!source.path.empty()) inputs.push_back(source.path);
    inputs.insert(inputs.end(), source.steps.series.begin(), source.steps.series.end());
  };
  scene.world.each<scene::MeshSource>(add_shape);
  scene.world.each<scene::DrawnCurves>(add_shape);
  scene.world.each<scene::DrawnPoints>(add_shape);
  return inputs;
}

void RunFiles::reads(const std::string& path) {
  if (path.empty()) return;
  if (!scene::is_pattern(path)) return inputs_.push_back(path);
  for (std::string& file : scene::files_of_pattern(path)) inputs_.push_back(std::move(file));
}

void RunFiles::reads(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) reads(path);
}

void RunFiles::reads(const scene::Scene& scene) { reads(inputs_of(scene)); }

void RunFiles::reads_device(const std::string& name) {
  if (const std::string table = haptics::table_of_device(name); !table.empty()) return writes("--device", table);
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

Outcome RunFiles::check(bool keeps_scene) const {
  CATENA_CHECK(check_outputs(outputs_, inputs_));
  std::vector<const Output*> there;
  for (const Output& output : outputs_)
    if (file_id(output.path)) there.push_back(&output);
  std::vector<FileId> files;
  for (const std::string& input : inputs_) {
    if (!keeps_scene || !is_scene_file(input))
      if (const auto id = file_id(input)) files.push_back(*id);
    // who reads it is asked only where something could be overwritten
    if (there.empty() || !field::has_parts(input)) continue;
    const std::vector<FileId> parts = field::parts_of(input);
    for (const Output* output : there)
      if (std::ranges::find(parts, *file_id(output->path)) != parts.end())
        return Error{output->path + ": is also an input, a part of " + input + ": expected another name for the output"};
  }
  add_inputs(files);
  return Done{};
}

}  // namespace catena::app
