/// "--record FILE": every tick of a session, written beside the servo. Frame side.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/app/hand/open_hand.h"
#include "haptics/servo/log/writer.h"

namespace catena::app {

class Recording {
 public:
  /// Nothing is recorded where `path` is empty. `program`: that with which the servo begins.
  static Result<Recording> open(const std::string& path, const scene::Scene& scene, const std::vector<std::string>& field_options,
                                const OpenHand& hand, const haptics::Program& program);
  /// For ServoOptions::sink; nullptr: none.
  haptics::TickSink* sink() const { return writer_.get(); }
  bool failed() const { return writer_ && writer_->status().failed; }
  /// After the servo has stopped.
  Outcome finish();

 private:
  std::unique_ptr<haptics::log::LogWriter> writer_;
};

}  // namespace catena::app
