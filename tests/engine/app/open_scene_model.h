// SPDX-License-Identifier: MIT
/// A scene from its text, open for editing as the window has it.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/scene/scene_model.h"
#include "tests/support/support.h"

namespace catena::test {

/// ImageWriteResult into the folder as scene.json.
inline void open_scene(const TemporaryFolder& folder, const std::string& text, std::optional<app::SceneModel>& host) {
  write_file(folder / "scene.json", text);
  auto document = scene::Document::open(folder / "scene.json");
  ASSERT_TRUE(document) << document.error().message;
  auto opened = app::SceneModel::open(std::move(*document), {});
  ASSERT_TRUE(opened) << opened.error().message;
  host.emplace(std::move(*opened));
}

}  // namespace catena::test
