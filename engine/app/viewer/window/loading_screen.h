// SPDX-License-Identifier: MIT
/// What the window shows while the first scene is read and loaded on another thread. Frame thread.
#pragma once
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>

#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/gui.h"
#include "engine/app/viewer/window/presenter.h"
#include "engine/app/viewer/window/window.h"

namespace catena::app {

/// Time, in seconds, after which a window says what it waits for.
inline constexpr double kQuietLoadS = 1;

/// Shows what is being done (activity()) until the scene has been loaded. `source`: its path. An Error if nothing can be drawn.
Outcome show_loading(Window& window, Gui& gui, Presenter& presenter, const std::string& source, const LoadWait& is_loaded);

/// A window in which the program says what it waits for, before anything can be shown in it.
struct EarlyWindow {
  std::uint32_t width = 1024, height = 768;
  std::uint64_t gpu_memory_bytes = 0;
  std::string source;              ///< What is loaded; empty: no window is opened.
  std::shared_ptr<Window> window;  ///< Null until it is needed.

  /// Opens the window if the scene has not been loaded after kQuietLoadS, and waits for the scene.
  void show_until(const LoadWait& is_loaded);
  /// Runs `work` on another thread meanwhile, and returns its result.
  template <class Work>
  auto show_during(const Work& work) {
    auto running = std::async(std::launch::async, work);
    show_until([&](double wait_s) { return running.wait_for(std::chrono::duration<double>(wait_s)) == std::future_status::ready; });
    return running.get();
  }
};

}  // namespace catena::app
