// SPDX-License-Identifier: MIT
// Tube as rings, from which the vertex shader generates vertices. A tube of a million rings takes 36 MB; as triangles, 0.5 GB.
#ifndef CATENA_SHARED_TUBE_H
#define CATENA_SHARED_TUBE_H
#include "shaders/shared/language.h"

#define RING_SHIFT 4         // a vertex index is ring << RING_SHIFT | side
#define RING_GAP (1u << 30)  // flag in the color: there is no wall before or after this ring
#define RING_COLOR_MAX 1023  // maximum of each color component (ten bits)
#define RIBBON_WALLS 2       // number of walls across a ribbon, between its three vertices

CATENA_SHARED_BEGIN

// One ring of a tube.
struct TubeRingData {
  vec3 center;  // relative to the common origin of all tubes
  float radius;
  float normal_tilt;     // component of the surface normals along the tangent: 0 on the wall, -1 and 1 at the tips of the caps
  uint tangent, normal;  // unit vectors, octahedral coordinates, two signed normalized 16-bit values
  uint color;
  uint id;  // as in a mesh vertex
};

CATENA_SHARED_END
#endif
