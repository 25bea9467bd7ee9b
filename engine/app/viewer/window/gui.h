// SPDX-License-Identifier: MIT
/// The GUI (Dear ImGui): takes input events, produces triangles. Only this file's implementation and the panels include ImGui. Frame
/// thread; one instance at a time.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "engine/app/viewer/window/window.h"
#include "engine/base/result.h"
#include "render/frame/overlay_items.h"

namespace catena::app {

/// Owns the ImGui context.
class Gui {
 public:
  static constexpr float kTextPixels = 15;  ///< Height of the panels' text.

  /// `text_pixels`: additional text heights; their fonts follow the panels' font in ImGui's font list, in this order. If no font is
  /// installed, ImGui's built-in font is used.
  explicit Gui(Window& window, const std::vector<float>& text_pixels = {});
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// The parts of one GUI frame: drawing the panels, then executing the commands they issued.
  struct Frame {
    std::function<void()> draw_panels, run_commands;
  };
  /// Begin and end a visible GUI frame; the panels are drawn in between. end() returns the triangles.
  void begin();
  render::UiItems end();
  /// Replaces the window's pointer in the next visible frame by one at a position of the window, for an XR controller pointing at the XR
  /// panel.
  void set_virtual_pointer(double x, double y, bool pressed);
  /// Sends the event at the beginning of an input segment, a mouse button or key event, to the GUI. Hidden GUI frames are run wherever it
  /// must be separated from earlier events, so that at any frame rate every press, release and character counts, in order, with the pointer
  /// and modifiers of its time. Not between begin() and end().
  void feed_input(const Input& piece, const Frame& frame);
  /// Call when an action may have opened something that takes the focus: the next key press is sent only after it has appeared.
  void expect_focus_change();

  /// Returns whether the GUI covers this position in the last frame (window coordinates).
  bool covers(double x, double y) const;
  /// Returns whether key presses are text input for the GUI.
  bool wants_text_input() const;
  /// Closes the topmost popup (menu, list, dialog); returns false if there is none. Not between begin() and end().
  bool close_popup();
  /// Hides the pointer over the window for this frame.
  void hide_pointer();
  /// Shows a hand as the pointer in this frame.
  void show_hand_pointer();
  /// Returns whether a widget of the GUI is active or takes text input.
  bool is_busy() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
