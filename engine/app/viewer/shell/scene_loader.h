/// SceneLoader opens a scene or a data file beside the window: it reads it, loads what it draws and feels, and makes its first packet. The
/// window goes on meanwhile. One at a time; what is under way when the loader goes is waited for.
#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "engine/app/viewer/shell/scene_host.h"
#include "engine/base/result.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

struct LoadedScene {
  SceneHost host;
  render::FramePacket packet;  ///< of the size asked for
  Bounds bounds;               ///< of all that is drawn and felt
};

/// The work itself; any thread, the scene is its own. Errors: one line.
Result<LoadedScene> load_scene(SceneHost host, std::uint32_t width, std::uint32_t height);

class SceneLoader {
 public:
  /// Not while one is under way.
  void start(const std::string& path, std::uint32_t width, std::uint32_t height);
  /// The path that is being opened; empty: none.
  const std::string& path() const { return path_; }
  bool is_busy() const { return !path_.empty(); }
  /// What came of it, once.
  std::optional<Result<LoadedScene>> take();

 private:
  std::string path_;
  std::optional<Result<LoadedScene>> loaded_;
  std::atomic<bool> done_{false};
  std::jthread thread_;  ///< last: it is joined before what it writes goes
};

}  // namespace catena::app
