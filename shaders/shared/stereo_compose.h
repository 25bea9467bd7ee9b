// SPDX-License-Identifier: MIT
// Stereo composition of several views into one image: data of stereo_compose.frag and anaglyph.frag.
#ifndef CATENA_SHARED_STEREO_COMPOSE_H
#define CATENA_SHARED_STEREO_COMPOSE_H
#include "shaders/shared/language.h"

#define STEREO_PATTERN_WHOLE 0
#define STEREO_PATTERN_ROWS 1
#define STEREO_PATTERN_COLUMNS 2
#define STEREO_PATTERN_CHECKERBOARD 3

CATENA_SHARED_BEGIN

// Placement of one view in the composed image.
struct StereoComposeData {
  vec2 first;             // position of the view in the composed image, pixels
  uint block_x, block_y;  // pixels of the view that are averaged to one
  uint view, views;       // interlaced patterns: index of this view, number of views
};

// Color matrices of an anaglyph.
struct AnaglyphData {
  mat3 left, right;  // display light = left * left eye's + right * right eye's, linear
};

CATENA_SHARED_END
#endif
