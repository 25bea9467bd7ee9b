/// FrustumWindow is a window by GLFW: it gives input as plain data, and the factory of its Vulkan surface. GLFW's functions are called here
/// and by ImGui's backend (gui.cpp) alone. Frame thread (the process's main thread) only.
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

class Window {
 public:
  /// No display, or no Vulkan on it: an error in one sentence.
  static Result<std::unique_ptr<Window>> create(std::uint32_t width, std::uint32_t height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  render::vk::SurfaceFactory surface_factory() const;
  /// Takes what happened since the last call; waits up to `wait_s` for something to happen (0: not at all). In pieces, in order, cut at
  /// every stroke, button and change of the focus: what was done within one slow picture counts as it was done. At least one.
  std::vector<Input> poll(double wait_s);
  bool is_closing() const;
  /// The person was asked and stays.
  void cancel_close();
  /// Anything at all happened in the last poll (a pointer that moved, a key).
  bool had_events() const;
  /// It has the keyboard or the pointer: somebody is likely to look at it.
  bool has_focus_or_pointer() const;
  /// Of the picture, in pixels; 0 while minimised.
  void framebuffer_size(std::uint32_t& width, std::uint32_t& height) const;
  /// Of the window, in window coordinates.
  void size(double& width, double& height) const;
  void set_title(const std::string& title);
  void set_fullscreen(bool on);
  bool is_fullscreen() const;

  /// The keys of flight that are down.
  FlyKeys held_fly_keys() const;

  /// Pixels by the size that interfaces are designed for.
  float content_scale() const;
  /// The pointer's coming and going and the wheel go to the user interface (gui.h) as well.
  void forward_events_to_gui(bool on);
  GLFWwindow* glfw_window() const;

 private:
  Window() = default;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::app
