// A ball as one quad that covers it: the fragment shader finds where the ray of a pixel meets it.
#ifndef CATENA_SHARED_BALL_H
#define CATENA_SHARED_BALL_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

struct SphereData {
  vec3 center;  // relative to the origin of all
  float radius;
  uint color;  // three times eight bits
  uint id;     // as a mesh vertex's
};

CATENA_SHARED_END
#endif
