// SPDX-License-Identifier: MIT
// Data shared by the passes of one image. Depth t is measured along the view axis in world units, from the reference depth: the distance
// from the camera plane is t + reference_depth. Pixel coordinates q are relative to the view axis, i.e. to the center of the image, unless
// the frustum is off-axis.
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

// Lookup table of shaders/lib/tables.glsl: index of its first entry, its last index, number of control points after the entries, scale on
// which the entries are evenly spaced (1 / linear_below of engine/base/symlog_scale.h, 0: linear), coordinate of the first entry on that
// scale, entries per unit, and the values of the first and last control point.
struct TableData {
  uint start, last, control_points;
  float per_linear, lo, entries_per_unit, first_value, last_value;
};

// Resident grid as sampled by rays. Local position on the ray of pixel q at depth t:
//   (origin + origin_x q.x + origin_y q.y) + t (direction + direction_x q.x + direction_y q.y)
struct GridData {
  vec3 origin, origin_x, origin_y;
  vec3 direction, direction_x, direction_y;
  vec3 lo, hi;                // box of the voxel centers, local
  vec3 domain_lo, domain_hi;  // rendered part of the box: all of it, except for downsampled grids
  vec3 texel;                 // 1 / size of the value image
  mat3 world_gradient;        // world gradient = world_gradient * local gradient
  float value_offset, value_scale;
  TableData value_table;     // volumes and color grids: by value
  TableData gradient_table;  // volumes: by gradient magnitude
  // projections: scale of the codes in the brick map (shaders/lib/projection.glsl)
  float bound_lo, bound_per_code;
  // isosurfaces: isovalue, opacity and color; projections: `opacity` is the opacity reference length
  float level, opacity;
  vec3 color;
  uint is_clipped;  // nonzero: the clip planes apply
  uint id;          // object id
  float nearest;    // 1: value of the nearest voxel center; 0: trilinear
  // Coloring by labels, 0.5: where the nearest voxel has no label, the nearest label of the cell is used; otherwise 0.
  float spread_labels;
  float anisotropy, surface_share;  // volumes: of the phase function; share that the gradient reflects
};

// Directional light; the unit vector points to it: in world axes, for triangles in view axes.
struct LightData {
  vec3 direction, color;
};

// Light that arrives in the scene, a 3D texture over a box along the world's axes, twice (render/light). Texture coordinates of pixel q at depth
// t:
//   (origin + origin_x q.x + origin_y q.y) + t (direction + direction_x q.x + direction_y q.y)
// for triangles: from_view * position in view axes + origin.
struct LightGridData {
  vec3 origin, origin_x, origin_y;
  vec3 direction, direction_x, direction_y;
  mat3 from_view;
  mat3 from_normal;  // offset of the lookup at a surface, along its unit normal in the axes of the shader
  mat3 from_world;   // world axes to those of the shader's normals
  float is_on;       // 0: nothing is cast
  float half_cell;   // half of a cell's edge, world units
  float half_plane;  // half of a plane of cells, as a share of all
  uint version;      // changes with the texture
};

// Model of the light (shaders/lib/lighting.glsl).
struct LookData {
  float diffuse, specular, scattered;  // share of a light that a surface reflects, in all directions and as a highlight, and a volume scatters
  float zenith_share;                  // of the environment: change by the cosine of the normal and the zenith
  float is_linear;                     // 1: colors and light are linear radiance; 0: in the display encoding
};

// Depth fog: the opacity of the fog color at depth t is min(max_opacity, (t - near) per_depth max_opacity).
struct FogData {
  vec3 color;
  float near, per_depth, max_opacity;  // max_opacity 0: no fog
};

// Clip plane as evaluated along rays; a point is inside where this is >= 0:
//   (at + at_x q.x + at_y q.y) + t (along + along_x q.x + along_y q.y)
struct ClipData {
  float at, at_x, at_y;
  float along, along_x, along_y;
};

// Camera, ray and lighting data of one image, and its grids.
struct FrameData {
  vec2 half_size;  // half of the image size, pixels
  vec2 axis;       // pixel coordinate at which the view axis intersects the image, from its upper left corner
  vec2 slope;      // world units per pixel at view depth 1; 0 if orthographic
  vec3 right, up, forward;
  float reference_depth;
  float front_depth;            // smallest visible depth t: the camera plane
  float depth_near, depth_far;  // buffer depth: perspective near / z, orthographic (far - z) / (far - near)
  uint orthographic;
  float spacing;  // pixel coordinate of a fragment: spacing * fragment + first
  vec2 first;
  float step_world;   // length of a ray segment, world units
  float termination;  // a ray ends when its transmittance falls below this
  uint clip_count;
  ClipData clips[MAX_CLIP_PLANES];
  uint light_count;  // 0: a headlight
  LightData lights[MAX_LIGHTS];
  vec3 sky, ground, zenith;  // environment: light from above and below, and the direction upwards
  LightGridData light_grid;
  LookData look;
  FogData fog;
  GridData grids[MAX_GRIDS];
};

#define UNCLIPPED 0x80000000u  // flag in a vertex's id: the clip planes do not apply
#define CORNER_SHIFT 29        // two bits in a vertex's id: 1 + corner number in a triangle with visible edges, or 0
#define ID_MASK 0x1fffffffu

// Camera and lighting data of a triangle mesh.
struct MeshFrameData {
  mat3 view_from_world;  // rows right, up, forward
  vec3 offset;           // of the mesh's origin in view axes: x, y, distance from the camera plane
  float offset_depth;    // depth t of the mesh's origin
  vec2 scale;            // clip units per world unit (perspective: per tangent)
  vec2 shift;            // clip units from the center of the image to the view axis
  vec2 pixel;            // size of a pixel in clip units
  float depth_near, depth_far;
  uint orthographic;
  uint clip_count;
  uint light_count;
  LightData lights[MAX_LIGHTS];
  vec3 sky, ground, zenith;  // as in FrameData, in view axes
  LightGridData light_grid;
  LookData look;
  FogData fog;
  vec4 clips[MAX_CLIP_PLANES];  // inside where dot(xyz, position) + w >= 0
};

// Background color for `compose`.
struct ComposeData {
  vec4 background;  // alpha 0: transparent
  int sides, ends;  // antialiasing of contours: 4 and 2
  int max_step;     // antialiasing of contours: pixels searched along a step in each direction
  float is_linear;  // 1: the images are linear radiance
};

CATENA_SHARED_END
#endif
