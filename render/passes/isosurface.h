/// Opaque isosurfaces: the drawn surface is the level set of the trilinear field itself, found along each pixel's ray from the
/// cubic of the cell (no triangles), written with its depth. Translucent ones are drawn by the volume pass, in order with volumes.
#pragma once
#include "render/passes/pass.h"
#include "render/raycast/bound_grids.h"

namespace catena::render {

extern const PassEntry kIsosurfacePass;

}  // namespace catena::render
