// SPDX-License-Identifier: MIT
/// Images against reviewed golden images (tests/golden), with two tolerances: on the RMS error of the whole image, and on the fraction of
/// pixels with a large error. CATENA_GOLDEN_WRITE=1 writes the golden images: review them before a commit.
#include <cmath>
#include <cstdlib>

#include "tests/engine/app/program_in_folder.h"

namespace catena::golden_test {

constexpr double kMaxRmse = 0.5;   // maximum RMS error of 8-bit RGB
constexpr int kFar = 8;            // a pixel with a larger error counts as far
constexpr double kMaxFar = 0.002;  // maximum fraction of far pixels

struct Golden {
  const char* name;
  const char* scene;
};

constexpr Golden kGoldens[] = {
    {"surface-volume-tube", R"("volumes": [{"field": "s", "color": "viridis", "extinction": [[0.2, 0], [1, 0.7], [1.8, 0]], "shade": true}],
      "isosurfaces": [{"field": "t", "level": 0.25, "color": [0.9, 0.8, 0.6]}],
      "streamlines": [{"field": "h", "seeds": [[1, 0, 0.3], [0.6, 0.2, -0.5]], "radius": 0.05}])"},
    {"slices-clip-fog", R"("slices": [{"field": "t", "axis": "z", "at": 0, "color": "cool-warm", "contours": {"count": 6}},
      {"field": "s", "point": [0, 0.4, 0], "normal": [0.2, 1, 0.1], "color": "inferno", "opacity": 0.6}],
      "isosurfaces": [{"field": "s", "level": 1.4, "opacity": 0.4, "color": [0.5, 0.7, 1]}],
      "clip": [{"plane": {"point": [0, -0.9, 0], "normal": [0, 1, 0.2]}}], "fog": true, "background": [0.2, 0.2, 0.25])"},
    {"aids-lights-stereo", R"("isosurfaces": [{"field": "t", "level": 0.3, "color": [0.8, 0.3, 0.3]}], "bounding_box": true, "ground": true,
      "lights": [{"direction": [1, -1, 1]}, {"direction": [-1, 0, 0.5], "color": [0.3, 0.4, 1], "fixed_to": "camera"}],
      "stereo": {"mode": "anaglyph"})"}};

std::string scene_of(const Golden& golden) {
  return std::string(R"({"fields": {"s": {"analytic": "sphere", "resolution": 33}, "t": {"analytic": "torus", "resolution": 33},
      "h": {"analytic": "hill"}}, )") +
         golden.scene + R"(, "camera": {"position": [3, -7, 4], "target": [0, 0, 0], "fovy_deg": 32}})";
}

class GoldenImage : public test::ProgramInFolder, public testing::WithParamInterface<Golden> {};

TEST_P(GoldenImage, EqualsTheReviewedImage) {
  write("s.json", scene_of(GetParam()));
  const render::Image8 found = drawn("{s.json} --size 192x144 --quality step=0.5");
  const std::string path = test::source_dir() + "/tests/golden/" + GetParam().name + ".png";
  if (std::getenv("CATENA_GOLDEN_WRITE") != nullptr) {
    ASSERT_TRUE(render::write_png(path, found, false));
  }
  const auto golden = render::read_png(path);
  ASSERT_TRUE(golden) << path;
  ASSERT_EQ(found.rgba.size(), golden->rgba.size());
  double squares = 0;
  std::size_t far_pixels = 0;
  const std::size_t pixels = found.rgba.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = found.rgba[4 * i + c] - golden->rgba[4 * i + c];
      squares += d * d;
      worst = std::max(worst, std::abs(d));
    }
    far_pixels += worst > kFar;
  }
  EXPECT_LE(std::sqrt(squares / (3.0 * double(pixels))), kMaxRmse);
  EXPECT_LE(double(far_pixels) / double(pixels), kMaxFar);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenImage, testing::ValuesIn(kGoldens), [](const auto& golden) {
  std::string name = golden.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

}  // namespace catena::golden_test
