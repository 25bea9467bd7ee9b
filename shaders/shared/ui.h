// What is drawn over a window's picture (render/frame/overlay_items.h).
#ifndef CATENA_SHARED_UI_H
#define CATENA_SHARED_UI_H
#include "shaders/shared/language.h"

CATENA_SHARED_BEGIN

struct UiData {
  vec2 half_size;  // of the window, pixels
};

CATENA_SHARED_END
#endif
