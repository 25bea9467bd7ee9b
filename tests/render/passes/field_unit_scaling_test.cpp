// SPDX-License-Identifier: MIT
/// An image does not depend on the field's unit: densities near 1e24 give the image of densities near 1.
#include "tests/render/support/image_fixture.h"

namespace catena::test {
namespace field_unit_scaling_test {

using namespace catena::render;

class Units : public ImageTest {
 protected:
  static GridPtr bump(double unit) {
    return make_grid({16, 16, 16}, [unit](const Vec3& p) { return unit * (1 - norm(p - Vec3(7.5)) / 8); });
  }
  static FramePacket view() { return make_packet({7.5, -30, 14}, Vec3(7.5)); }
};

constexpr double kUnits[] = {1e24, 1e-24};

TEST_F(Units, SlicesKeepTheirContours) {
  const auto at = [&](double unit) {
    FramePacket packet = view();
    SliceItem slice;
    slice.grid = bump(unit);
    slice.point = Vec3(7.5);
    slice.normal = {0, 1, 0.3};
    slice.colors = {{-unit, 0.1, 0.2, 0.9}, {unit, 0.9, 0.8, 0.1}};
    slice.contour_levels = {0.2 * unit, 0.5 * unit, 0.8 * unit};
    slice.line_width = 2;
    packet.slices = {slice};
    return draw(packet, {}, "unit");
  };
  const Image8 one = at(1);
  for (const double unit : kUnits) EXPECT_LE(max_difference(at(unit), one), 3) << unit;
}

TEST_F(Units, SurfacesKeepTheirLight) {
  const auto at = [&](double unit) {
    FramePacket packet = view();
    IsosurfaceItem surface;
    surface.grid = bump(unit);
    surface.level = 0.4 * unit;
    packet.isosurfaces = {surface};
    return draw(packet, {}, "unit");
  };
  const Image8 one = at(1);
  for (const double unit : kUnits) EXPECT_LE(max_difference(at(unit), one), 3) << unit;
}

TEST_F(Units, ShadedVolumesKeepTheirLight) {
  const auto at = [&](double unit) {
    FramePacket packet = view();
    VolumeItem volume = volume_item(bump(unit), {{0, 0}, {unit, 0.5}});
    volume.transfer.colors = {{0, 0.2, 0.4, 0.9}, {unit, 0.9, 0.6, 0.2}};
    volume.is_shaded = true;
    packet.volumes = {volume};
    return draw(packet, {}, "unit");
  };
  const Image8 one = at(1);
  for (const double unit : kUnits) EXPECT_LE(max_difference(at(unit), one), 3) << unit;
}

}  // namespace field_unit_scaling_test
}  // namespace catena::test
