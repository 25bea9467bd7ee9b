// SPDX-License-Identifier: MIT
/// A scene from a text, open for editing as in the window.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

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

}  // namespace catena::test
