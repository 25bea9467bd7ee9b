// How far a picture narrows (render/passes/vignette.cpp).
#ifndef CATENA_SHARED_VIGNETTE_H
#define CATENA_SHARED_VIGNETTE_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

// Pixel place p looks along first + p step, at distance 1 from the eye, right and down of its axis.
struct VignetteData {
  vec2 first, step;
  float strength;      // 0..1
  float inner, outer;  // tangents of the angles from the axis between which it grows dark
};

CATENA_SHARED_END
#endif
