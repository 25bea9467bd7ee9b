/// Gui is Dear ImGui on the window: events go in, triangles come out. Nothing else but the panels includes ImGui. Frame thread; one at a
/// time.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "engine/app/viewer/window/window.h"
#include "engine/base/result.h"
#include "render/frame/overlay_items.h"

namespace catena::app {

class Gui {
 public:
  static constexpr float kTextPixels = 15;  ///< height of the panels' text

  /// `text_pixels`: of further heights of text beside that; ImGui has them in its list of fonts, in this order. Without an installed font
  /// ImGui's own is taken.
  explicit Gui(Window& window, const std::vector<float>& text_pixels = {});
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// What a frame of the interface is made of: the panels, and after each frame what they asked for.
  struct Frame {
    std::function<void()> draw_panels, run_commands;
  };
  /// Between the two the panels are made, once for what is shown.
  void begin();
  render::UiItems end();
  /// Another pointer than the window's, at a place of the window, for the next frame that is shown: a controller that points at a panel.
  void set_virtual_pointer(double x, double y, bool pressed);
  /// Tells the beginning of a piece of input, a button or a stroke, and makes frames that nobody sees wherever it must be read apart from
  /// what was told before: however long a picture takes, each press, release and character counts, in order, with the pointer and the
  /// modifiers as they were. Not between begin() and end().
  void feed_input(const Input& piece, const Frame& frame);
  /// What was just done may open something: the next stroke is told once it is there.
  void expect_focus_change();

  /// Something of the interface lay at this place of the window in the last frame (window coordinates).
  bool covers(double x, double y) const;
  /// Keys are text now.
  bool wants_text_input() const;
  /// What is open above the panels (a menu, a list to choose from, a dialog) closes; false: nothing is. Not between begin() and end().
  bool close_popup();
  /// The pointer is not shown over the window, for this frame.
  void hide_pointer();
  /// Something of it is being held, typed into, or open above all.
  bool is_busy() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
