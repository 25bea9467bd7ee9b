// SPDX-License-Identifier: MIT
/// A scene from a text, open for editing as in the window, and a haptic session without real-time settings.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "tests/support/support.h"

namespace catena::test {

/// Writes the text to scene.json in the folder, and opens the scene.
inline void open_scene(const TemporaryFolder& folder, const std::string& text, std::optional<app::SceneModel>& host) {
  write_file(folder / "scene.json", text);
  auto document = scene::Document::open(folder / "scene.json");
  ASSERT_TRUE(document) << document.error().message;
  auto opened = app::SceneModel::open(std::move(*document), {});
  ASSERT_TRUE(opened) << opened.error().message;
  host.emplace(std::move(*opened));
}

/// Options of a session with the device; "": the mouse or the scene's device.
inline app::HapticSession::Options quiet_session(const std::string& device) {
  app::HapticSession::Options options;
  if (!device.empty()) options.device = device;
  options.realtime = {.fifo = false, .lock_memory = false, .cpu = haptics::RealtimeOptions::kUnbound};
  return options;
}

/// -1 to 1 along each axis.
inline Bounds cube_bounds() {
  Bounds bounds;
  bounds.extend(Vec3(-1.0));
  bounds.extend(Vec3(1.0));
  return bounds;
}

}  // namespace catena::test
