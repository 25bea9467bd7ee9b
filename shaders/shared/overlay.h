// SPDX-License-Identifier: MIT
// Shapes of the overlay (render/passes/overlay/canvas.h). A shape is a rectangle in its own coordinates, in pixels:
//   position in the image = origin + x axis_x + y axis_y,  lo <= (x, y) <= hi,  axes are orthogonal unit vectors
#ifndef CATENA_SHARED_OVERLAY_H
#define CATENA_SHARED_OVERLAY_H
#include "shaders/shared/language.h"

#define OVERLAY_BOX 0      // size: half width, half height, corner radius, stroke width (0: filled)
#define OVERLAY_RAMP 1     // filled box whose color follows the stops from its low to its high x
#define OVERLAY_GLYPH 2    // texels of the glyph atlas from `texel` on, one per pixel
#define OVERLAY_TUBE 3     // box shaded like a cylinder along x
#define OVERLAY_CONE 4     // from (0, 0) with half width size.y to the tip (size.x, 0), shaded like a cone
#define OVERLAY_ELLIPSE 5  // half axes size.xy, shaded like a sphere if size.z is 1

CATENA_SHARED_BEGIN

// One shape; the meaning of `size` depends on `kind`.
struct OverlayShape {
  vec2 origin, axis_x, axis_y;
  vec2 lo, hi;
  vec4 color;  // straight alpha
  vec4 size;
  vec2 texel;
  uint first_stop, last_stop;
  uint kind;
  // hidden where an opaque surface is nearer than this depth t at the pixel of `anchor`; NO_DEPTH: never
  vec2 anchor;
  float occlusion_depth;
};

// Color stop at a position 0 .. 1 along a ramp.
struct OverlayStop {
  float position;
  vec3 color;
};

// Data of the overlay pass.
struct OverlayData {
  vec2 half_size;     // half of the image size, pixels
  float depth_slack;  // tolerance of the occlusion test, world units
  uint has_depth;
};

CATENA_SHARED_END
#endif
