/// Surface meshes: the triangles that the hand feels, lit, each by its own normal.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kMeshPass;

}  // namespace catena::render
