// SPDX-License-Identifier: MIT
#include "render/extract/drawable.h"

namespace catena::render {

// rows of all kinds, each defined in the file of its extraction
DrawableExtraction volumes_extraction(), isosurfaces_extraction(), meshes_extraction(), slices_extraction(), streamlines_extraction(),
    glyphs_extraction(), curves_extraction(), points_extraction();

namespace {

std::vector<DrawableExtraction>& registry() {
  static std::vector<DrawableExtraction> kinds{volumes_extraction(), isosurfaces_extraction(), meshes_extraction(),
                                               slices_extraction(),  streamlines_extraction(), glyphs_extraction(),
                                               curves_extraction(),  points_extraction()};
  return kinds;
}

}  // namespace

void register_extraction(const DrawableExtraction& kind) { registry().push_back(kind); }
const std::vector<DrawableExtraction>& extractions() { return registry(); }

}  // namespace catena::render
