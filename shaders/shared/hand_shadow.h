// SPDX-License-Identifier: MIT
// Shadow of the haptic cursors: data of compose_hand.frag.
#ifndef CATENA_SHARED_HAND_SHADOW_H
#define CATENA_SHARED_HAND_SHADOW_H
#include "shaders/shared/language.h"

#define MAX_HAND_PARTS 32
#define HAND_SPACING 4  // pixels between those that are tested for a shadow
#define DEPTH_SPACING 8  // pixels between the rays that find the depths of volumes
#define HAND_TILE 4     // of these, in each direction, are drawn together

CATENA_SHARED_BEGIN

// What casts, in view axes (x right, y up, z forward from the camera plane), and the lights whose shadows are cast.
struct HandShadowData {
  vec4 from[MAX_HAND_PARTS], to[MAX_HAND_PARTS];  // ends of the axis of a part, and the radius there; equal for spheres
  uint part_count;
  vec3 light_tangents;  // by light: tangent of its angular radius; < 0: it casts no shadow
  float pixel;          // half the size of a pixel: world units per view depth, or world units if orthographic
  float depth_limit;      // depths t of volume_depth from here on count as none
  uint mask_x, mask_y, mask_last_x, mask_last_y;      // texels of the mask that are drawn
  uint depth_x, depth_y, depth_last_x, depth_last_y;  // of volume_depth
  float least_opaque;                     // depths t of opaque_depth are at least this: NO_DEPTH, if there is no opaque_depth
  uint tiles_across;                      // tiles beside each other
  float half_width, half_height;          // of the image, pixels
};

CATENA_SHARED_END
#endif
