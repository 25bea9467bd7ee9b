// SPDX-License-Identifier: MIT
// Shadow of the haptic cursors: data of compose_hand.frag.
#ifndef CATENA_SHARED_HAND_SHADOW_H
#define CATENA_SHARED_HAND_SHADOW_H
#include "shaders/shared/language.h"

#define MAX_HAND_PARTS 32

CATENA_SHARED_BEGIN

// What casts, in view axes (x right, y up, z forward from the camera plane), and the lights whose shadows are cast.
struct HandShadowData {
  vec4 from[MAX_HAND_PARTS], to[MAX_HAND_PARTS];  // ends of the axis of a part, and the radius there; equal for spheres
  uint part_count;
  vec3 light_tangents;  // by light: tangent of its angular radius; < 0: it casts no shadow
  vec4 whole;           // sphere that contains all parts: center, radius
  float pixel;          // size of a pixel: world units per view depth, or world units if orthographic
  float volume_spacing;   // pixels between the texels of volume_depth
  float depth_limit;      // depths t of volume_depth from here on count as none
  uint first_x, first_y, last_x, last_y;  // texels of volume_depth that are drawn
};

CATENA_SHARED_END
#endif
