// SPDX-License-Identifier: MIT
// Sphere impostor: a sphere rendered as one quad that covers it; the fragment shader intersects the pixel's ray with it.
#ifndef CATENA_SHARED_SPHERE_H
#define CATENA_SHARED_SPHERE_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

// One sphere.
struct SphereData {
  vec3 center;  // relative to the common origin of all spheres
  float radius;
  uint color;  // three times eight bits
  uint id;     // as in a mesh vertex
};

CATENA_SHARED_END
#endif
