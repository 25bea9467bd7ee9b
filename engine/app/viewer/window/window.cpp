// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <array>
#include <utility>

namespace catena::app {

namespace {

std::string& last_error() {
  static std::string text;
  return text;
}

}  // namespace

struct Window::Impl {
  GLFWwindow* window = nullptr;
  std::vector<Input> done;  ///< complete segments since the last poll
  Input current;
  double last_x = 0, last_y = 0;
  bool has_last = false;
  bool happened = false;
  bool gui = false;
  std::array<int, 4> place{};  ///< window position and size before full screen: x, y, width, height

  ~Impl() {
    if (window != nullptr) glfwDestroyWindow(window);
    glfwTerminate();
  }

  /// Ends the current input segment.
  void cut() {
    done.push_back(current);
    Input next;
    next.left = current.left;
    next.middle = current.middle;
    next.right = current.right;
    next.shift = current.shift;
    next.control = current.control;
    next.space = current.space;
    next.x = last_x;
    next.y = last_y;
    current = next;
  }
  void hold(bool Input::*what, bool held) {
    happened = true;
    if (current.*what == held) return;
    cut();
    current.*what = held;
  }
  /// Starts the next segment with a key press.
  void stroke(const KeyEvent& event) {
    happened = true;
    cut();
    current.key_event = event;
  }
};

Result<std::unique_ptr<Window>> Window::create(std::uint32_t width, std::uint32_t height, const std::string& title) {
  const std::string advice = "; `catena render SCENE -o FILE.png` renders an image without a window";
  glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
  if (glfwInit() != GLFW_TRUE) return Error{"no display was found: " + last_error() + advice};
  std::unique_ptr<Window> result(new Window);
  result->impl_ = std::make_unique<Impl>();
  Impl& parts = *result->impl_;
  if (glfwVulkanSupported() != GLFW_TRUE) return Error{"no Vulkan driver that can render to a window was found" + advice};
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  parts.window = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(), nullptr, nullptr);
  if (parts.window == nullptr) return Error{"no display was found: " + last_error() + advice};

  glfwSetWindowUserPointer(parts.window, &parts);
  glfwSetCursorPosCallback(parts.window, [](GLFWwindow* w, double x, double y) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    p.happened = true;
    if (p.has_last) {
      p.current.dx += x - p.last_x;
      p.current.dy += y - p.last_y;
    }
    p.last_x = x;
    p.last_y = y;
    p.has_last = true;
  });
  // motion while the pointer is outside does not count
  glfwSetCursorEnterCallback(parts.window, [](GLFWwindow* w, int inside) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    p.happened = true;
    if (p.gui) ImGui_ImplGlfw_CursorEnterCallback(w, inside);
    const bool dragging = p.current.left || p.current.middle || p.current.right;
    if (inside == GLFW_FALSE && !dragging) p.has_last = false;
  });
  glfwSetWindowFocusCallback(parts.window, [](GLFWwindow* w, int focused) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    KeyEvent event;
    event.type = focused == GLFW_TRUE ? KeyEvent::Type::focus_gained : KeyEvent::Type::focus_lost;
    p.stroke(event);
  });
  glfwSetDropCallback(parts.window, [](GLFWwindow* w, int count, const char** paths) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    p.happened = true;
    p.current.dropped_files.insert(p.current.dropped_files.end(), paths, paths + count);
  });
  glfwSetMouseButtonCallback(parts.window, [](GLFWwindow* w, int button, int action, int) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    if (button == GLFW_MOUSE_BUTTON_LEFT) p.hold(&Input::left, action == GLFW_PRESS);
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) p.hold(&Input::middle, action == GLFW_PRESS);
    if (button == GLFW_MOUSE_BUTTON_RIGHT) p.hold(&Input::right, action == GLFW_PRESS);
  });
  glfwSetScrollCallback(parts.window, [](GLFWwindow* w, double x, double y) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    p.happened = true;
    p.current.wheel += y;
    if (p.gui) ImGui_ImplGlfw_ScrollCallback(w, x, y);
  });
  glfwSetKeyCallback(parts.window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
    Impl& p = *static_cast<Impl*>(glfwGetWindowUserPointer(w));
    const bool held = action != GLFW_RELEASE;
    KeyEvent event;
    event.type = action == GLFW_PRESS ? KeyEvent::Type::press : held ? KeyEvent::Type::repeat : KeyEvent::Type::release;
    event.key = key;
    event.scancode = scancode;
    event.shift = (mods & GLFW_MOD_SHIFT) != 0;
    event.control = (mods & GLFW_MOD_CONTROL) != 0;
    event.alt = (mods & GLFW_MOD_ALT) != 0;
    p.stroke(event);
    if (key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT) p.current.shift = held;
    if (key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL) p.current.control = held;
    if (key == GLFW_KEY_SPACE) p.current.space = held;
  });
  glfwSetCharCallback(parts.window, [](GLFWwindow* w, unsigned int c) {
    KeyEvent event;
    event.type = KeyEvent::Type::character;
    event.character = c;
    static_cast<Impl*>(glfwGetWindowUserPointer(w))->stroke(event);
  });
  glfwSetWindowRefreshCallback(parts.window,
                               [](GLFWwindow* w) { static_cast<Impl*>(glfwGetWindowUserPointer(w))->current.needs_redraw = true; });
  return result;
}

Window::~Window() = default;

render::vk::SurfaceFactory Window::surface_factory() const {
  render::vk::SurfaceFactory factory;
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names != nullptr) factory.instance_extensions.assign(names, names + count);
  factory.create = [window = impl_->window](VkInstance instance, VkSurfaceKHR* surface) {
    return glfwCreateWindowSurface(instance, window, nullptr, surface);
  };
  return factory;
}

std::vector<Input> Window::poll(double wait_s) {
  impl_->happened = false;
  wait_s > 0 ? glfwWaitEventsTimeout(wait_s) : glfwPollEvents();
  Impl& parts = *impl_;
  parts.cut();
  std::vector<Input> pieces = std::move(parts.done);
  parts.done.clear();
  int width = 1, height = 1;
  glfwGetWindowSize(parts.window, &width, &height);
  for (Input& input : pieces) {
    input.width = width > 0 ? width : 1;
    input.height = height > 0 ? height : 1;
  }
  return pieces;
}

bool Window::had_events() const { return impl_->happened; }

float Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(impl_->window, &x, &y);
  return x > 0.5f && x < 8 ? x : 1;
}

void Window::forward_events_to_gui(bool on) { impl_->gui = on; }

GLFWwindow* Window::glfw_window() const { return impl_->window; }

bool Window::is_closing() const { return glfwWindowShouldClose(impl_->window) == GLFW_TRUE; }

bool Window::has_focus_or_pointer() const {
  const auto is = [&](int what) { return glfwGetWindowAttrib(impl_->window, what) == GLFW_TRUE; };
  return !is(GLFW_ICONIFIED) && (is(GLFW_FOCUSED) || is(GLFW_HOVERED));
}

void Window::framebuffer_size(std::uint32_t& width, std::uint32_t& height) const {
  int w = 0, h = 0;
  glfwGetFramebufferSize(impl_->window, &w, &h);
  const bool minimised = glfwGetWindowAttrib(impl_->window, GLFW_ICONIFIED) == GLFW_TRUE || w <= 0 || h <= 0;
  width = minimised ? 0 : static_cast<std::uint32_t>(w);
  height = minimised ? 0 : static_cast<std::uint32_t>(h);
}

void Window::cancel_close() { glfwSetWindowShouldClose(impl_->window, GLFW_FALSE); }

void Window::size(double& width, double& height) const {
  int w = 1, h = 1;
  glfwGetWindowSize(impl_->window, &w, &h);
  width = std::max(1, w);
  height = std::max(1, h);
}

bool Window::is_fullscreen() const { return glfwGetWindowMonitor(impl_->window) != nullptr; }

void Window::set_fullscreen(bool on) {
  if (on == is_fullscreen()) return;
  auto& [x, y, width, height] = impl_->place;
  if (!on) {
    glfwSetWindowMonitor(impl_->window, nullptr, x, y, width, height, GLFW_DONT_CARE);
    return;
  }
  glfwGetWindowPos(impl_->window, &x, &y);
  glfwGetWindowSize(impl_->window, &width, &height);
  // the monitor that holds most of the window
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = nullptr;
  long maximum = -1;
  for (int i = 0; i < count; ++i) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr) continue;
    int mx = 0, my = 0;
    glfwGetMonitorPos(monitors[i], &mx, &my);
    const long w = std::max(0, std::min(x + width, mx + mode->width) - std::max(x, mx));
    const long h = std::max(0, std::min(y + height, my + mode->height) - std::max(y, my));
    if (w * h <= maximum) continue;
    maximum = w * h;
    best = monitors[i];
  }
  if (best == nullptr) return;
  const GLFWvidmode* mode = glfwGetVideoMode(best);
  glfwSetWindowMonitor(impl_->window, best, 0, 0, mode->width, mode->height, mode->refreshRate);
}

FlyKeys Window::held_fly_keys() const {
  const auto held = [&](int a, int b) { return glfwGetKey(impl_->window, a) == GLFW_PRESS || glfwGetKey(impl_->window, b) == GLFW_PRESS; };
  if (held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL)) return {};
  FlyKeys keys;
  keys.forward = held(GLFW_KEY_W, GLFW_KEY_UP);
  keys.back = held(GLFW_KEY_S, GLFW_KEY_DOWN);
  keys.left = held(GLFW_KEY_A, GLFW_KEY_LEFT);
  keys.right = held(GLFW_KEY_D, GLFW_KEY_RIGHT);
  keys.up = held(GLFW_KEY_E, GLFW_KEY_PAGE_UP);
  keys.down = held(GLFW_KEY_Q, GLFW_KEY_PAGE_DOWN);
  keys.fast = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  return keys;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(impl_->window, title.c_str()); }

}  // namespace catena::app
