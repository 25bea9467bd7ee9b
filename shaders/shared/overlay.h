// The overlay's shapes (render/passes/overlay/canvas.h). A shape is a rectangle of its own coordinates, in pixels:
//   place in the picture = origin + x axis_x + y axis_y,  lo <= (x, y) <= hi,  axes unit and orthogonal
#ifndef CATENA_SHARED_OVERLAY_H
#define CATENA_SHARED_OVERLAY_H
#include "shaders/shared/language.h"

#define OVERLAY_BOX 0      // size: half width, half height, corners' radius, width of the stroke (0: filled)
#define OVERLAY_RAMP 1     // a filled box whose colour goes through the stops from its low to its high x
#define OVERLAY_GLYPH 2    // the atlas' texels from `texel` on, one a pixel
#define OVERLAY_TUBE 3     // a box lit like a cylinder along x
#define OVERLAY_CONE 4     // from (0, 0) with half width size.y to the tip (size.x, 0), lit like a cone
#define OVERLAY_ELLIPSE 5  // half axes size.xy, lit like a ball where size.z is 1

CATENA_SHARED_BEGIN

struct OverlayShape {
  vec2 origin, axis_x, axis_y;
  vec2 lo, hi;
  vec4 color;  // straight alpha
  vec4 size;
  vec2 texel;
  uint first_stop, last_stop;
  uint kind;
  // hidden where an opaque surface lies before this depth (from the reference depth) in this pixel; NO_DEPTH: never
  vec2 anchor;
  float occlusion_depth;
};

// Place 0 .. 1 along a ramp and the colour there.
struct OverlayStop {
  float position;
  vec3 color;
};

struct OverlayData {
  vec2 half_size;     // of the picture, pixels
  float depth_slack;  // world units
  uint has_depth;
};

CATENA_SHARED_END
#endif
