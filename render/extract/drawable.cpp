// SPDX-License-Identifier: MIT
#include "render/extract/drawable.h"

#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"

namespace catena::render {
namespace {

/// Adapts an extraction that cannot fail to the signature of those that can.
template <void (*Extract)(const scene::Scene&, FramePacket&)>
Outcome always(const scene::Scene& scene, FramePacket& packet) {
  Extract(scene, packet);
  return Done{};
}

std::vector<DrawableExtraction>& registry() {
  static std::vector<DrawableExtraction> kinds{
      {"volumes", nullptr, extract_volumes, volume_legend},
      {"isosurfaces", nullptr, extract_isosurfaces, isosurface_legend},
      {"meshes", prepare_meshes, always<extract_meshes>, nullptr},
      {"slices", prepare_slices, extract_slices, slice_legend},
      {"streamlines", prepare_streamlines, always<extract_streamlines>, streamlines_legend},
      {"glyphs", prepare_glyphs, always<extract_glyphs>, glyphs_legend},
      {"curves", prepare_curves, always<extract_curves>, curves_legend},
      {"points", prepare_points, always<extract_points>, points_legend},
  };
  return kinds;
}

}  // namespace

void register_extraction(const DrawableExtraction& kind) { registry().push_back(kind); }
const std::vector<DrawableExtraction>& extractions() { return registry(); }

}  // namespace catena::render
