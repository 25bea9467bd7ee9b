// SPDX-License-Identifier: MIT
#include "render/extract/extract_internal.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "render/frame/camera.h"
#include "render/stereo/stereo_views.h"

namespace catena::render {

using scene::StereoMode;

Packing stereo_packing(const scene::Stereo& stereo) {
  switch (stereo.mode) {
    case StereoMode::mono:
    case StereoMode::left:
    case StereoMode::right:
      return Packing::single;
    case StereoMode::side_by_side:
    case StereoMode::cross_eyed:
      return Packing::side_by_side;
    case StereoMode::side_by_side_half:
      return Packing::side_by_side_half;
    case StereoMode::top_bottom:
      return Packing::top_bottom;
    case StereoMode::top_bottom_half:
      return Packing::top_bottom_half;
    case StereoMode::anaglyph:
      return Packing::anaglyph;
    case StereoMode::anaglyph_gray:
      return Packing::anaglyph_gray;
    case StereoMode::row_interlaced:
      return Packing::rows;
    case StereoMode::column_interlaced:
      return Packing::columns;
    case StereoMode::checkerboard:
      return Packing::checkerboard;
  }
  return Packing::single;
}

std::size_t stereo_view_count(const scene::Stereo& stereo) {
  if (stereo.mode == StereoMode::mono || stereo.mode == StereoMode::left || stereo.mode == StereoMode::right) return 1;
  return scene::needs_two_views(stereo.mode) ? 2 : static_cast<std::size_t>(stereo.view_count);
}

namespace {

Result<View> seen_through(const scene::Stereo& stereo, const Vec3& eye) {
  const scene::DisplayScreen& screen = stereo.screens[*stereo.screen_index];
  return make_screen_view({screen.lower_left, screen.lower_right, screen.upper_left}, eye);
}

std::vector<View> eyes_before_screen(const View& head, const scene::Stereo& stereo, std::size_t views) {
  const scene::DisplayScreen& screen = stereo.screens[*stereo.screen_index];
  const Vec3 right = direction(screen.lower_right - screen.lower_left);
  const double separation = stereo.separation.value_or(kDefaultSeparationRatio * norm(head.target - head.position));
  std::vector<View> all;
  for (std::size_t k = 0; k < views; ++k) {
    const double offset = (double(k) - 0.5 * double(views - 1)) * separation;
    auto eye = seen_through(stereo, head.position + offset * right);
    all.push_back(eye ? *eye : head);
  }
  return all;
}

}  // namespace

View make_screen_window_view(const View& view, const scene::Stereo& stereo) {
  if (!stereo.screen_index) return view;
  auto screen_view = seen_through(stereo, view.position);
  return screen_view ? *screen_view : view;
}

Outcome check_screen_view(const FramePacket& packet, const scene::Stereo& stereo) {
  if (!stereo.screen_index) return Done{};
  const auto screen_view = seen_through(stereo, packet.view.position);
  if (screen_view) return Done{};
  return Error{"screen \"" + stereo.screens[*stereo.screen_index].name + "\": " + screen_view.error().message};
}

Outcome check_eye_separation(const FramePacket& packet, const scene::Stereo& stereo) {
  constexpr double kMaxSeparation = 1e15;  // world units; a float still resolves the images' disparity
  const auto too_far = [&](const View& eye) {
    return std::fabs(eye.window.left) > 0.5 * kMaxWindowShift || !is_finite(eye.position) || !is_finite(eye.target) ||
           max_abs(eye.position) > kMaxSeparation;
  };
  if (std::none_of(packet.eyes.begin(), packet.eyes.end(), too_far)) return Done{};
  return Error{fmt::format("\"stereo\": the eyes are {} apart with a zero-parallax distance of {}: expected eyes that see one scene",
                           stereo.separation ? fmt::format("{:g}", *stereo.separation) : "a 30th of it",
                           stereo.zero_parallax ? fmt::format("{:g}", *stereo.zero_parallax) : "the camera's target")};
}

void update_eyes(FramePacket& packet, const scene::Stereo& stereo) {
  packet.eyes.clear();
  packet.packing = stereo_packing(stereo);
  if (stereo.mode == StereoMode::mono) return;
  StereoSettings settings;
  settings.views = std::max<std::size_t>(2, stereo_view_count(stereo));
  settings.separation = stereo.separation;
  settings.zero_parallax = stereo.zero_parallax;
  packet.eyes = stereo.screen_index ? eyes_before_screen(packet.view, stereo, settings.views)
                                    : make_stereo_views(packet.view, frustum_aspect(packet.view, packet.width, packet.height), settings);
  if (stereo.swap_eyes != (stereo.mode == StereoMode::cross_eyed)) std::reverse(packet.eyes.begin(), packet.eyes.end());
  if (stereo.mode == StereoMode::left || stereo.mode == StereoMode::right)
    packet.eyes = {stereo.mode == StereoMode::left ? packet.eyes.front() : packet.eyes.back()};
}

}  // namespace catena::render
