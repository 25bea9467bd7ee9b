// SPDX-License-Identifier: MIT
/// The application window (GLFW): delivers input as plain data, and the factory of its Vulkan surface. GLFW is called only here and in
/// ImGui's backend (gui.cpp). Frame thread (the process's main thread) only.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/app/viewer/input/camera_motion.h"
#include "engine/app/viewer/input/navigation.h"
#include "engine/base/result.h"
#include "render/vk/instance.h"

struct GLFWwindow;

namespace catena::app {

/// Owns the GLFW window and its input queue.
class Window {
 public:
  /// Opens a window. An Error, one sentence, if there is no display or no Vulkan on it.
  static Result<std::unique_ptr<Window>> create(std::uint32_t width, std::uint32_t height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the factory of the Vulkan surface; the window must outlive it.
  render::vk::SurfaceFactory surface_factory() const;
  /// Returns the input since the last call; waits up to `wait_s` seconds for an event (0: no waiting). The input is split into segments, in
  /// order, at every key event, mouse button and focus change, so that everything done during one slow frame keeps its order. At least one
  /// segment.
  std::vector<Input> poll(double wait_s);
  /// Returns whether the user has requested to close the window.
  bool is_closing() const;
  /// Withdraws the request to close.
  void cancel_close();
  /// Returns whether there was any event in the last poll (pointer motion, a key, ...).
  bool had_events() const;
  /// Returns whether the window has the keyboard focus or the pointer, so that someone is probably looking at it.
  bool has_focus_or_pointer() const;
  /// Returns the size of the framebuffer in pixels; 0 while minimized.
  void framebuffer_size(std::uint32_t& width, std::uint32_t& height) const;
  /// Returns the size in window coordinates.
  void size(double& width, double& height) const;
  void set_title(const std::string& title);
  void set_fullscreen(bool on);
  bool is_fullscreen() const;

  /// Returns which fly keys are down; none while control is held.
  FlyKeys held_fly_keys() const;

  /// Returns the ratio of pixels to the resolution that GUIs are designed for.
  float content_scale() const;
  /// Enables forwarding of pointer enter/leave and wheel events to the GUI (gui.h).
  void forward_events_to_gui(bool on);
  GLFWwindow* glfw_window() const;

 private:
  Window() = default;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
