// SPDX-License-Identifier: MIT
// User interface over a window's image (render/frame/overlay_items.h).
#ifndef CATENA_SHARED_UI_H
#define CATENA_SHARED_UI_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

// Data of the user interface pass.
struct UiData {
  vec2 half_size;  // half of the window size, pixels
};

CATENA_SHARED_END
#endif
