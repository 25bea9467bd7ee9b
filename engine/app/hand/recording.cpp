#include "engine/app/hand/recording.h"

#include "engine/app/command.h"
#include "engine/app/log_scene.h"

namespace catena::app {

Result<Recording> Recording::open(const std::string& path, const scene::Scene& scene, const std::vector<std::string>& field_options,
                                  const OpenHand& hand, const haptics::Program& program) {
  Recording recording;
  if (path.empty()) return recording;
  if (!is_scene_file(scene.path)) return Error{path + ": only what is felt of a scene file (.json) can be recorded"};
  CATENA_TRY(haptics::log::LogHeader header,
             log_header(scene.path, field_options, hand.device->capabilities().name, hand.settings.rate_hz));
  CATENA_TRY(recording.writer_, haptics::log::LogWriter::open(path, std::move(header), inputs_of(scene)));
  recording.writer_->add_program(program);
  return recording;
}

Outcome Recording::finish() {
  if (!writer_) return Done{};
  return writer_->finish();
}

}  // namespace catena::app
