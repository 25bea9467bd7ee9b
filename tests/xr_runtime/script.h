// SPDX-License-Identifier: MIT
/// An OpenXR runtime for tests, loaded by the real loader. Its script and its record are plain data in the library, shared with the tests
/// of one process by catena_xr_stage(). Separate programs are scripted by the environment variable CATENA_XR_SCRIPT:
///   words separated by spaces: fail=xrEndFrame:3:-17 (result of the third call), size=64x48, period_ms=11, state=40:VISIBLE (posted
///   before frame 40), record=FILE (counts, written at exit), without=XR_KHR_composition_layer_depth, with=XR_KHR_visibility_mask,
///   menu=5:9 (the right hand's button is down from frame 5 to 8), gaze=0.2:-0.1 (tangents of the gaze to the right and up),
///   head=1:0:-2 (offset of the head, metres), stage=x:y:z (in the local space), grip=40:x:y:z (the right hand, from that frame on),
///   select=50:70 (its trigger is down in these frames), paced (xrWaitFrame sleeps),
///   hang=20:3000 (duration of that frame's xrWaitFrame in milliseconds)
/// One lock guards everything; tests write between calls.
#pragma once
#include <vulkan/vulkan.h>

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace catena::test::xr_runtime {

struct ScriptedFailure {
  int at = 1;  ///< number of the failing call, from 1
  XrResult result = XR_ERROR_RUNTIME_FAILURE;
};

/// State of a hand: 0 left, 1 right.
struct ScriptedHand {
  bool active = true;
  XrPosef grip{{0, 0, 0, 1}, {0, 0, 0}}, aim{{0, 0, 0, 1}, {0, 0, 0}};
  float select = 0, squeeze = 0;
  XrVector2f stick{0, 0};
  bool menu = false;
};

struct Script {
  std::vector<XrView> views;  ///< in the local space; reset() sets two, canted and asymmetric
  std::uint32_t width = 96, height = 80;
  std::int64_t period_ns = 11'111'111;
  std::optional<std::int64_t> reported_period_ns;  ///< reported display period, if it differs from `period_ns`
  XrPosef stage{{0, 0, 0, 1}, {0, 0, 0}};          ///< stage space in the local space
  bool sleeps_in_wait = false;
  bool focus = true;  ///< true: the session becomes visible and focused after the first frame
  bool tracked = true;
  std::vector<std::int64_t> formats{VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_D32_SFLOAT};
  std::set<std::string> unsupported;                ///< extensions and spaces ("stage") that are not offered; initially visibility masks
  std::vector<XrSessionState> after_end;            ///< posted after the next xrEndSession
  std::map<std::string, ScriptedFailure> failures;  ///< by function name, such as "xrEndFrame"
  std::multimap<std::uint64_t, XrSessionState> states;         ///< posted before that frame's wait, independent of the state graph
  std::multimap<std::uint64_t, XrEventDataBuffer> events;      ///< other events posted before that frame's wait
  std::function<void(std::uint64_t frame, Script&)> on_frame;  ///< called before the wait of each frame
  ScriptedHand hands[2];
  std::optional<XrPosef> gaze;  ///< pose of the eyes; empty: not tracked
  bool supports_gaze = true;    ///< true: the headset supports eye tracking
  std::string profile = "/interaction_profiles/khr/simple_controller";
  std::map<std::uint64_t, XrVector3f> grip_path;                       ///< position of the right hand from that frame on
  std::vector<std::pair<std::uint64_t, std::uint64_t>> select_frames;  ///< frames in which its trigger is down: from, to
  std::uint64_t menu_from = 0, menu_to = 0;                            ///< frames in which the right hand's button is down
  std::optional<std::pair<std::uint64_t, std::int64_t>> slow_wait;     ///< frame, and duration of its xrWaitFrame in ns
  bool capture_images = false;
  std::uint32_t images = 3;  ///< images per swapchain
};

struct CapturedImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  std::vector<float> depth;  ///< depth image, if submitted
  float near_z = 0, far_z = 0, min_depth = 0, max_depth = 0;
  XrPosef pose{};
  XrFovf fov{};
};

struct Vibration {
  int hand = 0;
  bool stop = false;
  float amplitude = 0, frequency = 0;
  std::int64_t duration = 0;
  std::uint64_t frame = 0;
};

struct Record {
  std::map<std::string, std::uint64_t> calls;
  std::vector<std::string> illegal;     ///< calls refused because of their order or arguments
  std::uint64_t frames = 0;             ///< number of ended frames
  std::uint64_t projection_frames = 0;  ///< number of frames with a projection layer
  std::uint64_t quads = 0, depths = 0;
  std::uint64_t moved_poses = 0;                ///< number of submitted views that differ from those located for the frame
  std::vector<CapturedImage> last_images;       ///< last image by view; with capture_images
  std::vector<CapturedImage> last_quad_images;  ///< last images of quad layers; with capture_images
  std::vector<Vibration> vibrations;
  std::vector<XrSessionState> states;  ///< posted states
  std::uint64_t objects = 0;           ///< number of existing objects
};

struct SharedState {
  Script script;
  Record record;
};

}  // namespace catena::test::xr_runtime

extern "C" {
/// Script and record of the library that the loader has loaded; its path is CATENA_XR_RUNTIME_LIBRARY of the build.
catena::test::xr_runtime::SharedState* catena_xr_stage();
/// Resets script and record; no objects may exist.
void catena_xr_reset();
}
