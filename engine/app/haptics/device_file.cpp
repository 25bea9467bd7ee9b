// SPDX-License-Identifier: MIT
#include "engine/app/haptics/device_file.h"

#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "haptics/device/device_settings.h"

namespace catena::app {
namespace {

bool is_there(const std::string& path) {
  std::error_code code;
  return !path.empty() && std::filesystem::exists(path, code);
}

}  // namespace

Outcome apply_device_file(const std::string& path, scene::Scene& scene) {
  if (!is_there(path)) return Done{};
  CATENA_TRY(json::Node device, json::read(path));
  CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(device, path));
  // relative paths are relative to this file, not to the scene
  for (auto& [key, value] : device.members)
    if (key == "firmware") value.string = std::filesystem::absolute(settings.firmware).string();
  scene.device = std::move(device);
  return Done{};
}

Outcome write_device_file(const std::string& path, const std::vector<scene::Document::Edit>& edits) {
  std::string text = "{\n}\n";
  if (is_there(path)) {
    CATENA_TRY(text, read_text_file(path, "a device's settings"));
  }
  for (const scene::Document::Edit& edit : edits) {
    if (!edit.value) continue;
    CATENA_TRY(text, json::set_value(text, path, edit.pointer, *edit.value));
  }
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(text);
  return file.commit();
}

}  // namespace catena::app
