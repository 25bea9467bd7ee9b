/// Dear ImGui on the window: events in, triangles out. Nothing else in the house but the panels includes it. Frame thread; one at a time.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "engine/app/viewer/window.h"
#include "engine/base/result.h"
#include "render/frame/ui_items.h"

namespace catena::app {

class Gui {
 public:
  /// Without an installed font ImGui's own is taken.
  explicit Gui(Window& window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Between the two the panels are made.
  void begin();
  render::UiItems end();
  /// What the pointer did since the last frame, piece by piece, however long that frame took: `make_panels` is called for every press and
  /// release in between, with the pointer where it was then. Before begin().
  void catch_up(const std::vector<Input>& pieces, const std::function<void()>& make_panels);

  /// Something of the interface lay at this place of the window in the last frame (window coordinates).
  bool holds(double x, double y) const;
  /// Keys are text now.
  bool wants_keys() const;
  /// The pointer is not shown over the window, for this frame.
  void hide_pointer();
  /// Something of it is being held, typed into, or open above all.
  bool is_busy() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace catena::app
