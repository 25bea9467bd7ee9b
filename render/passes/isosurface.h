/// Opaque isosurfaces: the drawn surface is the level set of the trilinear field itself, found along each pixel's ray from the
/// cubic of the cell (no triangles), written with its depth. Translucent ones are drawn by the volume pass, in order with volumes.
#pragma once
#include "render/passes/grid_bindings.h"
#include "render/passes/pass.h"

namespace catena::render {

/// A level of a mirrored grid, ready to be bound: bricks without the level are inactive.
struct SurfaceState {
  std::shared_ptr<const GridMirror> mirror;
  float level = 0;
  BrickMap map;
  /// Rebuilds the map when the mirror or the level is another one.
  Outcome update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, double next_level);
  BoundGrid bound() const { return {mirror, &map, true, true}; }
};
/// The ray's numbers, level, colour and opacity.
shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item);

extern const PassEntry kIsosurfacePass;

}  // namespace catena::render
