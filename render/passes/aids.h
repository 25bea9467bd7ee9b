/// Help for the eye: bounding boxes, axes and the ground.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kAidPass;

}  // namespace catena::render
