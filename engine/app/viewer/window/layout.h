/// These functions say where the window shows what: the picture lies beside the panels, not under them. FrustumWindow coordinates, y down.
/// Pure, any thread.
#pragma once
#include <array>
#include <cstdint>

namespace catena::app {

struct Area {
  double x = 0, y = 0, width = 0, height = 0;
  bool contains(double px, double py) const { return px >= x && py >= y && px < x + width && py < y + height; }
  bool operator==(const Area&) const = default;
};

/// What lies at the window's edges; 0 where it is not shown.
struct Insets {
  double left = 0, top = 0, bottom = 0;
};

/// Windows that are narrower begin without the panels.
inline constexpr double kMinWidthWithPanels = 640;

/// At least one pixel each way, within the window, however large the edges are.
Area compute_image_area(double width, double height, const Insets& edges);

/// x0, y0, x1, y1 of the area in pixels of a frame of `frame_width` by `frame_height`; at least one pixel, within the frame.
std::array<std::uint32_t, 4> to_pixel_rect(const Area& area, double width, double height, std::uint32_t frame_width,
                                           std::uint32_t frame_height);

}  // namespace catena::app
