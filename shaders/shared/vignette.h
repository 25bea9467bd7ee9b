// SPDX-License-Identifier: MIT
// Vignette (render/passes/vignette.cpp).
#ifndef CATENA_SHARED_VIGNETTE_H
#define CATENA_SHARED_VIGNETTE_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

// The view direction of pixel coordinate p is first + p step, at distance 1 from the eye, to the right and down of its axis.
struct VignetteData {
  vec2 first, step;
  float strength;      // 0..1
  float inner, outer;  // tangents of the angles from the axis between which the image darkens
};

CATENA_SHARED_END
#endif
