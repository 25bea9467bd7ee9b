#include "engine/app/serve/served_recording.h"

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "engine/app/viewer/shell/scene_files.h"

namespace catena::app {

namespace fs = std::filesystem;

ServedRecording::~ServedRecording() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

Outcome ServedRecording::begin(const SceneHost& scene, HandHost& hand) {
  CATENA_CHECK(end(hand));
  std::error_code error;
  if (folder_.empty()) {
    std::string pattern = fs::temp_directory_path(error).string() + "/catena-serve-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) return Error{pattern + ": cannot be made: " + std::generic_category().message(errno), true};
    folder_ = pattern;
  }
  if (!name_.empty()) fs::remove(path(), error);
  name_.clear();
  ++count_;
  return hand.record(folder_ + "/recording-" + std::to_string(count_) + ".catlog", recorded(scene, hand));
}

Outcome ServedRecording::end(HandHost& hand) {
  const std::string path = hand.recording().path();
  if (!hand.recording().running()) return Done{};
  CATENA_CHECK(hand.stop_recording());
  name_ = fs::path(path).filename().string();
  return Done{};
}

bool ServedRecording::is_over(const HandHost& hand) const {
  return hand.recording().running() && (hand.recording().failed() || hand.recording().status().bytes > kMostBytes);
}

}  // namespace catena::app
