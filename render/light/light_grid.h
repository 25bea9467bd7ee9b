// SPDX-License-Identifier: MIT
/// Texture of the light that arrives in the scene (light_sweep.h), kept while what casts shadows, the lights and the clip planes are
/// unchanged: no camera and no hand rebuilds it. Frame thread.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/frame/light_place.h"
#include "render/light/light_cells.h"
#include "render/vk/resources.h"

namespace catena::render {

/// The light grid of a renderer.
class LightGrid {
 public:
  /// Updates the texture to a packet, and shares it with all pipelines. `is_only_view`: no other view of the image needs another one.
  Outcome update(vk::Device& device, const FramePacket& packet, bool is_only_view);

  /// Frees the textures.
  void clear() { *this = LightGrid(place_.version); }

  LightGrid() = default;
  /// Returns where the light of the last packet is looked up; version 0: nothing is cast in it.
  LightPlace place() const { return is_on_ ? place_ : LightPlace{}; }

 private:
  explicit LightGrid(std::uint32_t version) { place_.version = version; }
  /// The parts of a packet on which the cells depend.
  struct Casters {
    Bounds bounds;
    std::vector<Plane> clip_planes;
    std::vector<VolumeItem> volumes;
    std::vector<IsosurfaceItem> isosurfaces;
    std::vector<MeshItem> meshes;
    std::vector<TubeItem> tubes;
    std::vector<ArrowItem> arrows;
    std::vector<GlyphItem> glyphs;
    std::vector<SpheresItem> spheres;
    bool operator==(const Casters& other) const;
  };
  bool cast(const FramePacket& packet);
  Outcome upload(vk::Device& device);

  vk::Image open_, image_;  ///< open_: one texel, everything arrives
  vk::Sampler linear_;
  std::optional<Casters> casters_;  ///< of cells_
  LightCells cells_;
  std::vector<LightItem> lights_;                    ///< of the texels
  IlluminationItem illumination_;                    ///< of the texels
  std::vector<std::array<std::uint8_t, 4>> texels_;  ///< as in shaders/lib/light_grid.glsl
  bool is_on_ = false;
  LightPlace place_;
};

}  // namespace catena::render
