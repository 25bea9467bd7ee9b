// What the passes of one picture share. Depth t is measured along the view axis in world units, from the reference depth: the
// distance from the eye's plane is t + reference_depth. Pixel places q count from the view axis: from
// the centre of the picture, unless the frustum is off the axis.
#ifndef CATENA_SHARED_FRAME_H
#define CATENA_SHARED_FRAME_H
#include "shaders/shared/language.h"

#define MAX_VOLUMES 4
#define MAX_SURFACES 8
#define MAX_GRIDS 8
#define MAX_LAYERS 4
#define MAX_GRIDS_WITH_LAYERS 6
#define MAX_CLIP_PLANES 8
#define MAX_LIGHTS 4
#define NO_DEPTH 3.0e38f

CATENA_SHARED_BEGIN

// A table of shaders/lib/tables.glsl: its first entry, its last index, how many points follow the entries, the scale on which entries are
// even (1 / linear_below of engine/base/symlog_scale.h, 0: linear), the first entry's place on it, entries a unit, and the values of the
// first and last point.
struct TableData {
  uint start, last, control_points;
  float per_linear, lo, entries_per_unit, first_value, last_value;
};

// One grid as a ray meets it. Local position on the ray of pixel q at depth t:
//   (origin + origin_x q.x + origin_y q.y) + t (direction + direction_x q.x + direction_y q.y)
struct GridData {
  vec3 origin, origin_x, origin_y;
  vec3 direction, direction_x, direction_y;
  vec3 lo, hi;                // the box of voxel centres, local
  vec3 domain_lo, domain_hi;  // what is drawn of it: all, but for grids mirrored at less than their resolution
  vec3 texel;                 // 1 / size of the value image
  mat3 world_gradient;        // world = world_from_index_gradient * local gradient
  float value_offset, value_scale;
  TableData value_table;     // of volumes and colours: by the value
  TableData gradient_table;  // of volumes: by the length of the gradient
  // projections: what the words of the brick map count (shaders/lib/projection.glsl)
  float bound_lo, bound_per_code;
  // isosurfaces; projections: opacity, the length that it is of
  float level, opacity;
  vec3 color;
  uint is_clipped;      // the clip planes count for it
  uint id;              // of the object
  float nearest;        // 1: the value of the nearest voxel centre; 0: trilinear
  float spread_labels;  // colours by labels, 0.5: what lies nearest to a voxel without a label takes the nearest label of its cell; else 0
};

// A light from far away; the direction points to it, and is unit: in world axes, in the view's for triangles.
struct LightData {
  vec3 direction, color;
};

// Depth cue: a colour at depth t takes min(most, (t - start) per_depth most) of the fog's.
struct FogData {
  vec3 color;
  float near, per_depth, max_opacity;  // most 0: none
};

// One clip plane as a ray meets it; kept where this is >= 0:
//   (at + handle_x q.x + handle_y q.y) + t (along + view_along_plus_x q.x + view_along_plus_y q.y)
struct ClipData {
  float at, at_x, at_y;
  float along, along_x, along_y;
};

struct FrameData {
  vec2 half_size;  // of the picture, pixels
  vec2 axis;       // the pixel place where the view axis meets the picture, counted from its corner
  vec2 slope;      // world units a pixel at depth 1 from the eye; 0 if orthographic
  vec3 right, up, forward;
  float reference_depth;
  float front_depth;            // the first depth that is seen: the eye's plane
  float depth_near, depth_far;  // buffer depth: perspective near / z, orthographic (far - z) / (far - near)
  uint orthographic;
  float spacing;  // pixel place of a fragment: spacing * fragment + first
  vec2 first;
  float step_world;   // length of a ray's segments
  float termination;  // a ray ends when less gets through
  uint clip_count;
  ClipData clips[MAX_CLIP_PLANES];
  uint light_count;  // 0: a headlight
  LightData lights[MAX_LIGHTS];
  FogData fog;
  GridData grids[MAX_GRIDS];
};

#define UNCLIPPED 0x80000000u  // in a vertex's id: the clip planes do not touch it
#define CORNER_SHIFT 29        // in a vertex's id, two bits: 1 + its corner of a triangle whose edges are drawn, or 0
#define ID_MASK 0x1fffffffu

struct MeshFrameData {
  mat3 view_from_world;  // rows right, up, forward
  vec3 offset;           // of the mesh's origin in the view: x, y, distance from the eye's plane
  float offset_depth;    // the same along the axis, from the reference depth
  vec2 scale;            // clip units per world unit (per slope, if perspective)
  vec2 shift;            // clip units from the picture's centre to the view axis
  vec2 pixel;            // its size in clip units
  float depth_near, depth_far;
  uint orthographic;
  uint clip_count;
  uint light_count;
  LightData lights[MAX_LIGHTS];
  FogData fog;
  vec4 clips[MAX_CLIP_PLANES];  // kept where dot(xyz, position) + w >= 0
};

struct ComposeData {
  vec4 background;  // alpha 0: transparent
};

CATENA_SHARED_END
#endif
