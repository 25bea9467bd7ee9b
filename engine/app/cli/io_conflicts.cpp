// SPDX-License-Identifier: MIT
#include "engine/app/cli/io_conflicts.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/app/cli/command.h"
#include "engine/base/input_files.h"
#include "engine/io/volume/data_files.h"
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

std::vector<std::string> scene_input_files(const scene::Scene& scene) {
  std::vector<std::string> inputs{scene.path};
  inputs.insert(inputs.end(), scene.referenced_files.begin(), scene.referenced_files.end());
  // files of a scene that was created for a data file and not read from a text
  scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
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
  scene.entities.each<scene::MeshSource>(add_shape);
  scene.entities.each<scene::CurvesSource>(add_shape);
  scene.entities.each<scene::PointsSource>(add_shape);
  return inputs;
}

void IoConflictChecker::add_input(const std::string& path) {
  if (path.empty()) return;
  if (!scene::is_pattern(path)) return inputs_.push_back(path);
  for (std::string& file : scene::expand_pattern(path)) inputs_.push_back(std::move(file));
}

void IoConflictChecker::add_input(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) add_input(path);
}

void IoConflictChecker::add_input(const scene::Scene& scene) { add_input(scene_input_files(scene)); }

void IoConflictChecker::add_device_files(const std::string& name) {
  if (const std::string table = haptics::force_table_path(name); !table.empty()) return add_output("--device", table);
  const std::size_t colon = name.find(':');
  if (colon != std::string::npos) add_input(name.substr(colon + 1));
}

void IoConflictChecker::add_input_folder(const std::string& folder) {
  std::error_code code;
  if (folder.empty()) return;
  for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
    if (it->is_regular_file(code)) add_input(it->path().string());
}

void IoConflictChecker::add_output(const std::string& option, const std::string& path) { outputs_.push_back({option, path}); }

Outcome IoConflictChecker::check(bool keeps_scene) const {
  CATENA_CHECK(check_outputs(outputs_, inputs_));
  std::vector<const PlannedOutput*> there;
  for (const PlannedOutput& output : outputs_)
    if (find_file_id(output.path)) there.push_back(&output);
  std::vector<FileId> files;
  for (const std::string& input : inputs_) {
    if (!keeps_scene || !is_scene_file(input))
      if (const auto id = find_file_id(input)) files.push_back(*id);
    // finding the companion files is slow: only if an existing file could be overwritten
    if (there.empty() || !field::has_companion_files(input)) continue;
    const std::vector<FileId> parts = field::find_data_files(input);
    for (const PlannedOutput* output : there)
      if (std::ranges::find(parts, *find_file_id(output->path)) != parts.end())
        return Error{output->path + ": is also an input, a part of " + input + "; another name for the output was expected"};
  }
  register_inputs(files);
  return Done{};
}

}  // namespace catena::app
