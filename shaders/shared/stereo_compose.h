// Several pictures into one: what stereo_compose.frag and anaglyph.frag are told.
#ifndef CATENA_SHARED_PACK_H
#define CATENA_SHARED_PACK_H
#include "shaders/shared/language.h"

#define STEREO_PATTERN_WHOLE 0
#define STEREO_PATTERN_ROWS 1
#define STEREO_PATTERN_COLUMNS 2
#define STEREO_PATTERN_CHECKERBOARD 3

CATENA_SHARED_BEGIN

struct StereoComposeData {
  vec2 first;             // where the view's picture begins in the packed one, pixels
  uint block_x, block_y;  // pixels of the view that are averaged to one
  uint view, views;       // interlaced: this view out of so many
};

struct AnaglyphData {
  mat3 left, right;  // display light = left * left eye's + right * right eye's, linear
};

CATENA_SHARED_END
#endif
