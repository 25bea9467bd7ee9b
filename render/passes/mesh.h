/// Opaque surface meshes: the triangles that the hand feels, lit from both sides. Translucent ones are drawn in the layers (layers.h).
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

bool is_translucent(const MeshItem& item);

extern const PassEntry kMeshPass;

}  // namespace catena::render
