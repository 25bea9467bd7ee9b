/// What of a widget a probe is near. World units.
#pragma once
#include "engine/widget/state.h"

namespace catena::widget {

struct Reach {
  std::int8_t handle = -1;  ///< the handle; -1: none
  bool sphere = false;
  bool plane = false;
  double distance = 0;  ///< from the nearest of these
};

}  // namespace catena::widget
