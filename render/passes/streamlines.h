/// Streamlines: shaded tubes and their arrowheads.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kStreamlinePass;

}  // namespace catena::render
