// SPDX-License-Identifier: MIT
// Conversion of opaque and ray depths to the depth image of a headset's view.
#ifndef CATENA_SHARED_HEADSET_H
#define CATENA_SHARED_HEADSET_H
#include "shaders/shared/frame.h"

CATENA_SHARED_BEGIN

// Parameters of the conversion.
struct HeadsetDepthData {
  float meters_per_unit;  // > 0
  float reference_m;      // meters from the eye where the opaque depth t is 0
  float near_m;           // distance of depth 0
  float far_m;            // distance of depth 1
};

CATENA_SHARED_END

#endif
