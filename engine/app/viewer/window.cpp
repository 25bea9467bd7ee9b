#include "engine/app/viewer/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

namespace catena::app {

namespace {

std::string& last_error() {
  static std::string text;
  return text;
}

}  // namespace

struct Window::Parts {
  GLFWwindow* window = nullptr;
  Input input;                  ///< gathered since the last poll
  double last_x = 0, last_y = 0;
  bool has_last = false;

  ~Parts() {
    if (window != nullptr) glfwDestroyWindow(window);
    glfwTerminate();
  }
};

Result<std::unique_ptr<Window>> Window::create(std::uint32_t width, std::uint32_t height, const std::string& title) {
  const std::string advice = "; `catena render SCENE -o FILE.png` makes pictures without a window";
  glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
  if (glfwInit() != GLFW_TRUE) return Error{"no display: " + last_error() + advice};
  std::unique_ptr<Window> result(new Window);
  result->parts_ = std::make_unique<Parts>();
  Parts& parts = *result->parts_;
  if (glfwVulkanSupported() != GLFW_TRUE) return Error{"no Vulkan driver that can draw in a window was found" + advice};
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  parts.window = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(), nullptr, nullptr);
  if (parts.window == nullptr) return Error{"no display: " + last_error() + advice};

  glfwSetWindowUserPointer(parts.window, &parts);
  glfwSetCursorPosCallback(parts.window, [](GLFWwindow* w, double x, double y) {
    Parts& p = *static_cast<Parts*>(glfwGetWindowUserPointer(w));
    if (p.has_last) {
      p.input.dx += x - p.last_x;
      p.input.dy += y - p.last_y;
    }
    p.last_x = x;
    p.last_y = y;
    p.has_last = true;
  });
  // what moves while the pointer is away does not count
  glfwSetCursorEnterCallback(parts.window, [](GLFWwindow* w, int inside) {
    Parts& p = *static_cast<Parts*>(glfwGetWindowUserPointer(w));
    if (inside == GLFW_FALSE && glfwGetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_RELEASE) p.has_last = false;
  });
  glfwSetScrollCallback(parts.window, [](GLFWwindow* w, double, double y) {
    static_cast<Parts*>(glfwGetWindowUserPointer(w))->input.wheel += y;
  });
  glfwSetKeyCallback(parts.window, [](GLFWwindow* w, int key, int, int action, int) {
    Input& input = static_cast<Parts*>(glfwGetWindowUserPointer(w))->input;
    if (action != GLFW_PRESS) return;
    if (key == GLFW_KEY_H) input.toggle_hand = true;
    if (key == GLFW_KEY_R) input.reset_view = true;
    if (key == GLFW_KEY_F1) input.help = true;
    if (key == GLFW_KEY_ESCAPE || key == GLFW_KEY_Q) input.quit = true;
  });
  glfwSetWindowRefreshCallback(parts.window,
                               [](GLFWwindow* w) { static_cast<Parts*>(glfwGetWindowUserPointer(w))->input.damaged = true; });
  glfwSetCharCallback(parts.window, [](GLFWwindow* w, unsigned int c) {
    if (c == '?') static_cast<Parts*>(glfwGetWindowUserPointer(w))->input.help = true;
  });
  return result;
}

Window::~Window() = default;

render::vk::SurfaceFactory Window::surface_factory() const {
  render::vk::SurfaceFactory factory;
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names != nullptr) factory.instance_extensions.assign(names, names + count);
  factory.create = [window = parts_->window](VkInstance instance, VkSurfaceKHR* surface) {
    return glfwCreateWindowSurface(instance, window, nullptr, surface);
  };
  return factory;
}

Input Window::poll(double wait_s) {
  Parts& parts = *parts_;
  parts.input = Input();
  wait_s > 0 ? glfwWaitEventsTimeout(wait_s) : glfwPollEvents();

  Input& input = parts.input;
  GLFWwindow* w = parts.window;
  const auto button = [&](int b) { return glfwGetMouseButton(w, b) == GLFW_PRESS; };
  const auto key = [&](int k) { return glfwGetKey(w, k) == GLFW_PRESS; };
  input.left = button(GLFW_MOUSE_BUTTON_LEFT);
  input.middle = button(GLFW_MOUSE_BUTTON_MIDDLE);
  input.right = button(GLFW_MOUSE_BUTTON_RIGHT);
  input.shift = key(GLFW_KEY_LEFT_SHIFT) || key(GLFW_KEY_RIGHT_SHIFT);
  input.control = key(GLFW_KEY_LEFT_CONTROL) || key(GLFW_KEY_RIGHT_CONTROL);
  input.space = key(GLFW_KEY_SPACE);
  int width = 1, height = 1;
  glfwGetWindowSize(w, &width, &height);
  input.width = width > 0 ? width : 1;
  input.height = height > 0 ? height : 1;
  return input;
}

bool Window::closing() const { return glfwWindowShouldClose(parts_->window) == GLFW_TRUE; }

void Window::framebuffer_size(std::uint32_t& width, std::uint32_t& height) const {
  int w = 0, h = 0;
  glfwGetFramebufferSize(parts_->window, &w, &h);
  const bool minimised = glfwGetWindowAttrib(parts_->window, GLFW_ICONIFIED) == GLFW_TRUE || w <= 0 || h <= 0;
  width = minimised ? 0 : static_cast<std::uint32_t>(w);
  height = minimised ? 0 : static_cast<std::uint32_t>(h);
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(parts_->window, title.c_str()); }

}  // namespace catena::app
