// A tube as its rings: the vertex shader makes the vertices. A tube of a million rings is 36 MB here, and 0.5 GB as triangles.
#ifndef CATENA_SHARED_TUBE_H
#define CATENA_SHARED_TUBE_H
#include "shaders/shared/language.h"

#define RING_SHIFT 4         // a vertex index is ring << RING_SHIFT | side
#define RING_GAP (1u << 30)  // in the colour: nothing is drawn up to this ring, nor from it on
#define RING_COLOR_MAX 1023  // each of the colour's parts has ten bits
#define RIBBON_WALLS 2       // across a ribbon, between its three vertices

CATENA_SHARED_BEGIN

struct TubeRingData {
  vec3 center;  // relative to the origin of all
  float radius;
  float normal_tilt;     // of the surface's normals along the tangent: 0 on the wall, -1 and 1 at the tips of the caps
  uint tangent, normal;  // unit, in octahedral coordinates, two signed 16-bit shares
  uint color;
  uint id;  // as a mesh vertex's
};

CATENA_SHARED_END
#endif
