// The depth of a headset's picture, out of the depths of what is opaque and of what rays meet.
#ifndef CATENA_SHARED_HEADSET_H
#define CATENA_SHARED_HEADSET_H
#include "shaders/shared/frame.h"

CATENA_SHARED_BEGIN

struct HeadsetDepthData {
  float meters_per_unit;  // > 0
  float reference_m;      // metres from the eye where the opaque depth is 0
  float near_m;           // depth 0
  float far_m;            // depth 1
};

CATENA_SHARED_END

#endif
