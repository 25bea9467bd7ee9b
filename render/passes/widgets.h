/// Widgets as lit triangles, untouched by clip planes.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kWidgetPass;

}  // namespace catena::render
