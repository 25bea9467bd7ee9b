// SPDX-License-Identifier: MIT
// Translucent layers (render/passes/passes.h) and slices: shader data in addition to the frame data.
#ifndef CATENA_SHARED_LAYERS_H
#define CATENA_SHARED_LAYERS_H
#include "shaders/shared/frame.h"
#include "shaders/shared/language.h"

#define MODE_OPAQUE 0  // into the opaque targets
#define MODE_FIRST 1   // nearest layer
#define MODE_LAYER 2   // nearest fragments behind the previous layer
#define MODE_TAIL 3    // tail: all fragments behind the previous layer, averaged

CATENA_SHARED_BEGIN

// Depth range of the frame, and opacity of the item.
struct LayerData {
  float reference_depth;
  float depth_near, depth_far;  // as in FrameData
  uint orthographic;
  float opacity;
};

// Slice plane, its appearance and its contour lines.
struct SliceData {
  ClipData plane;    // signed distance from the plane, along the pixel's ray
  vec3 normal;       // unit vector, world axes
  float clip_slack;  // tolerance of clipping, world units: a slice that lies in a clip plane is not cut
  uint is_lit;
  uint color_last;  // last row of the color table
  uint level_count;
  vec3 line_color;
  float half_width;  // half of the line width, pixels
  // Shift towards the camera, as a share of the distance, to be over surfaces and earlier slices in the same plane.
  float depth_bias;
  float hidden_label;  // values within 0.5 of it are not drawn; NaN: no value is hidden
  vec4 threshold;      // only values from x to y and from z to w are drawn
  // Texture of line integral convolution: signed distances from its first column and row, texels per world unit, size; width 0: none.
  ClipData texture_u, texture_v;
  float texels_per_unit;
  uint texture_width, texture_height;
  float texture_strength;
  vec2 texture_phase;  // cosine and sine
};

CATENA_SHARED_END
#endif
