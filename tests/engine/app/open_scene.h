/// A scene from its text, open for editing as the window has it.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "engine/app/viewer/shell/scene_host.h"
#include "tests/support/support.h"

namespace catena::test {

/// Written into the folder as scene.json.
inline void open_scene(const TemporaryFolder& folder, const std::string& text, std::optional<app::SceneHost>& host) {
  write_file(folder / "scene.json", text);
  auto document = scene::Document::open(folder / "scene.json");
  ASSERT_TRUE(document) << document.error().message;
  auto opened = app::SceneHost::open(std::move(*document), {});
  ASSERT_TRUE(opened) << opened.error().message;
  host.emplace(std::move(*opened));
}

}  // namespace catena::test
