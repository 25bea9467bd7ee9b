#include "render/passes/pass.h"

#include <algorithm>

namespace catena::render {

Result<std::shared_ptr<const GridMirror>> Frame::mirror(const field::ScalarGrid& grid) const {
  const auto uses = [&](const auto& item) { return item.grid.get() == &grid; };
  const bool surface = std::any_of(packet.isosurfaces.begin(), packet.isosurfaces.end(), uses) ||
                       std::any_of(packet.slices.begin(), packet.slices.end(), uses);
  const bool float32 = settings.texels == TexelFormat::r32f || (settings.texels == TexelFormat::automatic && surface);
  return mirrors.get(grid, {float32, settings.layout});
}

}  // namespace catena::render
