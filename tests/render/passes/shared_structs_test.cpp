// SPDX-License-Identifier: MIT
/// Structs shared by GLSL and C++: member offsets of the shader compiler against those of C++.
#include <gtest/gtest.h>

#include <cstddef>

#include "shaders/shared/frame.h"
#include "shaders/shared/layers.h"
#include "shaders/shared/overlay.h"
#include "shaders/shared/stereo_compose.h"
#include "shaders/shared/tube.h"
#include "shaders/shared/ui.h"
#include "shaders/shared/vignette.h"
#include "tests/render/support/spirv.h"

namespace catena::test {
namespace shared_structs_test {

using namespace catena::render::shared;

#define EXPECT_OFFSET(Struct, member)                                            \
  EXPECT_EQ(found.at(#member), offsetof(Struct, member)) << #Struct "." #member; \
  ++compared

TEST(SharedStructs, FrameAndGridData) {
  for (const char* shader : {"blend.frag", "blend_cubic.frag", "blend_layers.frag", "blend_layers_cubic.frag", "volume.frag",
                             "projection.frag", "surface_color.frag", "isosurface.frag", "slice.frag", "sample.comp"}) {
    auto all = struct_offsets(shader_words(shader));
    std::size_t compared = 0;
    {
      const auto& found = all["GridData"];
      EXPECT_OFFSET(GridData, origin);
      EXPECT_OFFSET(GridData, origin_x);
      EXPECT_OFFSET(GridData, origin_y);
      EXPECT_OFFSET(GridData, direction);
      EXPECT_OFFSET(GridData, direction_x);
      EXPECT_OFFSET(GridData, direction_y);
      EXPECT_OFFSET(GridData, lo);
      EXPECT_OFFSET(GridData, hi);
      EXPECT_OFFSET(GridData, domain_lo);
      EXPECT_OFFSET(GridData, domain_hi);
      EXPECT_OFFSET(GridData, texel);
      EXPECT_OFFSET(GridData, world_gradient);
      EXPECT_OFFSET(GridData, value_offset);
      EXPECT_OFFSET(GridData, value_scale);
      EXPECT_OFFSET(GridData, value_table);
      EXPECT_OFFSET(GridData, gradient_table);
      EXPECT_OFFSET(GridData, bound_lo);
      EXPECT_OFFSET(GridData, bound_per_code);
      EXPECT_OFFSET(GridData, level);
      EXPECT_OFFSET(GridData, opacity);
      EXPECT_OFFSET(GridData, color);
      EXPECT_OFFSET(GridData, is_clipped);
      EXPECT_OFFSET(GridData, id);
      EXPECT_OFFSET(GridData, nearest);
      EXPECT_OFFSET(GridData, spread_labels);
      EXPECT_EQ(found.at("[]"), sizeof(GridData));
      EXPECT_EQ(found.size(), compared + 1);
    }
    if (all.contains("TableData")) {
      compared = 0;
      const auto& found = all["TableData"];
      EXPECT_OFFSET(TableData, start);
      EXPECT_OFFSET(TableData, last);
      EXPECT_OFFSET(TableData, control_points);
      EXPECT_OFFSET(TableData, per_linear);
      EXPECT_OFFSET(TableData, lo);
      EXPECT_OFFSET(TableData, entries_per_unit);
      EXPECT_OFFSET(TableData, first_value);
      EXPECT_OFFSET(TableData, last_value);
      EXPECT_EQ(found.size(), compared);
    }
    compared = 0;
    const auto& found = all["FrameData"];
    EXPECT_OFFSET(FrameData, half_size);
    EXPECT_OFFSET(FrameData, axis);
    EXPECT_OFFSET(FrameData, clip_count);
    EXPECT_OFFSET(FrameData, light_count);
    EXPECT_OFFSET(FrameData, lights);
    EXPECT_OFFSET(FrameData, fog);
    EXPECT_OFFSET(FrameData, clips);
    EXPECT_OFFSET(FrameData, slope);
    EXPECT_OFFSET(FrameData, right);
    EXPECT_OFFSET(FrameData, up);
    EXPECT_OFFSET(FrameData, forward);
    EXPECT_OFFSET(FrameData, reference_depth);
    EXPECT_OFFSET(FrameData, front_depth);
    EXPECT_OFFSET(FrameData, depth_near);
    EXPECT_OFFSET(FrameData, depth_far);
    EXPECT_OFFSET(FrameData, orthographic);
    EXPECT_OFFSET(FrameData, spacing);
    EXPECT_OFFSET(FrameData, first);
    EXPECT_OFFSET(FrameData, step_world);
    EXPECT_OFFSET(FrameData, termination);
    EXPECT_OFFSET(FrameData, grids);
    EXPECT_EQ(found.size(), compared);
  }
}

TEST(SharedStructs, Vignette) {
  auto all = struct_offsets(shader_words("vignette.frag"));
  const auto& found = all["VignetteData"];
  std::size_t compared = 0;
  EXPECT_OFFSET(VignetteData, first);
  EXPECT_OFFSET(VignetteData, step);
  EXPECT_OFFSET(VignetteData, strength);
  EXPECT_OFFSET(VignetteData, inner);
  EXPECT_OFFSET(VignetteData, outer);
  EXPECT_EQ(compared, found.size());
}

TEST(SharedStructs, TubeRingData) {
  auto all = struct_offsets(shader_words("tube.vert"));
  const auto& found = all["TubeRingData"];
  std::size_t compared = 0;
  EXPECT_OFFSET(TubeRingData, center);
  EXPECT_OFFSET(TubeRingData, radius);
  EXPECT_OFFSET(TubeRingData, normal_tilt);
  EXPECT_OFFSET(TubeRingData, tangent);
  EXPECT_OFFSET(TubeRingData, normal);
  EXPECT_OFFSET(TubeRingData, color);
  EXPECT_OFFSET(TubeRingData, id);
  EXPECT_EQ(found.at("[]"), sizeof(TubeRingData)) << "the stride of the array";
  EXPECT_EQ(found.size(), compared + 1);
}

TEST(SharedStructs, MeshFrameData) {
  auto all = struct_offsets(shader_words("mesh.vert"));
  const auto& found = all["MeshFrameData"];
  std::size_t compared = 0;
  EXPECT_OFFSET(MeshFrameData, view_from_world);
  EXPECT_OFFSET(MeshFrameData, offset);
  EXPECT_OFFSET(MeshFrameData, offset_depth);
  EXPECT_OFFSET(MeshFrameData, scale);
  EXPECT_OFFSET(MeshFrameData, shift);
  EXPECT_OFFSET(MeshFrameData, pixel);
  EXPECT_OFFSET(MeshFrameData, clip_count);
  EXPECT_OFFSET(MeshFrameData, light_count);
  EXPECT_OFFSET(MeshFrameData, lights);
  EXPECT_OFFSET(MeshFrameData, fog);
  EXPECT_OFFSET(MeshFrameData, clips);
  EXPECT_OFFSET(MeshFrameData, depth_near);
  EXPECT_OFFSET(MeshFrameData, depth_far);
  EXPECT_OFFSET(MeshFrameData, orthographic);
  EXPECT_EQ(found.size(), compared);
}

TEST(SharedStructs, StereoComposeAndAnaglyphData) {
  auto pack = struct_offsets(shader_words("stereo_compose.frag"));
  auto anaglyph = struct_offsets(shader_words("anaglyph.frag"));
  std::size_t compared = 0;
  {
    const auto& found = pack["StereoComposeData"];
    EXPECT_OFFSET(StereoComposeData, first);
    EXPECT_OFFSET(StereoComposeData, block_x);
    EXPECT_OFFSET(StereoComposeData, block_y);
    EXPECT_OFFSET(StereoComposeData, view);
    EXPECT_OFFSET(StereoComposeData, views);
    EXPECT_EQ(found.size(), compared);
  }
  const auto& found = anaglyph["AnaglyphData"];
  EXPECT_EQ(found.at("left"), offsetof(AnaglyphData, left));
  EXPECT_EQ(found.at("right"), offsetof(AnaglyphData, right));
}

TEST(SharedStructs, UiData) {
  auto all = struct_offsets(shader_words("ui.vert"));
  EXPECT_EQ(all["UiData"].at("half_size"), offsetof(UiData, half_size));
  EXPECT_EQ(all["UiData"].size(), 1u);
}

TEST(SharedStructs, LayerData) {
  for (const char* shader : {"layer_mesh.frag", "slice.frag"}) {
    auto all = struct_offsets(shader_words(shader));
    const auto& found = all["LayerData"];
    std::size_t compared = 0;
    EXPECT_OFFSET(LayerData, reference_depth);
    EXPECT_OFFSET(LayerData, depth_near);
    EXPECT_OFFSET(LayerData, depth_far);
    EXPECT_OFFSET(LayerData, orthographic);
    EXPECT_OFFSET(LayerData, opacity);
    EXPECT_EQ(found.size(), compared);
  }
}

TEST(SharedStructs, SliceData) {
  auto all = struct_offsets(shader_words("slice.frag"));
  const auto& found = all["SliceData"];
  std::size_t compared = 0;
  EXPECT_OFFSET(SliceData, plane);
  EXPECT_OFFSET(SliceData, normal);
  EXPECT_OFFSET(SliceData, clip_slack);
  EXPECT_OFFSET(SliceData, is_lit);
  EXPECT_OFFSET(SliceData, color_last);
  EXPECT_OFFSET(SliceData, level_count);
  EXPECT_OFFSET(SliceData, line_color);
  EXPECT_OFFSET(SliceData, half_width);
  EXPECT_OFFSET(SliceData, depth_bias);
  EXPECT_OFFSET(SliceData, hidden_label);
  EXPECT_EQ(found.size(), compared);
}

TEST(SharedStructs, ComposeData) {
  auto all = struct_offsets(shader_words("compose.frag"));
  EXPECT_EQ(all["ComposeData"].at("background"), offsetof(ComposeData, background));
}

TEST(SharedStructs, Overlay) {
  for (const char* shader : {"overlay.vert", "overlay.frag"}) {
    auto all = struct_offsets(shader_words(shader));
    const auto& found = all["OverlayShape"];
    std::size_t compared = 0;
    EXPECT_OFFSET(OverlayShape, origin);
    EXPECT_OFFSET(OverlayShape, axis_x);
    EXPECT_OFFSET(OverlayShape, axis_y);
    EXPECT_OFFSET(OverlayShape, lo);
    EXPECT_OFFSET(OverlayShape, hi);
    EXPECT_OFFSET(OverlayShape, color);
    EXPECT_OFFSET(OverlayShape, size);
    EXPECT_OFFSET(OverlayShape, texel);
    EXPECT_OFFSET(OverlayShape, first_stop);
    EXPECT_OFFSET(OverlayShape, last_stop);
    EXPECT_OFFSET(OverlayShape, kind);
    EXPECT_OFFSET(OverlayShape, anchor);
    EXPECT_OFFSET(OverlayShape, occlusion_depth);
    EXPECT_EQ(found.at("[]"), sizeof(OverlayShape));
    EXPECT_EQ(found.size(), compared + 1);
  }
  std::size_t compared = 0;
  auto all = struct_offsets(shader_words("overlay.frag"));
  {
    const auto& found = all["OverlayStop"];
    EXPECT_OFFSET(OverlayStop, position);
    EXPECT_OFFSET(OverlayStop, color);
    EXPECT_EQ(found.at("[]"), sizeof(OverlayStop));
  }
  all = struct_offsets(shader_words("overlay.vert"));
  const auto& found = all["OverlayData"];
  EXPECT_OFFSET(OverlayData, half_size);
  EXPECT_OFFSET(OverlayData, depth_slack);
  EXPECT_OFFSET(OverlayData, has_depth);
  EXPECT_EQ(compared, 5u);
}

}  // namespace shared_structs_test
}  // namespace catena::test
