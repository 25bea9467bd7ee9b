// SPDX-License-Identifier: MIT
/// Structs shared by GLSL and C++: member offsets of the shader compiler against those of C++.
#include <gtest/gtest.h>

#include <cstddef>

#include "shaders/shared/fast_volume.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/layers.h"
#include "shaders/shared/overlay.h"
#include "shaders/shared/stereo_compose.h"
#include "shaders/shared/tube.h"
#include "shaders/shared/ui.h"
#include "shaders/shared/vignette.h"
#include "tests/render/support/spirv.h"

namespace catena::test::shared_structs_test {

using namespace catena::render::shared;

using Offsets = std::map<std::string, std::uint32_t>;

/// A member's name and its offset in C++.
#define MEMBER(Struct, member) \
  { #member, std::uint32_t(offsetof(Struct, member)) }
/// The stride of an array of a struct.
#define STRIDE(Struct) \
  { "[]", std::uint32_t(sizeof(Struct)) }

/// Checks that a struct has exactly these members, at these offsets, in every one of the shaders.
void expect_offsets(const std::vector<const char*>& shaders, const std::string& name, const Offsets& members) {
  for (const char* shader : shaders) EXPECT_EQ(struct_offsets(shader_words(shader))[name], members) << shader << " " << name;
}

TEST(SharedStructs, FrameAndGridData) {
  const std::vector<const char*> shaders{"blend.frag",  "blend_cubic.frag", "blend_layers.frag",  "blend_layers_cubic.frag",
                                         "volume.frag", "projection.frag",  "surface_color.frag", "isosurface.frag",
                                         "slice.frag",  "sample.comp"};
  Offsets grid{
      MEMBER(GridData, origin),        MEMBER(GridData, origin_x),       MEMBER(GridData, origin_y),     MEMBER(GridData, direction),
      MEMBER(GridData, direction_x),   MEMBER(GridData, direction_y),    MEMBER(GridData, lo),           MEMBER(GridData, hi),
      MEMBER(GridData, domain_lo),     MEMBER(GridData, domain_hi),      MEMBER(GridData, texel),        MEMBER(GridData, world_gradient),
      MEMBER(GridData, value_offset),  MEMBER(GridData, value_scale),    MEMBER(GridData, value_table),  MEMBER(GridData, gradient_table),
      MEMBER(GridData, bound_lo),      MEMBER(GridData, bound_per_code), MEMBER(GridData, level),        MEMBER(GridData, opacity),
      MEMBER(GridData, color),         MEMBER(GridData, is_clipped),     MEMBER(GridData, id),           MEMBER(GridData, nearest),
      MEMBER(GridData, spread_labels), MEMBER(GridData, anisotropy),     MEMBER(GridData, surface_share)};
  grid["[]"] = sizeof(GridData);
  expect_offsets(shaders, "GridData", grid);
  expect_offsets(
      shaders, "FrameData",
      {MEMBER(FrameData, half_size),       MEMBER(FrameData, axis),        MEMBER(FrameData, clip_count), MEMBER(FrameData, light_count),
       MEMBER(FrameData, lights),          MEMBER(FrameData, sky),         MEMBER(FrameData, ground),     MEMBER(FrameData, zenith),
       MEMBER(FrameData, light_grid),      MEMBER(FrameData, look),        MEMBER(FrameData, fog),        MEMBER(FrameData, clips),
       MEMBER(FrameData, slope),           MEMBER(FrameData, right),       MEMBER(FrameData, up),         MEMBER(FrameData, forward),
       MEMBER(FrameData, reference_depth), MEMBER(FrameData, front_depth), MEMBER(FrameData, depth_near), MEMBER(FrameData, depth_far),
       MEMBER(FrameData, orthographic),    MEMBER(FrameData, spacing),     MEMBER(FrameData, first),      MEMBER(FrameData, step_world),
       MEMBER(FrameData, termination),     MEMBER(FrameData, grids)});
  expect_offsets(
      shaders, "LightGridData",
      {MEMBER(LightGridData, origin), MEMBER(LightGridData, origin_x), MEMBER(LightGridData, origin_y), MEMBER(LightGridData, direction),
       MEMBER(LightGridData, direction_x), MEMBER(LightGridData, direction_y), MEMBER(LightGridData, from_view),
       MEMBER(LightGridData, from_normal), MEMBER(LightGridData, is_on), MEMBER(LightGridData, half_cell),
       MEMBER(LightGridData, half_plane), MEMBER(LightGridData, from_world), MEMBER(LightGridData, version)});
  expect_offsets(shaders, "LookData",
                 {MEMBER(LookData, diffuse), MEMBER(LookData, specular), MEMBER(LookData, scattered), MEMBER(LookData, zenith_share),
                  MEMBER(LookData, is_linear)});
  const Offsets table{MEMBER(TableData, start),       MEMBER(TableData, last),      MEMBER(TableData, control_points),
                      MEMBER(TableData, per_linear),  MEMBER(TableData, lo),        MEMBER(TableData, entries_per_unit),
                      MEMBER(TableData, first_value), MEMBER(TableData, last_value)};
  for (const char* shader : shaders) {
    auto all = struct_offsets(shader_words(shader));
    if (all.contains("TableData")) {
      EXPECT_EQ(all["TableData"], table) << shader;
    }
  }
}

TEST(SharedStructs, PageLevels) {
  Offsets level{MEMBER(PageLevelData, scale), MEMBER(PageLevelData, offset), MEMBER(PageLevelData, last_xy),
                MEMBER(PageLevelData, last_z_shifts)};
  level["[]"] = sizeof(PageLevelData);
  expect_offsets({"volume_paged.frag"}, "PageLevelData", level);
}

TEST(SharedStructs, Vignette) {
  expect_offsets({"vignette.frag"}, "VignetteData",
                 {MEMBER(VignetteData, first), MEMBER(VignetteData, step), MEMBER(VignetteData, strength), MEMBER(VignetteData, inner),
                  MEMBER(VignetteData, outer)});
}

TEST(SharedStructs, TubeRingData) {
  expect_offsets(
      {"tube.vert"}, "TubeRingData",
      {MEMBER(TubeRingData, center), MEMBER(TubeRingData, radius), MEMBER(TubeRingData, normal_tilt), MEMBER(TubeRingData, tangent),
       MEMBER(TubeRingData, normal), MEMBER(TubeRingData, color), MEMBER(TubeRingData, id), STRIDE(TubeRingData)});
}

TEST(SharedStructs, MeshFrameData) {
  expect_offsets({"mesh.vert"}, "MeshFrameData",
                 {MEMBER(MeshFrameData, view_from_world), MEMBER(MeshFrameData, offset), MEMBER(MeshFrameData, offset_depth),
                  MEMBER(MeshFrameData, scale), MEMBER(MeshFrameData, shift), MEMBER(MeshFrameData, pixel),
                  MEMBER(MeshFrameData, clip_count), MEMBER(MeshFrameData, light_count), MEMBER(MeshFrameData, lights),
                  MEMBER(MeshFrameData, sky), MEMBER(MeshFrameData, ground), MEMBER(MeshFrameData, zenith),
                  MEMBER(MeshFrameData, light_grid), MEMBER(MeshFrameData, look), MEMBER(MeshFrameData, fog), MEMBER(MeshFrameData, clips),
                  MEMBER(MeshFrameData, depth_near), MEMBER(MeshFrameData, depth_far), MEMBER(MeshFrameData, orthographic)});
}

TEST(SharedStructs, StereoComposeAndAnaglyphData) {
  expect_offsets({"stereo_compose.frag"}, "StereoComposeData",
                 {MEMBER(StereoComposeData, first), MEMBER(StereoComposeData, block_x), MEMBER(StereoComposeData, block_y),
                  MEMBER(StereoComposeData, view), MEMBER(StereoComposeData, views)});
  auto anaglyph = struct_offsets(shader_words("anaglyph.frag"));
  const auto& found = anaglyph["AnaglyphData"];
  EXPECT_EQ(found.at("left"), offsetof(AnaglyphData, left));
  EXPECT_EQ(found.at("right"), offsetof(AnaglyphData, right));
}

TEST(SharedStructs, UiData) { expect_offsets({"ui.vert"}, "UiData", {MEMBER(UiData, half_size)}); }

TEST(SharedStructs, LayerData) {
  expect_offsets({"layer_mesh.frag", "slice.frag"}, "LayerData",
                 {MEMBER(LayerData, reference_depth), MEMBER(LayerData, depth_near), MEMBER(LayerData, depth_far),
                  MEMBER(LayerData, orthographic), MEMBER(LayerData, opacity)});
}

TEST(SharedStructs, SliceData) {
  expect_offsets(
      {"slice.frag"}, "SliceData",
      {MEMBER(SliceData, plane), MEMBER(SliceData, normal), MEMBER(SliceData, clip_slack), MEMBER(SliceData, is_lit),
       MEMBER(SliceData, color_last), MEMBER(SliceData, level_count), MEMBER(SliceData, line_color), MEMBER(SliceData, half_width),
       MEMBER(SliceData, depth_bias), MEMBER(SliceData, hidden_label), MEMBER(SliceData, threshold), MEMBER(SliceData, texture_u),
       MEMBER(SliceData, texture_v), MEMBER(SliceData, texels_per_unit), MEMBER(SliceData, texture_width),
       MEMBER(SliceData, texture_height), MEMBER(SliceData, texture_strength), MEMBER(SliceData, texture_phase)});
}

TEST(SharedStructs, ComposeData) {
  auto all = struct_offsets(shader_words("compose.frag"));
  EXPECT_EQ(all["ComposeData"].at("background"), offsetof(ComposeData, background));
}

TEST(SharedStructs, Overlay) {
  expect_offsets({"overlay.vert", "overlay.frag"}, "OverlayShape",
                 {MEMBER(OverlayShape, origin), MEMBER(OverlayShape, axis_x), MEMBER(OverlayShape, axis_y), MEMBER(OverlayShape, lo),
                  MEMBER(OverlayShape, hi), MEMBER(OverlayShape, color), MEMBER(OverlayShape, size), MEMBER(OverlayShape, texel),
                  MEMBER(OverlayShape, first_stop), MEMBER(OverlayShape, last_stop), MEMBER(OverlayShape, kind),
                  MEMBER(OverlayShape, anchor), MEMBER(OverlayShape, occlusion_depth), STRIDE(OverlayShape)});
  expect_offsets({"overlay.frag"}, "OverlayStop", {MEMBER(OverlayStop, position), MEMBER(OverlayStop, color), STRIDE(OverlayStop)});
  auto all = struct_offsets(shader_words("overlay.vert"));
  const auto& found = all["OverlayData"];
  EXPECT_EQ(found.at("half_size"), offsetof(OverlayData, half_size));
  EXPECT_EQ(found.at("depth_slack"), offsetof(OverlayData, depth_slack));
  EXPECT_EQ(found.at("has_depth"), offsetof(OverlayData, has_depth));
}

}  // namespace catena::test::shared_structs_test
