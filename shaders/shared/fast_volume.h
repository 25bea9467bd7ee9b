// SPDX-License-Identifier: MIT
// Fast raycast of one packed volume (render/raycast/fast_volume.h): data of its passes in addition to FrameData, whose grid 0 is the packed
// volume with positions relative to its first voxel.
#ifndef CATENA_SHARED_FAST_VOLUME_H
#define CATENA_SHARED_FAST_VOLUME_H
#include "shaders/shared/language.h"

#define COARSE_APRON 2
#define MAX_PAGE_LEVELS 16

CATENA_SHARED_BEGIN

// Ray grid: texel `at` is the ray through the center of pixel spacing * (at - apron).
struct RayGridData {
  float spacing;                 // pixels
  float apron;                   // texels before the image's first pixel; coarser ray grids have COARSE_APRON
  float threshold;               // a block is marched where the expected interpolation error exceeds this (display units),
  vec2 gaze, per_fovea;          // times max(1, |(pixel - gaze) per_fovea|^2); per_fovea: tangent per pixel, divided by that of the fovea
  uint width, height;            // size of the coarser ray grid that this one refines, texels
  float gradient_nodes;          // gradient samples per brick and axis; 0: one gradient per voxel of the whole volume
  uint grid_width, grid_height;  // size of this ray grid, texels
  uint only_marked, only_dirty;  // 1: only marked tiles, only dirty tiles are rendered
};

// Level of a paged volume (render/residency/page_table.h), voxels as seen from the finest level.
struct PageLevelData {
  vec3 scale, offset;  // position in the level = scale * position in the finest level + offset
  uint last_xy;        // last page: 16 bits of x, y
  uint last_z_shifts;  // 16 bits of z; then, 5 bits for each axis, s: a page covers 2^s entries of the page table
};
struct PageLevels {
  PageLevelData levels[MAX_PAGE_LEVELS];
};

// Interpolation from every 2nd pixel to the image, in invocations from ray grid point first_x, first_y on.
struct UpsampleData {
  vec4 background;  // alpha 0: transparent; in the encoding of the images
  float is_linear;  // 1: the images are linear radiance
  uint first_x, first_y;
  uint width, height;  // image size, pixels
};

CATENA_SHARED_END
#endif
