// The fast raycast of one packed volume (render/raycast/fast_volume.h): what its passes need beside FrameData, whose grid 0 is the
// packed volume with positions counted from its first voxel.
#ifndef CATENA_SHARED_FAST_VOLUME_H
#define CATENA_SHARED_FAST_VOLUME_H
#include "shaders/shared/language.h"

#define COARSE_APRON 2

CATENA_SHARED_BEGIN

// A lattice of rays: texel `at` is the ray through the centre of pixel spacing * (at - apron).
struct RayGridData {
  float spacing;                 // pixels
  float apron;                   // texels before the picture's first; coarser lattices have COARSE_APRON
  float threshold;               // a block is marched where interpolation is expected to err by more (display units),
  vec2 gaze, per_fovea;          // times max(1, |(pixel - gaze) per_fovea|^2): tangents a pixel, by that of the fovea
  uint width, height;            // of the lattice that this one refines, texels
  float gradient_nodes;          // of a brick, an axis; 0: of the whole volume, one a voxel
  uint grid_width, grid_height;  // of this lattice, texels
  uint only_marked, only_dirty;  // 1: of its tiles only those are drawn
};

// From every 2nd pixel to the picture, in invocations from lattice point first_x, first_y on.
struct UpsampleData {
  vec4 background;  // alpha 0: transparent
  uint first_x, first_y;
  uint width, height;  // of the picture
};

CATENA_SHARED_END
#endif
