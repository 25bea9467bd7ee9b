// SPDX-License-Identifier: MIT
// UI items over a window's image, against known pixels within 1/255.
#include <cmath>
#include <limits>

#include "render/passes/ui.h"
#include "tests/render/support/failure_injector.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/resident.h"
#include "tests/support/support.h"

namespace catena::test::ui_test {

using namespace catena::render;
using Color = std::array<int, 3>;

constexpr std::uint32_t rgba(std::uint32_t r, std::uint32_t g, std::uint32_t b, std::uint32_t a = 255) {
  return r | g << 8 | b << 16 | a << 24;
}

constexpr std::array<float, 4> kAll{-1e9f, -1e9f, 1e9f, 1e9f};

/// Adds a rectangle of two triangles as one draw.
void add_rectangle(UiItems& ui, std::array<float, 4> box, std::uint32_t color, std::array<float, 4> clip = kAll,
                   std::shared_ptr<const UiTexture> texture = nullptr) {
  const auto first = std::uint32_t(ui.vertices.size());
  ui.draws.push_back({std::move(texture), clip, std::uint32_t(ui.indices.size()), 6, first});
  ui.vertices.insert(
      ui.vertices.end(),
      {{box[0], box[1], 0, 0, color}, {box[2], box[1], 1, 0, color}, {box[2], box[3], 1, 1, color}, {box[0], box[3], 0, 1, color}});
  ui.indices.insert(ui.indices.end(), {0, 1, 2, 0, 2, 3});
}

/// A texture whose bytes are all `value`.
std::shared_ptr<UiTexture> even_texture(std::uint32_t side, std::uint8_t value) {
  return std::make_shared<UiTexture>(UiTexture{side, side, std::vector<std::uint8_t>(4 * side * side, value)});
}

void expect_pixel(const Image8& p, std::uint32_t x, std::uint32_t y, const Color& want) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(p.pixel(x, y)[c], want[c], 1) << "channel " << c << " at " << x << " " << y;
  EXPECT_EQ(p.pixel(x, y)[3], 255) << x << " " << y;
}

class Ui : public ImageTest {
 protected:
  /// Draws an image of one colour.
  void draw_plain(std::uint32_t width, std::uint32_t height, const Color& color) {
    FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
    set_size(packet, width, height);
    packet.background = {float(color[0]) / 255, float(color[1]) / 255, float(color[2]) / 255, 1};
    ASSERT_TRUE(renderer_->draw(packet));
  }
  /// A ball on a dark background.
  Image8 draw_ball(std::uint32_t width, std::uint32_t height) {
    FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
    set_size(packet, width, height);
    packet.background = {0.1f, 0.1f, 0.2f, 1};
    packet.cursors = {cursor_item({0, 0, 0}, 1)};
    return draw(packet);
  }
  Image8 paint(std::uint32_t width, std::uint32_t height, const UiItems& ui, const std::string& name = "") {
    const auto painted = renderer_->paint_window(width, height, ui);
    EXPECT_TRUE(painted) << (painted ? "" : painted.error().message);
    auto image = renderer_->read_back_window();
    EXPECT_TRUE(image);
    if (!name.empty()) save_picture(*image, name, false);
    return *image;
  }
};

TEST_F(Ui, WithoutItemsTheWindowShowsTheImage) {
  const Image8 below = draw_ball(64, 48);
  const Image8 window = paint(64, 48, {});
  EXPECT_EQ(window.rgba, below.rgba);
  UiItems nothing;
  nothing.draws.push_back({nullptr, kAll, 0, 0, 0});
  EXPECT_EQ(paint(64, 48, nothing).rgba, below.rgba);
}

TEST_F(Ui, SolidAndHalfTransparentRectanglesAreBlended) {
  draw_plain(40, 30, {200, 100, 40});
  UiItems ui;
  add_rectangle(ui, {4, 5, 14, 25}, rgba(10, 250, 60));
  add_rectangle(ui, {20, 5, 30, 25}, rgba(10, 250, 60, 128));
  add_rectangle(ui, {32, 5, 36, 25}, rgba(10, 250, 60, 0));
  const Image8 p = paint(40, 30, ui, "window");
  const auto half = [](int over, int below) { return int(std::lround((128.0 * over + 127.0 * below) / 255)); };
  for (std::uint32_t y = 0; y < 30; ++y)
    for (std::uint32_t x = 0; x < 40; ++x) {
      const bool row = y >= 5 && y < 25;
      if (row && x >= 4 && x < 14)
        expect_pixel(p, x, y, {10, 250, 60});
      else if (row && x >= 20 && x < 30)
        expect_pixel(p, x, y, {half(10, 200), half(250, 100), half(60, 40)});
      else
        expect_pixel(p, x, y, {200, 100, 40});
    }
}

TEST_F(Ui, LaterDrawsAreOnTop) {
  draw_plain(12, 8, {0, 0, 0});
  UiItems ui;
  add_rectangle(ui, {0, 0, 8, 8}, rgba(255, 0, 0));
  add_rectangle(ui, {4, 0, 12, 8}, rgba(0, 0, 255, 128));
  Image8 p = paint(12, 8, ui);
  expect_pixel(p, 2, 4, {255, 0, 0});
  expect_pixel(p, 6, 4, {127, 0, 128});
  expect_pixel(p, 10, 4, {0, 0, 128});
  std::swap(ui.draws[0], ui.draws[1]);
  p = paint(12, 8, ui);
  expect_pixel(p, 6, 4, {255, 0, 0});
  expect_pixel(p, 10, 4, {0, 0, 128});
}

TEST_F(Ui, AClipKeepsThePixelsWithTheirCentresInside) {
  draw_plain(20, 16, {9, 9, 9});
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  UiItems ui;
  add_rectangle(ui, {0, 0, 20, 16}, rgba(255, 255, 255), {3.5f, 2.51f, 7.5f, 6.49f});
  add_rectangle(ui, {0, 0, 20, 16}, rgba(255, 0, 0), {15, 12, 1e30f, std::numeric_limits<float>::max()});
  add_rectangle(ui, {0, 0, 20, 16}, rgba(0, 255, 0), {-1e30f, -5, -2, 100});  // the next three are clipped away
  add_rectangle(ui, {0, 0, 20, 16}, rgba(0, 255, 0), {8, 8, 8, 16});
  add_rectangle(ui, {0, 0, 20, 16}, rgba(0, 255, 0), {kNan, kNan, kNan, kNan});
  const Image8 p = paint(20, 16, ui, "window");
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 20; ++x) {
      if (x >= 3 && x < 7 && y >= 3 && y < 6)
        expect_pixel(p, x, y, {255, 255, 255});
      else if (x >= 15 && y >= 12)
        expect_pixel(p, x, y, {255, 0, 0});
      else
        expect_pixel(p, x, y, {9, 9, 9});
    }
}

TEST_F(Ui, TexturesAreSampledLinearly) {
  draw_plain(24, 16, {0, 0, 0});
  auto texture = std::make_shared<UiTexture>(UiTexture{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0}});
  UiItems ui;
  add_rectangle(ui, {0, 0, 2, 2}, rgba(255, 255, 255), kAll, texture);
  add_rectangle(ui, {4, 0, 6, 2}, rgba(128, 128, 255, 128), kAll, texture);  // colours multiply
  add_rectangle(ui, {8, 0, 24, 16}, rgba(255, 255, 255), kAll, texture);
  const Image8 p = paint(24, 16, ui, "window");
  expect_pixel(p, 0, 0, {255, 0, 0});
  expect_pixel(p, 1, 0, {0, 255, 0});
  expect_pixel(p, 0, 1, {0, 0, 255});
  expect_pixel(p, 1, 1, {0, 0, 0});
  expect_pixel(p, 4, 0, {64, 0, 0});
  expect_pixel(p, 4, 1, {0, 0, 128});
  // magnified eight times: linear between the texels' centres
  for (std::uint32_t x = 8; x < 24; ++x) {
    const double t = std::clamp((x - 8 + 0.5) / 8 - 0.5, 0.0, 1.0);
    expect_pixel(p, x, 0, {int(std::lround(255 * (1 - t))), int(std::lround(255 * t)), 0});
  }
}

TEST_F(Ui, IndicesAreRelativeToTheFirstVertex) {
  draw_plain(64, 64, {0, 0, 0});
  // 70 000 vertices: more than 16 bits count
  UiItems ui;
  ui.vertices.resize(70'000 - 4);
  add_rectangle(ui, {10, 10, 50, 50}, rgba(1, 200, 3));
  ASSERT_EQ(ui.draws[0].first_vertex, 69'996u);
  const Image8 p = paint(64, 64, ui);
  expect_pixel(p, 9, 30, {0, 0, 0});
  expect_pixel(p, 10, 10, {1, 200, 3});
  expect_pixel(p, 49, 49, {1, 200, 3});
  expect_pixel(p, 50, 49, {0, 0, 0});
}

TEST_F(Ui, ThreeThousandQuadsInOneDraw) {
  draw_plain(240, 200, {255, 255, 255});
  // quads of 4 x 4 pixels, one pixel apart, in one draw
  UiItems ui;
  const auto color = [](std::uint32_t i) { return rgba(i % 256, i / 256 * 20, 7 * i % 256); };
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const auto x = float(4 * (i % 60)), y = float(4 * (i / 60));
    add_rectangle(ui, {x, y, x + 3, y + 3}, color(i));
  }
  for (std::uint32_t i = 0; i < 3000; ++i)
    for (std::uint32_t k = 0; k < 6; ++k) ui.indices[6 * i + k] = std::uint16_t(ui.indices[6 * i + k] + 4 * i);
  ui.draws = {{nullptr, kAll, 0, 18'000, 0}};
  const Image8 p = paint(240, 200, ui, "window");
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const std::uint32_t c = color(i);
    expect_pixel(p, 4 * (i % 60) + 1, 4 * (i / 60) + 2, {int(c & 255), int(c >> 8 & 255), int(c >> 16 & 255)});
    expect_pixel(p, 4 * (i % 60) + 3, 4 * (i / 60) + 1, {255, 255, 255});
  }
}

TEST_F(Ui, ASmallImageIsScaledAndTheUiIsNot) {
  // the image of the ball
  const Image8 small = draw_ball(32, 24);
  UiItems ui;
  add_rectangle(ui, {1, 1, 2, 2}, rgba(255, 255, 0));
  const Image8 p = paint(64, 48, ui, "window");
  ASSERT_EQ(p.width, 64u);
  expect_pixel(p, 1, 1, {255, 255, 0});
  expect_pixel(p, 2, 1, {26, 26, 51});
  // every window pixel is a quarter of a texel from an image's pixel centre
  const auto at = [&](int x, int y, int c) {
    return int(small.pixel(std::uint32_t(std::clamp(x, 0, 31)), std::uint32_t(std::clamp(y, 0, 23)))[c]);
  };
  int varied = 0;
  for (int y = 4; y < 48; ++y)
    for (int x = 4; x < 64; ++x) {
      const int i = x / 2, j = y / 2, ni = i + (x % 2 ? 1 : -1), nj = j + (y % 2 ? 1 : -1);
      for (int c = 0; c < 3; ++c) {
        const double want = (9 * at(i, j, c) + 3 * at(ni, j, c) + 3 * at(i, nj, c) + at(ni, nj, c)) / 16.0;
        ASSERT_NEAR(p.pixel(std::uint32_t(x), std::uint32_t(y))[c], want, 1.6) << x << " " << y;
        varied += std::abs(want - at(i, j, c)) > 5;
      }
    }
  EXPECT_GT(varied, 100) << "nothing to tell linear from nearest by";
}

TEST_F(Ui, AnotherUiReusesTheImage) {
  const Image8 below = draw_ball(64, 48);
  UiItems first, second;
  add_rectangle(first, {0, 0, 64, 20}, rgba(255, 0, 0, 200));
  add_rectangle(second, {10, 10, 30, 40}, rgba(0, 255, 0));
  const Image8 one = paint(64, 48, first);
  const std::uint64_t pipelines = renderer_->stats().pipelines;
  const Image8 two = paint(64, 48, second);
  EXPECT_EQ(renderer_->stats().pipelines, pipelines);
  EXPECT_GT(max_difference(one, two), 200);
  expect_pixel(two, 20, 20, {0, 255, 0});
  for (std::uint32_t x = 35; x < 64; ++x)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(two.pixel(x, 5)[c], below.pixel(x, 5)[c]);
  EXPECT_EQ(paint(64, 48, first).rgba, one.rgba);
  // the image itself is unchanged
  const auto again = renderer_->read_back();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->rgba, below.rgba);
}

TEST_F(Ui, WindowsOfEverySizeArePainted) {
  draw_plain(16, 12, {50, 60, 70});
  for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 40u}, {333u, 1u}, {17u, 31u}, {256u, 192u}, {1u, 1u}}) {
    UiItems ui;
    add_rectangle(ui, {-20, -20, 1, 1}, rgba(250, 0, 0));
    const Image8 p = paint(width, height, ui);
    ASSERT_EQ(p.width, width);
    ASSERT_EQ(p.height, height);
    expect_pixel(p, 0, 0, {250, 0, 0});
    if (width * height > 1) expect_pixel(p, width - 1, height - 1, {50, 60, 70});
  }
  for (const auto& [width, height] : {std::pair{0u, 10u}, {10u, 0u}, {10u, 1u << 20}}) {
    const auto painted = renderer_->paint_window(width, height, {});
    ASSERT_FALSE(painted);
    EXPECT_NE(painted.error().message.find("expected 1 to"), std::string::npos) << painted.error().message;
  }
  expect_pixel(paint(3, 3, {}), 1, 1, {50, 60, 70});
}

TEST_F(Ui, PaintsOverPackedEyesAndFloatImages) {
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  set_size(packet, 20, 16);
  packet.background = {0.2f, 0.4f, 0.6f, 1};
  packet.eyes = {packet.view, packet.view};
  packet.packing = Packing::side_by_side;
  ASSERT_TRUE(renderer_->draw(packet));
  UiItems ui;
  add_rectangle(ui, {30, 2, 38, 10}, rgba(255, 0, 255));
  const auto expect_painted = [&] {
    const Image8 p = paint(40, 16, ui);
    expect_pixel(p, 35, 5, {255, 0, 255});
    expect_pixel(p, 5, 5, {51, 102, 153});
  };
  expect_painted();
  packet.eyes.clear();
  RenderSettings settings{.float_image = true, .fast = {}};
  ASSERT_TRUE(renderer_->draw(packet, settings));
  expect_painted();
}

TEST_F(Ui, ATextureIsUploadedOnceAndFreedWhenIdle) {
  draw_plain(32, 32, {0, 0, 0});
  const auto with = [](const std::shared_ptr<const UiTexture>& texture) {
    UiItems ui;
    add_rectangle(ui, {0, 0, 32, 32}, rgba(255, 255, 255), kAll, texture);
    return ui;
  };
  const auto uploads = [&] { return renderer_->stats().uploads; };
  const auto held = [&] { return renderer_->device().counters().allocated_bytes; };
  auto reused = even_texture(64, 255);
  paint(32, 32, with(reused));
  const std::uint64_t uploads_before = uploads(), bytes_before = held();
  for (int k = 0; k < 20; ++k) paint(32, 32, with(reused));
  EXPECT_EQ(uploads(), uploads_before);
  EXPECT_EQ(held(), bytes_before);
  // other textures are created and freed, possibly at the same address
  for (int k = 0; k < 40; ++k) {
    UiItems ui = with(reused);
    add_rectangle(ui, {0, 0, 16, 16}, rgba(255, 0, 0), kAll, even_texture(64, std::uint8_t(100 + k)));
    const Image8 p = paint(32, 32, ui);
    const double alpha = (100 + k) / 255.0;
    EXPECT_NEAR(p.pixel(4, 4)[0], 255 * (alpha * alpha + 1 - alpha), 1.5);
    EXPECT_LE(held(), bytes_before + (WindowPainter::kTextureIdlePaints + 1) * 65536);
  }
  EXPECT_EQ(uploads(), uploads_before + 40);
  for (std::uint64_t k = 0; k <= WindowPainter::kTextureIdlePaints; ++k) paint(32, 32, with(reused));
  EXPECT_EQ(held(), bytes_before);
}

TEST_F(Ui, AThousandPaintsHoldNoMoreMemory) {
  const auto renderer = make_renderer(0, false);  // the validation layer allocates memory of its own
  ASSERT_TRUE(renderer);
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  packet.width = packet.height = 16;
  ASSERT_TRUE(renderer->draw(packet));
  const auto paint_frames = [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      UiItems ui;
      for (int q = 0; q < 20 + k % 50; ++q) add_rectangle(ui, {0, 0, float(q % 30), 20}, rgba(1, 2, 3, 100));
      if (k % 10 == 0) add_rectangle(ui, {0, 0, 9, 9}, rgba(9, 9, 9), kAll, even_texture(32, 9));
      const auto size = std::uint32_t(k % 100 < 5 ? 48 : 32);
      ASSERT_TRUE(renderer->paint_window(size, size, ui));
    }
  };
  const auto settled = [&] { paint_frames(41, 50); };
  paint_frames(0, 200);
  settled();
  const std::uint64_t device_before = renderer->device().counters().allocated_bytes, host_before = resident_bytes();
  paint_frames(200, 1200);
  settled();
  EXPECT_EQ(renderer->device().counters().allocated_bytes, device_before);
  EXPECT_EQ(renderer->device().retired_count(), 0u);
  if (kResidentIsReliable) {
    EXPECT_LT(resident_bytes(), host_before + 4'000'000);
  }
}

TEST(UiFailures, OutOfMemoryAndALostDeviceAreReportedAndTheImageIsKept) {
  use_lavapipe();
  const auto failing = std::make_shared<FailureInjector>();
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  packet.width = packet.height = 16;
  packet.background = {1, 1, 1, 1};
  UiItems ui;
  add_rectangle(ui, {0, 0, 9, 9}, rgba(9, 9, 9), kAll, even_texture(8, 255));
  const auto start = [&] {
    auto renderer = Renderer::create(failing_options(failing));
    EXPECT_TRUE(renderer);
    EXPECT_TRUE((*renderer)->draw(packet));
    return std::move(*renderer);
  };
  auto renderer = start();
  failing->arm(vk::DriverCall::allocate, VK_SUCCESS, 0);
  ASSERT_TRUE(renderer->paint_window(32, 32, ui));
  const auto whole = renderer->read_back_window();
  ASSERT_TRUE(whole);
  const int allocations = failing->calls - 1;  // without the read-back's
  ASSERT_GE(allocations, 6);
  renderer = start();
  const std::uint64_t held = renderer->device().counters().allocated_bytes;
  for (int n = 1; n <= allocations; ++n) {
    failing->arm(vk::DriverCall::allocate, VK_ERROR_OUT_OF_DEVICE_MEMORY, n);
    const auto painted = renderer->paint_window(32, 32, ui);
    ASSERT_FALSE(painted) << n;
    EXPECT_NE(painted.error().message.find("VK_ERROR_OUT_OF_DEVICE_MEMORY"), std::string::npos);
    EXPECT_EQ(renderer->device().counters().allocated_bytes, held) << n;
    EXPECT_EQ(renderer->device().retired_count(), 0u) << n;
    failing->arm(vk::DriverCall::allocate, VK_SUCCESS, 0);
    if (n % 2 == 0) continue;
    ASSERT_TRUE(renderer->paint_window(32, 32, ui)) << n;
    const auto again = renderer->read_back_window();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->rgba, whole->rgba);
    renderer = start();
  }
  for (const vk::DriverCall call : {vk::DriverCall::submit, vk::DriverCall::wait})
    for (const int n : {1, 2}) {  // the texture's and the paint's allocation
      renderer = start();
      failing->arm(call, VK_ERROR_DEVICE_LOST, n);
      const auto painted = renderer->paint_window(32, 32, ui);
      ASSERT_FALSE(painted);
      EXPECT_NE(painted.error().message.find("VK_ERROR_DEVICE_LOST"), std::string::npos);
      EXPECT_TRUE(renderer->device().is_lost());
    }
  for (const std::string& text : renderer->validation_texts()) ADD_FAILURE() << text;
}

TEST(UiFailures, GridsAreFreedToMakeRoomForTheWindow) {
  const auto renderer = make_renderer(4'000'000);
  ASSERT_TRUE(renderer);
  FramePacket packet = make_packet({200, -250, 200}, {48, 48, 48});
  set_size(packet, 64, 48);
  const auto grid = make_grid({96, 96, 96}, [](const Vec3& p) { return norm(p - Vec3(48.0)) / 84; });
  packet.volumes = {volume_item(grid, {{0, 0.05}, {1, 0}})};
  ASSERT_TRUE(renderer->draw(packet));
  const std::uint64_t left = renderer->device().memory_available();
  ASSERT_EQ(renderer->stats().resident_grids, 1u);
  ASSERT_LT(left, 2'500'000u);
  UiItems ui;
  add_rectangle(ui, {0, 0, 9, 9}, rgba(9, 99, 9));
  const Outcome painted = renderer->paint_window(900, 800, ui);  // 2.9 MB
  ASSERT_TRUE(painted) << painted.error().message;
  EXPECT_EQ(renderer->stats().resident_grids, 0u);
  // the image is kept, and the next image and window are drawn
  ASSERT_TRUE(renderer->read_back());
  ASSERT_TRUE(renderer->draw(packet));
  ASSERT_TRUE(renderer->paint_window(900, 800, ui));
  for (const std::string& text : renderer->validation_texts()) ADD_FAILURE() << text;
}

}  // namespace catena::test::ui_test
