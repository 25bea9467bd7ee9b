// SPDX-License-Identifier: MIT
/// Internals of the runtime: objects by handle, and the prologue of every entry: lock, call count, scripted failure.
#pragma once
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "tests/xr_runtime/script.h"

namespace catena::test::xr_runtime {

enum class Kind { instance, session, space, swapchain, action_set, action };

struct Object {
  Kind kind;
  std::uint64_t parent = 0;
  virtual ~Object() = default;
  explicit Object(Kind k, std::uint64_t p = 0) : kind(k), parent(p) {}
};

struct InstanceObject : Object {
  InstanceObject() : Object(Kind::instance) {}
  std::set<std::string> extensions;
  std::deque<XrEventDataBuffer> events;
  std::vector<std::string> paths{""};                                                  ///< path strings by XrPath
  std::map<std::string, std::map<std::uint64_t, std::vector<std::string>>> suggested;  ///< binding paths by profile and action
  bool requirements_queried = false;
};

struct SessionObject : Object {
  explicit SessionObject(std::uint64_t p) : Object(Kind::session, p) {}
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  bool running = false, waited = false, begun = false, exit_requested = false, has_shown_frame = false, synced = false;
  std::uint64_t frame = 0;  ///< number of waited frames
  XrTime time = 0, last_ended = 0;
  std::vector<XrView> located;  ///< views located for `time`
  std::vector<std::uint64_t> action_sets;
};

struct SpaceObject : Object {
  explicit SpaceObject(std::uint64_t p) : Object(Kind::space, p) {}
  XrReferenceSpaceType reference = XR_REFERENCE_SPACE_TYPE_LOCAL;
  std::uint64_t action = 0;  ///< action of the space; 0: a reference space
  int hand = 0;
  XrPosef offset{{0, 0, 0, 1}, {0, 0, 0}};
};

struct SwapchainObject : Object {
  explicit SwapchainObject(std::uint64_t p) : Object(Kind::swapchain, p) {}
  ~SwapchainObject() override;
  VkDevice device = VK_NULL_HANDLE;
  XrSwapchainCreateInfo info{};
  std::vector<VkImage> images;
  std::vector<VkDeviceMemory> memory;
  std::deque<std::uint32_t> acquired;
  bool waited = false;  ///< true: the first acquired image was waited for
  std::uint32_t next = 0;
  std::optional<std::uint32_t> released;  ///< index of the last released image
  bool is_depth() const { return info.format == VK_FORMAT_D32_SFLOAT; }
};

struct ActionSetObject : Object {
  explicit ActionSetObject(std::uint64_t p) : Object(Kind::action_set, p) {}
  bool attached = false;
};

struct ActionObject : Object {
  explicit ActionObject(std::uint64_t p) : Object(Kind::action, p) {}
  std::string name;
  XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
};

struct RuntimeState {
  std::mutex lock;
  SharedState shared;
  std::unordered_map<std::uint64_t, std::unique_ptr<Object>> objects;
  std::uint64_t last_handle = 0x1000;

  template <class T>
  T* find(std::uint64_t handle, Kind kind) {
    const auto it = objects.find(handle);
    return it != objects.end() && it->second->kind == kind ? static_cast<T*>(it->second.get()) : nullptr;
  }
  std::uint64_t add(std::unique_ptr<Object> object);
  /// Removes an object with its children.
  void remove(std::uint64_t handle);
};
RuntimeState& world();

template <class Handle>
std::uint64_t number(Handle handle) {
  return reinterpret_cast<std::uint64_t>(handle);
}
template <class Handle>
Handle as_handle(std::uint64_t n) {
  return reinterpret_cast<Handle>(n);
}

/// Scripted result of this call, or empty.
std::optional<XrResult> enter(const char* function);
/// Records an illegal call and returns the result.
XrResult illegal(const char* function, XrResult result, const std::string& why);
void post_state(std::uint64_t session, SessionObject& of, XrSessionState state);
void read_environment();

XrTime clock_now();

/// Fills a list of OpenXR's two-call idiom.
template <class T, class U>
XrResult fill(const std::vector<T>& all, std::uint32_t capacity, std::uint32_t* count, U* out) {
  *count = std::uint32_t(all.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  for (std::size_t i = 0; i < all.size(); ++i) out[i] = all[i];
  return XR_SUCCESS;
}

/// Reads a swapchain image back to the host: RGBA bytes, or depth floats.
void read_back(SessionObject& session, SwapchainObject& swapchain, const XrRect2Di& rect, CapturedImage& captured);

// functions of each file, by name
PFN_xrVoidFunction find_session_function(const std::string& name);
PFN_xrVoidFunction find_swapchain_function(const std::string& name);
PFN_xrVoidFunction find_action_function(const std::string& name);

}  // namespace catena::test::xr_runtime

/// Prologue of every entry: lock, call count, script.
#define ENTER(function)                      \
  const std::lock_guard guard(world().lock); \
  const char* const self = #function;        \
  (void)self;                                \
  if (const auto scripted = enter(self)) return *scripted
/// Prologue of destroy functions, which destroy the object for any scripted result.
#define ENTER_TO_DESTROY(function)           \
  const std::lock_guard guard(world().lock); \
  const char* const self = #function;        \
  const XrResult answer = enter(self).value_or(XR_SUCCESS)
#define FIND(Type, variable, handle, kind)                               \
  Type* const variable = world().find<Type>(number(handle), Kind::kind); \
  if (!variable) return illegal(self, XR_ERROR_HANDLE_INVALID, "no such " #kind)
