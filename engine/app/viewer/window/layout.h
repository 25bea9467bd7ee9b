// SPDX-License-Identifier: MIT
/// Layout of the window: the image area lies next to the panels, not under them. Window coordinates, y down. Pure, any thread.
#pragma once
#include <array>
#include <cstdint>

namespace catena::app {

/// A rectangle in window coordinates.
struct Area {
  double x = 0, y = 0, width = 0, height = 0;
  bool contains(double px, double py) const { return px >= x && py >= y && px < x + width && py < y + height; }
  bool operator==(const Area&) const = default;
};

/// Space taken by the GUI at the edges of the window; 0 where it is hidden.
struct Insets {
  double left = 0, top = 0, bottom = 0;
};

/// Windows narrower than this start without panels.
inline constexpr double kMinWidthWithPanels = 640;

/// Returns the image area of the window, at least one pixel in each direction and within the window, however large the insets are.
Area compute_image_area(double width, double height, const Insets& edges);

/// Returns x0, y0, x1, y1 of the area in pixels of a frame of `frame_width` by `frame_height`: at least one pixel, within the frame.
/// `width`, `height`: size of the window.
std::array<std::uint32_t, 4> to_pixel_rect(const Area& area, double width, double height, std::uint32_t frame_width,
                                           std::uint32_t frame_height);

}  // namespace catena::app
