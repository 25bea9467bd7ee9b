#include "engine/app/render/describe.h"

#include <fmt/core.h>

namespace catena::app {

std::string what_is_drawn(const render::FramePacket& packet) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, count == 1 ? one : many);
  };
  add(packet.volumes.size(), "volume", "volumes");
  add(packet.isosurfaces.size(), "isosurface", "isosurfaces");
  add(packet.meshes.size(), "mesh", "meshes");
  add(packet.tubes.size(), "streamline", "streamlines");
  add(packet.cursors.size(), "cursor", "cursors");
  return text.empty() ? "nothing" : text;
}

}  // namespace catena::app
