/// Opaque isosurfaces coloured by another field: after they are drawn, the pixels that show one get the other field's colour at their
/// place, lit by the surface's normal. Needs an id of its own (not 0) in every such item. Frame thread.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kSurfaceColorPass;

}  // namespace catena::render
