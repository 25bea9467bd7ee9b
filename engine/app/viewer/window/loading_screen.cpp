// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/loading_screen.h"

#include "engine/app/viewer/panels/panel.h"
#include "render/extract/extract.h"

namespace catena::app {

Outcome show_loading(Window& window, Gui& gui, Presenter& presenter, const std::string& source, const LoadWait& is_loaded) {
  constexpr double kFrameS = 0.1;
  scene::Scene empty;
  while (!is_loaded(kFrameS)) {
    window.poll(0);
    std::uint32_t width = 0, height = 0;
    presenter.size(width, height);
    if (width == 0 || height == 0) continue;
    CATENA_TRY(const render::FramePacket blank, render::make_frame(empty, width, height));
    CATENA_CHECK(presenter.draw(blank, {}));
    gui.begin();
    draw_loading(source);
    CATENA_CHECK(presenter.show(gui.end()));
  }
  return Done{};
}

void EarlyWindow::show_until(const LoadWait& is_loaded) {
  if (source.empty() || is_loaded(window ? 0 : kQuietLoadS)) return;
  if (!window) {
    auto created = Window::create(width, height, "catena");
    if (!created) return;  // reported when the scene is there
    window = std::move(*created);
  }
  Gui gui(*window);
  const auto presenter = Presenter::open(*window, {gpu_memory_bytes});
  if (presenter) static_cast<void>(show_loading(*window, gui, **presenter, source, is_loaded));
}

}  // namespace catena::app
