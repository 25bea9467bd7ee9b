// SPDX-License-Identifier: MIT
/// Texture of the light that arrives in the scene (light_sweep.h), kept while what casts shadows, the lights and the clip planes are
/// unchanged: no camera and no hand rebuilds it. Frame thread.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/light/light_cells.h"
#include "render/vk/resources.h"

namespace catena::render {

/// The light grid of a renderer.
class LightGrid {
 public:
  /// Updates the texture to a packet, and shares it with all pipelines. `is_only_view`: no other view of the image needs another one.
  Outcome update(vk::Device& device, const FramePacket& packet, bool is_only_view);

  /// Frees the textures.
  void clear() { *this = LightGrid(version_); }

  LightGrid() = default;
  /// Returns the number of updates that changed the texture; 0 for a packet in which nothing is cast.
  std::uint32_t version() const { return is_on_ ? version_ : 0; }
  /// Returns the lower corner of the box, display units.
  const Vec3& lo() const { return cells_.lo; }
  /// Returns the size of the box, display units.
  Vec3 size() const { return cells_.edge * Vec3(cells_.size.x, cells_.size.y, cells_.size.z); }
  /// Returns the edge of a cell, display units.
  double edge() const { return cells_.edge; }
  /// Returns the distance from a surface at which its light is looked up, display units: a surface darkens the cells that it crosses.
  double surface_offset() const { return surface_offset_; }
  /// Returns the share of the environment that arrives there, if the surface is even and nothing else is near.
  double open_share() const { return open_share_; }

 private:
  explicit LightGrid(std::uint32_t version) : version_(version) {}
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
  void cast(const FramePacket& packet);
  Outcome upload(vk::Device& device);

  vk::Image open_, image_;  ///< open_: one texel, everything arrives
  vk::Sampler linear_;
  std::optional<Casters> casters_;  ///< of cells_
  LightCells cells_;
  std::vector<LightItem> lights_;                    ///< of the texels
  IlluminationItem illumination_;                    ///< of the texels
  std::vector<std::array<std::uint8_t, 4>> texels_;  ///< share of the lights (red, green, blue), and of the environment (alpha)
  bool is_on_ = false;
  std::uint32_t version_ = 0;
  double surface_offset_ = 0, open_share_ = 1;
};

}  // namespace catena::render
