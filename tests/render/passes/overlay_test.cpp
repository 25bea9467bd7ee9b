// SPDX-License-Identifier: MIT
/// Text and flat shapes over the image, against independently computed positions and colours. Pixels of text are counted, not compared.
#include "render/passes/passes.h"

#include <cmath>

#include "render/passes/overlay/canvas.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::overlay_test {

using namespace catena::render;

class OverlayImages : public ImageTest {
 protected:
  /// A packet with only the overlay on opaque black.
  static FramePacket black(std::uint32_t width = 256, std::uint32_t height = 192) {
    FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
    set_size(packet, width, height);
    packet.background = {0, 0, 0, 1};
    return packet;
  }
  std::vector<BarLayout> places(const FramePacket& packet) {
    const Canvas canvas(packet, typesetter_);
    return layout_scalar_bars(canvas, packet.overlay);
  }
  Typesetter typesetter_;
};

ScalarBarItem bar_of(Side side) {
  ScalarBarItem bar;
  bar.colors = {{0, 0, 0, 0.5}, {1, 1, 0.5, 0}, {4, 0.2, 1, 1}};
  for (const double v : {0.0, 1.0, 2.0, 3.0, 4.0}) bar.ticks.push_back({v, std::to_string(int(v))});
  bar.title = "density";
  bar.side = side;
  return bar;
}

/// The transfer function of bar_of at a value.
Vec3 color_at(double v) {
  const Vec3 a(0, 0, 0.5), b(1, 0.5, 0), c(0.2, 1, 1);
  return v < 1 ? a + v * (b - a) : b + (v - 1) / 3 * (c - b);
}

int brightest(const std::uint8_t* p) { return std::max({p[0], p[1], p[2]}); }

TEST_F(OverlayImages, ScalarBarsShowTheTransferFunctionRowByRow) {
  for (const Side side : {Side::right, Side::left, Side::bottom, Side::top}) {
    FramePacket packet = black();
    packet.overlay.scalar_bars = {bar_of(side)};
    const Image8 image = draw(packet, {}, "side" + std::to_string(int(side)));
    const BarLayout place = places(packet).front();
    const Rect& r = place.ramp;
    ASSERT_GE(std::min(r.width, r.height), 4);
    EXPECT_EQ(place.upright, side == Side::right || side == Side::left);
    double worst = 0;
    for (int y = int(r.y); y < int(r.y + r.height); ++y)
      for (int x = int(r.x); x < int(r.x + r.width); ++x) {
        const double share = place.upright ? 1 - (y + 0.5 - r.y) / r.height : (x + 0.5 - r.x) / r.width;
        const Vec3 color = 255.0 * color_at(4 * share);
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(image.pixel(std::uint32_t(x), std::uint32_t(y))[c] - color[c]));
      }
    EXPECT_LE(worst, 1.0) << "side " << int(side);
    // within the image, including ticks and title
    EXPECT_GE(std::min(r.x, r.y), 2);
    EXPECT_LE(r.x + r.width, packet.width - 2);
    EXPECT_LE(r.y + r.height, packet.height - 2);
  }
}

TEST_F(OverlayImages, TicksAreAtTheirValues) {
  FramePacket packet = black();
  packet.overlay.scalar_bars = {bar_of(Side::right)};
  packet.overlay.scalar_bars[0].ticks = {{0.5, ""}, {1.75, ""}, {3.5, ""}};
  const Image8 image = draw(packet, {}, "ticks");
  const BarLayout place = places(packet).front();
  // the column next to the border has ink only at the tick marks
  const auto column = std::uint32_t(place.ramp.x + place.ramp.width + 1);
  std::vector<double> rows;
  for (std::uint32_t y = 0; y < packet.height; ++y)
    if (brightest(image.pixel(column, y)) > 200) rows.push_back(y + 0.5);
  ASSERT_EQ(rows.size(), 3u);
  const double values[] = {3.5, 1.75, 0.5};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(rows[std::size_t(i)], place.ramp.y + (1 - values[i] / 4) * place.ramp.height, 0.5 + 1e-9);
    EXPECT_EQ(tick_position(place, packet.overlay.scalar_bars[0], values[i]), place.ramp.y + (1 - values[i] / 4) * place.ramp.height);
  }
}

TEST_F(OverlayImages, SeveralScalarBarsDoNotOverlap) {
  FramePacket packet = black(256, 192);
  ScalarBarItem one = bar_of(Side::right);
  one.colors = {{2, 1, 0, 0}};
  one.ticks = {{2, "2"}};
  packet.overlay.scalar_bars = {bar_of(Side::right), one, bar_of(Side::left)};
  const Image8 image = draw(packet, {}, "three");
  const auto all = places(packet);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_LT(all[1].ramp.x + all[1].ramp.width, all[0].ramp.x - 2);
  EXPECT_LT(all[2].ramp.x, 128);
  const std::uint8_t* p = image.pixel(std::uint32_t(all[1].ramp.x + 2), 96);
  EXPECT_EQ((std::array<int, 3>{p[0], p[1], p[2]}), (std::array<int, 3>{255, 0, 0}));
  EXPECT_EQ(tick_position(all[1], one, 2), all[1].ramp.y + 0.5 * all[1].ramp.height);
}

TEST_F(OverlayImages, TextCoversItsBox) {
  FramePacket packet = black();
  packet.overlay.texts = {{"HHHH", Anchor::bottom_right, {-20.0, -30.0}, 40, true, Color{1, 1, 1}}};
  const Image8 image = draw(packet, {}, "text");
  const Canvas canvas(packet, typesetter_);
  const TextExtent extent = canvas.measure("HHHH", {40, true, false, {}});
  ASSERT_GT(extent.width, 0) << typesetter_.error_message();
  int left = 256, right = -1, top = 192, bottom = -1, ink = 0;
  for (int y = 0; y < 192; ++y)
    for (int x = 0; x < 256; ++x) {
      if (brightest(image.pixel(std::uint32_t(x), std::uint32_t(y))) < 128) continue;
      left = std::min(left, x), right = std::max(right, x + 1), top = std::min(top, y), bottom = std::max(bottom, y + 1);
      ++ink;
    }
  const double x1 = 256 - canvas.px(20), y1 = 192 - canvas.px(30);
  EXPECT_NEAR(bottom, y1, 1);
  EXPECT_NEAR(top, y1 - extent.height, 1);
  EXPECT_LE(right, x1 + 0.5);
  EXPECT_GE(right, x1 - 0.15 * canvas.px(40));
  EXPECT_NEAR(left - (x1 - extent.width), x1 - right, 1.5) << "side bearings are equal";
  // a bold H covers between a third and two thirds of its box
  EXPECT_GT(ink, 0.33 * extent.width * extent.height);
  EXPECT_LT(ink, 0.67 * extent.width * extent.height);
}

TEST_F(OverlayImages, LabelsAreAtTheirProjectedPoint) {
  FramePacket packet = black();
  packet.view.position = {3, -9, 4};
  packet.view.target = {0.2, 0.1, 0.3};
  for (const bool orthographic : {false, true}) {
    packet.view.orthographic = orthographic;
    packet.view.height = 6;
    const Vec3 points[] = {{1, 0, 0}, {-1.3, 0.4, 0.9}, {0, 0, -1}};
    const Vec3 forward = direction(packet.view.target - packet.view.position), right = direction(cross(forward, Vec3(0, 0, 1))),
               up = cross(right, forward);
    for (const Vec3& p : points) {
      packet.overlay.labels = {{p, "", Anchor::left, {0.0, 0.0}, 12, Color{1, 1, 1}, true, false}};
      const Image8 image = draw(packet);
      double sum = 0, x = 0, y = 0;
      for (std::uint32_t j = 0; j < 192; ++j)
        for (std::uint32_t i = 0; i < 256; ++i) {
          const double w = image.pixel(i, j)[0];
          sum += w, x += w * (i + 0.5), y += w * (j + 0.5);
        }
      ASSERT_GT(sum, 255);
      const Vec3 d = p - packet.view.position;
      const double half = orthographic ? 3 : std::tan(15 * M_PI / 180) * dot(d, forward);
      EXPECT_NEAR(x / sum, 128 + 96 * dot(d, right) / half, 0.15);
      EXPECT_NEAR(y / sum, 96 - 96 * dot(d, up) / half, 0.15);
    }
  }
  // not drawn behind the camera
  packet.view.orthographic = false;
  packet.overlay.labels = {{{6, -19, 8}, "X", Anchor::left, {0.0, 0.0}, 12, Color{1, 1, 1}, true, false}};
  const Image8 image = draw(packet);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) ASSERT_EQ(image.rgba[i], 0);
}

TEST_F(OverlayImages, ALabelBehindASurfaceIsHiddenByItsOption) {
  FramePacket packet = black();
  packet.meshes = {{square_at(0, 3), {0, 0, 1}}};
  const auto red_pixels = [&](const Vec3& at, bool hidden) {
    packet.overlay.labels = {{at, "HHH", Anchor::left, {4.0, 0.0}, 60, Color{1, 0, 0}, true, hidden}};
    const Image8 image = draw(packet);
    int count = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) count += image.rgba[i] > 200 && image.rgba[i + 2] < 60;
    return count;
  };
  EXPECT_EQ(red_pixels({0, 1, 0}, true), 0);
  EXPECT_GT(red_pixels({0, 1, 0}, false), 50);
  EXPECT_GT(red_pixels({0, -1, 0}, true), 50);
  EXPECT_GT(red_pixels({0, 0, 0}, true), 50) << "on the surface itself";
}

TEST_F(OverlayImages, TheOrientationMarkersArrowsPointAlongTheAxes) {
  FramePacket packet = black();
  packet.overlay.orientation_marker.emplace();
  packet.overlay.orientation_marker->size_pt = 300;
  packet.overlay.orientation_marker->names = {"", "", ""};
  const Vec3 eyes[] = {{5, -7, 4}, {-6, -3, 5}, {4, 8, -3}, {-5, 6, 7}};
  for (const Vec3& eye : eyes) {
    packet.view.position = eye;
    const Image8 image = draw(packet, {}, "eye" + std::to_string(int(eye.x)));
    const MarkerLayout place = layout_orientation_marker(Canvas(packet, typesetter_), *packet.overlay.orientation_marker);
    const Vec3 forward = direction(-eye), right = direction(cross(forward, Vec3(0, 0, 1))), up = cross(right, forward);
    for (int axis = 0; axis < 3; ++axis) {
      const auto pixel_at = [&](double share) {
        return image.pixel(std::uint32_t(place.center.x + share * place.arrow_length * right[axis]),
                           std::uint32_t(place.center.y - share * place.arrow_length * up[axis]));
      };
      // on the shaft and within the cone, without other arrows
      for (const double share : {0.55, 0.85}) {
        const std::uint8_t* p = pixel_at(share);
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
          EXPECT_GT(p[axis], p[other] + 25) << "axis " << axis << " share " << share << " eye " << eye.x;
      }
      EXPECT_EQ(brightest(pixel_at(1.1)), 0) << "beyond the tip of axis " << axis;
    }
  }
}

TEST_F(OverlayImages, StraightAlphaOverATransparentImage) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({30, -40, 30}, {7.5, 7.5, 7.5});
  packet.volumes = {volume_item(grid, {{0, 0.05}, {1, 0.05}}, {1, 0.5f, 0})};
  packet.view.target = {9, 7.5, 10};
  const Image8 under = draw(packet);
  packet.overlay.status = StatusItem{3, 0, {{"a", "OK", true}, {"b", "OK", true}, {"c", "OK", true}}, Anchor::center};
  packet.overlay.scale = 3;
  packet.overlay.scalar_bars = {bar_of(Side::bottom)};
  const Image8 over = draw(packet, {}, "panel");
  // the bar is opaque on a transparent background
  const Rect r = places(packet).front().ramp;
  const auto* bar = over.pixel(std::uint32_t(r.x + 0.25 * r.width), std::uint32_t(r.y + 0.5 * r.height));
  EXPECT_EQ(bar[3], 255);
  EXPECT_NEAR(bar[0], 255, 4);
  EXPECT_NEAR(bar[1], 128, 4);
  // the panel's white with alpha 1/2 over the image
  int on_volume = 0, on_nothing = 0;
  for (std::size_t i = 0; i < under.rgba.size(); i += 4) {
    const double a = under.rgba[i + 3] / 255.0, alpha = 0.5 + 0.5 * a;
    if (over.rgba[i + 3] == under.rgba[i + 3] || std::fabs(over.rgba[i + 3] - 255 * alpha) > 1) continue;
    bool plain = true;
    for (std::size_t c = 0; c < 3; ++c)
      plain = plain && std::fabs(over.rgba[i + c] - 255 * (0.5 + 0.5 * a * under.rgba[i + c] / 255.0) / alpha) <= 3;
    (a > 0 ? on_volume : on_nothing) += plain;
  }
  EXPECT_GT(on_volume, 500);
  EXPECT_GT(on_nothing, 200);
  // pixels without overlay are unchanged
  EXPECT_EQ(over.pixel(0, 0)[3], 0);
}

TEST_F(OverlayImages, AnEmptyOverlayHasNoPass) {
  FramePacket packet = black();
  const Image8 plain = draw(packet);
  const std::uint64_t pipelines = renderer_->stats().pipelines;
  draw(packet);
  EXPECT_EQ(renderer_->stats().pipelines, pipelines);
  packet.overlay.orientation_marker.emplace();
  EXPECT_GT(max_difference(plain, draw(packet)), 100);
  EXPECT_EQ(renderer_->stats().pipelines, pipelines + 2) << "one to draw, one to blend";
  EXPECT_TRUE(renderer_->stats().warnings.empty());
  EXPECT_EQ(renderer_->stats().passes.back(), "overlay");
  packet.overlay = {};
  EXPECT_EQ(max_difference(plain, draw(packet)), 0);
}

TEST_F(OverlayImages, TheLayoutScalesWithTheImage) {
  FramePacket small = black(160, 120), large = black(640, 480);
  small.overlay.scalar_bars = large.overlay.scalar_bars = {bar_of(Side::right), bar_of(Side::bottom)};
  const auto a = places(small), b = places(large);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(4 * a[i].ramp.x, b[i].ramp.x, 8);
    EXPECT_NEAR(4 * a[i].ramp.y, b[i].ramp.y, 8);
    EXPECT_NEAR(4 * a[i].ramp.width, b[i].ramp.width, 4);
    EXPECT_NEAR(4 * a[i].ramp.height, b[i].ramp.height, 4);
  }
}

TEST_F(OverlayImages, ATileHasItsPartOfTheWholeOverlay) {
  FramePacket whole = black();
  whole.overlay.scalar_bars = {bar_of(Side::right), bar_of(Side::bottom)};
  whole.overlay.orientation_marker.emplace();
  whole.overlay.texts = {{"A title", Anchor::top, {0.0, 10.0}, 18, true, {}}};
  whole.overlay.status = StatusItem{3, 8, {{"a", "OK", true}}, Anchor::top_left};
  const Image8 image = draw(whole, {}, "whole");
  for (const auto& [x, y] : {std::pair{0u, 0u}, std::pair{128u, 0u}, std::pair{96u, 64u}}) {
    FramePacket tile = whole;
    set_size(tile, 128, 96);
    tile.overlay.frame = {double(x), double(y), 256, 192};
    EXPECT_LE(max_difference(draw(tile), image, x, y), 1) << x << " " << y;
  }
}

TEST_F(OverlayImages, AllItemsTogetherAreReadableAndRepeatable) {
  const auto grid = make_grid({32, 32, 32}, [](const Vec3& p) { return 1 - norm(p - Vec3(15.5)) / 16; });
  FramePacket packet = make_packet({60, -70, 50}, {16, 16, 16});
  packet.volumes = {volume_item(grid, {{0, 0.0}, {0.2, 0}, {1, 0.3}}, {0.9f, 0.6f, 0.3f})};
  set_size(packet, 256, 192);
  packet.overlay.scalar_bars = {bar_of(Side::right), bar_of(Side::bottom), bar_of(Side::left), bar_of(Side::top)};
  packet.overlay.scalar_bars[0].factor = "×10⁻⁵";
  packet.overlay.texts = {{"A ball of fog, 1.5 µm", Anchor::top, {0.0, 12.0}, 17, true, {}}};
  packet.overlay.labels = {{{16, 16, 16}, "centre", Anchor::left, {6.0, 0.0}, 12, Color{1, 0.9f, 0.2f}, true, false},
                           {{0, 0, 0}, "corner\n(0, 0, 0)", Anchor::top, {0.0, 6.0}, 10, {}, true, false}};
  packet.overlay.orientation_marker.emplace();
  packet.overlay.status = StatusItem{1.234, 8, {{"curve", "OK", true}, {"surface", "FREE", true}}, Anchor::top_left};
  // text is readable on any background, and the image repeats bit for bit
  for (const float background : {0.0f, 1.0f}) {
    packet.background = {background, background, background, 1};
    const Image8 image = draw(packet, {}, background > 0 ? "light" : "dark");
    EXPECT_EQ(max_difference(image, draw(packet)), 0);
    int ink = 0;
    const double bright = background > 0 ? 0 : 255;
    for (std::uint32_t y = 0; y < 12; ++y)
      for (std::uint32_t x = 60; x < 196; ++x) ink += std::fabs(image.pixel(x, y)[1] - bright) < 60;
    EXPECT_GT(ink, 30) << "the title";
  }
}

}  // namespace catena::test::overlay_test
