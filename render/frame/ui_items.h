/// What is drawn over a window's picture, at the window's own pixels: triangles with a texture, as an immediate-mode user interface makes
/// them. Plain data; the picture itself does not change.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace catena::render {

struct UiVertex {
  float x = 0, y = 0;      ///< pixels from the window's upper left corner
  float u = 0, v = 0;      ///< 0..1
  std::uint32_t rgba = 0;  ///< 8 bits each, r lowest; straight alpha, display values
};

/// A texture by content: the same object is uploaded once.
struct UiTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< straight alpha, rows from the top
};

struct UiDraw {
  std::shared_ptr<const UiTexture> texture;
  std::array<float, 4> clip{};  ///< x0, y0, x1, y1, pixels
  std::uint32_t first_index = 0, index_count = 0, first_vertex = 0;
};

struct UiItems {
  std::vector<UiVertex> vertices;
  std::vector<std::uint16_t> indices;  ///< three a triangle, from first_vertex on
  std::vector<UiDraw> draws;           ///< in order
  /// Where the window shows the picture (x0, y0, x1, y1, pixels), black beside it; none, or what of it the window holds is empty:
  /// everywhere.
  std::optional<std::array<std::uint32_t, 4>> area{};
};

}  // namespace catena::render
