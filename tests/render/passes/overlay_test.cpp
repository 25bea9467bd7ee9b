/// Text and flat shapes over the picture, against places and colours worked out apart.
#include "render/passes/overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/passes/overlay/furniture.h"
#include "tests/render/support/frames.h"

namespace catena::test {
namespace {

using namespace catena::render;

class OverlayPictures : public PictureTest {};

ScalarBarItem bar_of(Side side) {
  ScalarBarItem bar;
  bar.colors = {{0, 0, 0, 0.5}, {1, 1, 0.5, 0}, {4, 0.2, 1, 1}};
  for (const double v : {0.0, 1.0, 2.0, 3.0, 4.0}) bar.ticks.push_back({v, std::to_string(int(v))});
  bar.title = "density";
  bar.side = side;
  return bar;
}

TEST_F(OverlayPictures, Everything) {
  const auto grid = make_grid({32, 32, 32}, [](const Vec3& p) { return 1 - norm(p - Vec3(15.5)) / 16; });
  FramePacket packet = packet_of({60, -70, 50}, {16, 16, 16});
  packet.volumes = {volume_item(grid, {{0, 0.0}, {0.2, 0}, {1, 0.3}}, {0.9f, 0.6f, 0.3f})};
  packet.background = {0, 0, 0, 1};
  packet.width = 1024;
  packet.height = 768;
  packet.overlay.scalar_bars = {bar_of(Side::right), bar_of(Side::bottom), bar_of(Side::left), bar_of(Side::top)};
  packet.overlay.scalar_bars[0].factor = "×10⁻⁵";
  packet.overlay.texts = {{"A ball of fog, VA To 1.5 µm", Anchor::top, {0.0, 10.0}, 18, true, {}}};
  packet.overlay.labels = {{{16, 16, 16}, "centre", Anchor::left, {6.0, 0.0}, 12, Color{1, 0.9f, 0.2f}, true, false},
                           {{0, 0, 0}, "corner\n(0, 0, 0)", Anchor::top, {0.0, 6.0}, 10, {}, true, false}};
  packet.overlay.orientation_marker.emplace();
  packet.overlay.status =
      StatusItem{1.234, 8, {{"curve", "OK", true}, {"surface", "FREE", true}, {"plane", "BUDGET", true}}, Anchor::top_left};
  draw(packet, {}, "dark");
  packet.background = {1, 1, 1, 1};
  draw(packet, {}, "light");
  packet.background = {0, 0, 0, 0};
  packet.width = 640;
  packet.height = 480;
  draw(packet, {}, "clear");
}

}  // namespace
}  // namespace catena::test
