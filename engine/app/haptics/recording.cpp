// SPDX-License-Identifier: MIT
#include "engine/app/haptics/recording.h"

#include "engine/app/cli/command.h"
#include "engine/app/cli/plugins.h"
#include "engine/base/clock.h"

namespace catena::app {

Result<Recording> Recording::open(const std::string& path, RecordedScene scene, const HapticDeviceSetup& hand,
                                  const haptics::HapticProgram& program) {
  Recording recording;
  if (path.empty()) return recording;
  haptics::log::LogHeader header;
  header.scene_path = std::move(scene.path);
  header.scene_text = scene.text;
  header.fields = std::move(scene.field_options);
  header.about = std::move(scene.description);
  header.device = hand.device->capabilities().name;
  header.catena_version = kVersion;
  header.rate_hz = hand.settings.rate_hz;
  header.plugins = plugins_for_log();
  CATENA_TRY(recording.writer_, haptics::log::LogWriter::open(path, std::move(header), scene.input_files));
  recording.path_ = path;
  recording.text_ = std::move(scene.text);
  recording.start_ns_ = now_ns();
  recording.writer_->add_program(program);
  return recording;
}

void Recording::add_program(const haptics::HapticProgram& program, const std::string& text) {
  if (!writer_) return;
  writer_->add_program(program, text == text_ ? std::optional<std::string>() : text);
}

double Recording::seconds() const { return writer_ ? 1e-3 * ms_since(start_ns_) : 0; }

Outcome Recording::finish() {
  if (!writer_) return Done{};
  const auto writer = std::move(writer_);
  return writer->finish();
}

}  // namespace catena::app
