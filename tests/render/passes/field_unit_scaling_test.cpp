// SPDX-License-Identifier: MIT
/// An image does not depend on the field's unit: densities near 1e24 give the image of densities near 1.
#include "tests/render/support/image_fixture.h"

namespace catena::test::field_unit_scaling_test {

using namespace catena::render;

class Units : public ImageTest {
 protected:
  static GridPtr bump(double unit) {
    return make_grid({16, 16, 16}, [unit](const Vec3& p) { return unit * (1 - norm(p - Vec3(7.5)) / 8); });
  }
  /// Compares the images of a packet that `add` fills for a unit.
  void expect_equal_images(const std::function<void(FramePacket&, double)>& add) {
    const auto at = [&](double unit) {
      FramePacket packet = make_packet({7.5, -30, 14}, Vec3(7.5));
      add(packet, unit);
      return draw(packet, {}, "unit");
    };
    const Image8 one = at(1);
    for (const double unit : {1e24, 1e-24}) EXPECT_LE(max_difference(at(unit), one), 3) << unit;
  }
};

TEST_F(Units, SlicesKeepTheirContours) {
  expect_equal_images([](FramePacket& packet, double unit) {
    packet.slices = {{bump(unit), Vec3(7.5), {0, 1, 0.3}, {{-unit, 0.1, 0.2, 0.9}, {unit, 0.9, 0.8, 0.1}}}};
    packet.slices[0].contour_levels = {0.2 * unit, 0.5 * unit, 0.8 * unit};
    packet.slices[0].line_width = 2;
  });
}

TEST_F(Units, SurfacesKeepTheirLight) {
  expect_equal_images([](FramePacket& packet, double unit) { packet.isosurfaces.push_back({bump(unit), 0.4 * unit, {}}); });
}

TEST_F(Units, ShadedVolumesKeepTheirLight) {
  expect_equal_images([](FramePacket& packet, double unit) {
    VolumeItem volume = volume_item(bump(unit), {{0, 0}, {unit, 0.5}});
    volume.transfer.colors = {{0, 0.2, 0.4, 0.9}, {unit, 0.9, 0.6, 0.2}};
    volume.is_shaded = true;
    packet.volumes = {volume};
  });
}

}  // namespace catena::test::field_unit_scaling_test
