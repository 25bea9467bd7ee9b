// SPDX-License-Identifier: MIT
/// A headset of the scripted runtime (tests/xr_runtime) behind the real loader, and a renderer on its Vulkan device: lavapipe, with the
/// validation layer.
#pragma once
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <memory>

#include "render/xr/headset.h"
#include "tests/support/support.h"
#include "tests/support/vulkan.h"
#include "tests/xr_runtime/script.h"

namespace catena::test::xr_rig {

using namespace catena::render;

/// The environment's XR_RUNTIME_JSON before the scripted runtime replaced it; empty if unset.
inline const std::string& original_runtime() {
  static const std::string path = std::getenv("XR_RUNTIME_JSON") ? std::getenv("XR_RUNTIME_JSON") : "";
  return path;
}

/// The runtime's library, opened in addition to the loader, so that its state outlives instances.
class Runtime {
 public:
  Runtime() {
    use_lavapipe();
    (void)original_runtime();
    const std::string library = binary_dir() + "/libcatena_xr_runtime.so";
    ::setenv("XR_RUNTIME_JSON", (binary_dir() + "/xr_runtime.json").c_str(), 1);
    handle_ = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle_) return;
    stage_ = reinterpret_cast<xr_runtime::SharedState* (*)()>(::dlsym(handle_, "catena_xr_stage"))();
    reset();
  }
  ~Runtime() {
    // state that would affect the process's other tests
    if (handle_) reset();
  }
  void reset() { reinterpret_cast<void (*)()>(::dlsym(handle_, "catena_xr_reset"))(); }
  bool found() const { return handle_ != nullptr; }
  xr_runtime::Script& script() { return stage_->script; }
  const xr_runtime::Record& record() const { return stage_->record; }

 private:
  void* handle_ = nullptr;
  xr_runtime::SharedState* stage_ = nullptr;
};

/// A ball of one colour, lit by the headlight.
inline FramePacket ball_packet(const Vec3& centre, double radius) {
  FramePacket packet;
  auto balls = std::make_shared<SphereSet>();
  balls->origin = centre;
  balls->offsets = {glm::vec3(0.0f)};
  balls->radii = {float(radius)};
  balls->colors = {Color{1.0f, 0.6f, 0.2f}};
  packet.background = {0.1f, 0.2f, 0.3f, 1.0f};
  packet.spheres.push_back({balls, packet.add_object("ball", "ball")});
  return packet;
}

/// Ray from the eye through a point of the image (in pixels, from above) in room coordinates, by OpenXR's definition, without Catena's
/// cameras.
inline Vec3 ray_of(const XrView& view, double x, double y, double width, double height) {
  const double l = std::tan(view.fov.angleLeft), r = std::tan(view.fov.angleRight), t = std::tan(view.fov.angleUp),
               b = std::tan(view.fov.angleDown);
  const Vec3 v(l + (r - l) * x / width, t + (b - t) * y / height, -1.0),
      u(view.pose.orientation.x, view.pose.orientation.y, view.pose.orientation.z);
  return direction(v + 2 * double(view.pose.orientation.w) * cross(u, v) + 2.0 * cross(u, cross(u, v)));
}

class HeadsetFixture : public testing::Test {
 protected:
  void SetUp() override {
    if (!runtime_.found()) GTEST_SKIP() << "the scripted runtime was not built";
  }
  void TearDown() override {
    if (headset_) headset_->stop();
    if (renderer_) {
      EXPECT_EQ(renderer_->stats().validation_messages, 0u);
      for (const std::string& text : renderer_->validation_texts()) ADD_FAILURE() << text;
    }
    renderer_.reset();
    headset_.reset();
    for (const std::string& line : runtime_.record().illegal) ADD_FAILURE() << line;
    EXPECT_EQ(runtime_.record().objects, 0u);
  }
  /// Opens everything up to a session; returns the first error.
  Outcome open() {
    CATENA_TRY(headset_, xr::Headset::open());
    vk::DeviceOptions options;
    options.validation = validation_;
    options.provider = headset_->vulkan_provider(queue_lock_);
    CATENA_TRY(renderer_, Renderer::create(options));
    return headset_->start(renderer_->device());
  }
  /// Ends the session and frees everything that open() made.
  void close() {
    if (headset_) headset_->stop();
    renderer_.reset();
    headset_.reset();
  }
  void set_image_size(std::uint32_t width, std::uint32_t height) {
    runtime_.script().width = width;
    runtime_.script().height = height;
  }
  /// open() without an error.
  bool opens() {
    const Outcome opened = open();
    EXPECT_TRUE(opened) << opened.error().message;
    return bool(opened);
  }
  /// run_frames() without an error.
  bool shows(FramePacket& packet, const Placement& placement, int turns = 1) {
    const Outcome shown = run_frames(packet, placement, turns);
    EXPECT_TRUE(shown) << shown.error().message;
    return bool(shown);
  }
  /// The next frame of a running session, which must have one.
  xr::Frame begin_frame() {
    EXPECT_TRUE(headset_->poll());
    auto frame = headset_->begin();
    EXPECT_TRUE(frame) << frame.error().message;
    return frame.value();
  }
  /// Shows a packet in a frame.
  void show(const xr::Frame& frame, FramePacket& packet, const RenderSettings& settings, const Placement& placement) {
    const Outcome shown = headset_->show(frame, *renderer_, packet, settings, placement);
    ASSERT_TRUE(shown) << shown.error().message;
  }
  /// Runs iterations of the loop: events, and a frame while the session runs.
  Outcome run_frames(FramePacket& packet, const Placement& placement, int turns = 1, double share = 1) {
    for (int i = 0; i < turns; ++i) {
      CATENA_CHECK(headset_->poll());
      if (!headset_->is_running()) continue;
      CATENA_TRY(const xr::Frame frame, headset_->begin());
      CATENA_CHECK(headset_->show(frame, *renderer_, packet, {}, placement, share));
    }
    return Done{};
  }

  Runtime runtime_;
  bool validation_ = true;
  std::mutex queue_lock_;
  std::unique_ptr<xr::Headset> headset_;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace catena::test::xr_rig
