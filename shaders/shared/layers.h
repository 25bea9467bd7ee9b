// What is drawn into translucent layers (render/passes/passes.h), and slices, need beside the frame's data.
#ifndef CATENA_SHARED_LAYERS_H
#define CATENA_SHARED_LAYERS_H
#include "shaders/shared/frame.h"
#include "shaders/shared/language.h"

#define MODE_OPAQUE 0  // into the opaque targets
#define MODE_FIRST 1   // the nearest layer
#define MODE_LAYER 2   // the nearest that lies behind the layer before
#define MODE_TAIL 3    // all that lies behind the layer before, collected

CATENA_SHARED_BEGIN

struct LayerData {
  float reference_depth;
  float depth_near, depth_far;  // as FrameData
  uint orthographic;
  float opacity;
};

struct SliceData {
  ClipData plane;    // the distance from it, along the pixel's ray
  vec3 normal;       // unit, world
  float clip_slack;  // a slice that lies in a clip plane is kept: world units
  uint is_lit;
  uint color_last;  // the table's last row
  uint level_count;
  vec3 line_color;
  float half_width;    // of the lines, pixels
  float depth_bias;    // this share of its distance nearer to the eye: over surfaces in its plane, and over earlier slices in it
  float hidden_label;  // within a half of this value nothing is drawn; NaN: everywhere
};

CATENA_SHARED_END
#endif
