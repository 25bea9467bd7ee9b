// SPDX-License-Identifier: MIT
/// `catena render` of slices and translucent meshes.

#include "render/image/image.h"
#include "tests/engine/app/program_in_folder.h"

namespace render_slices_test {

using namespace catena;

class RenderSlices : public test::ProgramInFolder {};

/// A slice of z at y = 0, -2..2, black to blue, with a white contour at 1; in front of the right half a red mesh of opacity 0.5.
const std::string kScene = R"({"fields": {"z": {"analytic": "plane", "resolution": 17}},
  "slices": [{"field": "z", "axis": "y", "at": 0, "color": [[-2, 0, 0, 0], [2, 0, 0, 1]], OPACITY
              "contours": {"levels": [1], "width": 2, "color": [1, 1, 1]}}],
  "meshes": [{"name": "m", "file": "quad.obj", "color": [1, 0, 0], "opacity": 0.5, "shading": "smooth"}],
  "camera": {"position": [0, -10, 0], "target": [0, 0, 0], "up": [0, 0, 1], "projection": "orthographic", "height": 4.8}})";

TEST_F(RenderSlices, ASliceWithAContourBehindATranslucentMesh) {
  write("quad.obj", "v 0 -1 -3\nv 3 -1 -3\nv 3 -1 3\nv 0 -1 3\nf 1 2 3 4\n");
  for (const double opacity : {1.0, 0.5}) {
    std::string scene = kScene;
    scene.replace(scene.find("OPACITY"), 7, "\"opacity\": " + std::to_string(opacity) + ",");
    write("s.json", scene);
    succeed("render {s.json} -o {o.png} --size 128x96 --validation --stats {o.json}");
    test::expect_parts(read("o.json"), {"\"validation_messages\": 0"});
    const auto picture = render::read_png(folder_ / "o.png");
    ASSERT_TRUE(picture);
    EXPECT_TRUE(render::write_png(test::binary_dir() + "/app-slice-" + (opacity < 1 ? "half" : "whole") + ".png", *picture, true));
    for (const std::uint32_t y : {10u, 40u, 60u, 84u}) {
      const double z = 2.4 - (y + 0.5) * 0.05, blue = 255 * opacity * (z + 2) / 4;  // 0.05 a pixel
      EXPECT_NEAR(picture->pixel(40, y)[2], blue, 2) << y;
      EXPECT_EQ(picture->pixel(40, y)[0], 0);
      // The mesh in front: 0.5 of the lit red (facing the camera, with a white highlight of 0.2).
      EXPECT_NEAR(picture->pixel(90, y)[0], 0.5 * 255 * 1.1, 2) << y;
      EXPECT_NEAR(picture->pixel(90, y)[2], 0.5 * 255 * 0.2 + 0.5 * blue, 2) << y;
    }
    EXPECT_GT(picture->pixel(40, 27)[0] + picture->pixel(40, 28)[0], 400) << "the line of z = 1";
    EXPECT_EQ(picture->pixel(10, 48)[2], 0) << "beside the domain";
  }
}

TEST_F(RenderSlices, ASliceOutsideTheDomainIsOneErrorLine) {
  write("s.json", R"({"fields": {"z": {"analytic": "plane", "resolution": 9}},
    "slices": [{"field": "z", "axis": "y", "at": 7}]})");
  expect_refused("render {s.json} -o {o.png}", {"s.json:2", "does not meet the domain"});
}

}  // namespace render_slices_test
