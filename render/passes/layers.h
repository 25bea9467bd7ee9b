/// Translucent meshes and slices as layers, peeled front to back: layer k holds, at every pixel, the k-th nearest of what lies in
/// front of the opaque depth; the raycast blends them in order with volumes and translucent isosurfaces (Frame::layers).
///   layer k: all is drawn again, what is not behind layer k - 1 left out, the nearest kept by a depth buffer
/// Depths are compared as the depth buffer holds them, equal ones by id: coincident things of different objects are both kept.
/// At most MAX_LAYERS. The last one, if more than one thing may lie in it, is their mean: alpha = 1 - prod (1 - a_i), colours
/// weighted by -ln (1 - a_i), depth of the nearest; exact with one thing left, independent of the order of drawing always.
/// Images exist only while something translucent is in the packet.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

/// Whether the packet holds something translucent that layers are for.
bool has_layers(const FramePacket& packet);

extern const PassEntry kLayersPass;

}  // namespace catena::render
