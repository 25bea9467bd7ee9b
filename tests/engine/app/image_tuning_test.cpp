// SPDX-License-Identifier: MIT
/// Tuning of image quality: adaptation to frame times, and the candidate settings.
#include <gtest/gtest.h>

#include <set>

#include "engine/scene/prepare.h"
#include "render/extract/extract.h"
#include "render/quality/quality.h"
#include "tests/engine/app/tuning_fixtures.h"
#include "tests/support/results.h"

namespace tuning_test {

TEST(ImageTuning, AdaptsToFrameTimes) {
  ImageTuning plan(image_curve(), parse_target("time=11"));
  EXPECT_EQ(plan.settings().step_voxels, 1);
  EXPECT_EQ(plan.expected_ms(), 10);
  // The machine is three times as slow.
  for (int k = 0; k < 20; ++k) plan.record_frame_time(3 * four_point_curve().points[static_cast<std::size_t>(plan.current())].time.median);
  EXPECT_EQ(plan.settings().step_voxels, 4);
  EXPECT_NEAR(plan.expected_ms(), 3, 1);
  // The machine has its original speed.
  for (int k = 0; k < 40; ++k) plan.record_frame_time(four_point_curve().points[static_cast<std::size_t>(plan.current())].time.median);
  EXPECT_LE(plan.settings().step_voxels, 2);
}

TEST(ImageTuning, MeetsItsErrorAtAnyFrameTime) {
  ImageTuning plan(image_curve(), parse_target("error=1"));
  for (int k = 0; k < 20; ++k) {
    plan.record_frame_time(k % 2 ? 300 : 1);
    EXPECT_LE(plan.expected_error(), 1);
  }
  plan.set_targets(parse_target("error=0.01"));
  EXPECT_TRUE(test::has(plan.summary(), "the target is not reached: most accurate setting"));
}

TEST(ImageTuning, OnlyTheProgramsSettingsAreAccepted) {
  const render::QualityLevelOptions kind{true, false};
  const std::vector<render::RenderSettings> all = candidate_image_settings(kind);
  Curve curve;
  for (const auto& settings : all) curve.points.push_back(make_point(1, 1, render::describe(settings)));
  const auto back = to_image_curve(curve, kind);
  ASSERT_TRUE(back);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(render::describe(back->settings[i]), render::describe(all[i]));
  curve.points[1].error = 1e308;  // no image has such an error
  EXPECT_FALSE(to_image_curve(curve, kind));
  curve.points[1].error = 1;
  curve.points[1].setting = "fast, step -1";
  EXPECT_FALSE(to_image_curve(curve, kind));
}

TEST(ImageTuning, TakesTheVoxelFormatOfFewerBytes) {
  ImageCurve made_curve;
  const auto add = [&](double error, double time, double bytes, render::TexelFormat texels) {
    made_curve.settings.push_back(render::exact_level(1));
    made_curve.settings.back().texel_format = texels;
    made_curve.curve.points.push_back(make_point(error, time, render::describe(made_curve.settings.back())));
    made_curve.curve.points.back().bytes = bytes;
  };
  add(0.5, 10, 4e6, render::TexelFormat::automatic);
  add(0.8, 10.3, 2e6, render::TexelFormat::r16f);
  made_curve.curve.discretization_error = 0.4;
  const auto texels = [&](const char* words) { return ImageTuning(made_curve, parse_target(words)).settings().texel_format; };
  EXPECT_EQ(texels("error=1"), render::TexelFormat::r16f);
  EXPECT_EQ(texels("error=0.6"), render::TexelFormat::automatic);  // error too large
  EXPECT_EQ(texels("time=20"), render::TexelFormat::automatic);    // smallest error
  EXPECT_TRUE(test::has(ImageTuning(made_curve, parse_target("error=1")).summary(),
                        "16 bits a voxel; expected: error 0.8/255 in 10.3 ms, 1.91 MiB"));
  made_curve.curve.points[1].time = {14, 13.9, 14.1, 9};
  EXPECT_EQ(texels("error=1"), render::TexelFormat::automatic);  // much slower
}

TEST(ImageTuning, OffersVoxelFormatsOnlyWhereRaysReadVoxels) {
  using render::TexelFormat;
  const auto grid = field::make_scalar_grid("g", {}, {8, 8, 8}, std::vector<float>(512, 1));
  const auto labels = grid->with_interpolation(field::Interpolation::nearest);
  const auto offered = [](const render::FramePacket& packet) {
    std::set<TexelFormat> formats;
    auto all = candidate_image_settings({false, false}, packet);
    all.pop_back();  // the reference has 32 bits
    for (const render::RenderSettings& s : all) formats.insert(s.texel_format);
    return formats;
  };
  const std::set<TexelFormat> one{TexelFormat::automatic};
  render::FramePacket packet;
  packet.volumes.emplace_back().grid = grid;
  EXPECT_EQ(offered(packet), (std::set{TexelFormat::automatic, TexelFormat::r32f}));
  packet.isosurfaces.emplace_back().grid = grid;
  packet.isosurfaces[0].opacity = 0.5;  // a translucent isosurface needs 32-bit voxels by default
  EXPECT_EQ(offered(packet), (std::set{TexelFormat::automatic, TexelFormat::r16f}));
  packet.isosurfaces[0].opacity = 1;  // an opaque isosurface is not sampled along rays
  EXPECT_EQ(offered(packet), one);
  packet.isosurfaces[0].opacity = 0.5;
  packet.volumes[0].grid = labels;  // rounding would change labels
  EXPECT_EQ(offered(packet), one);
  // Fast rays have a format of their own.
  for (const render::RenderSettings& s : candidate_image_settings({true, true}))
    if (s.fast) {
      EXPECT_EQ(s.texel_format, TexelFormat::automatic);
    }
}

TEST(ImageTuning, ErrorsBelowTheReportedMinimumAreEqual) {
  auto scene = test::value_of(scene::parse_scene(R"({"fields": {"ball": {"analytic": "sphere", "resolution": 24}},
    "volumes": [{"field": "ball", "color": "viridis", "range": [0.2, 2], "opacity": [[0.2, 0.3], [2, 0]]}]})",
                                                 "s.json"));
  test::value_of(scene::prepare(scene));
  const auto packet = test::value_of(render::make_frame(scene, 64, 48));
  const auto renderer = test::value_of(render::Renderer::create({}));
  const auto kind = test::value_of(detect_quality_level_options(*renderer, packet));
  auto measured = test::value_of(measure_image_curve(*renderer, packet, kind, [](double) {}));
  // Among settings whose errors are below the reported minimum, the cheapest is chosen for any time.
  measured.curve.discretization_error = app::tuning::kNotMeasured;
  auto& points = measured.curve.points;
  ASSERT_GE(points.size(), 3u);
  const int cheapest = int(points.size()) - 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].error = 9;
    points[i].time = {1.0 + double(i), 1.0 + double(i), 1.0 + double(i), 5};
  }
  points[points.size() - 2].error = 1.4 * render::kMinReportedRmse;
  points[points.size() - 1].error = 0.05;
  EXPECT_EQ(ImageTuning(measured, parse_target("time=1000")).current(), cheapest);
  EXPECT_EQ(ImageTuning(measured, parse_target("error=0.01")).current(), cheapest);
}

}  // namespace tuning_test
