// SPDX-License-Identifier: MIT
/// Texture of the light that arrives in the scene (light_sweep.h), kept while what casts shadows, the lights and the clip planes are
/// unchanged: no camera and no hand rebuilds it. Frame thread.
#pragma once
#include <optional>
#include <vector>

#include "render/light/light_cells.h"
#include "render/vk/resources.h"

namespace catena::render {

/// The light grid of a renderer.
class LightGrid {
 public:
  /// Creates the texture of a scene in which nothing is cast.
  static Result<LightGrid> create(vk::Device& device);
  /// Updates the texture to a packet, and shares it with all pipelines. `is_only_view`: no other view of the image needs another one.
  Outcome update(vk::Device& device, const FramePacket& packet, bool is_only_view);

  /// Returns the number of updates that changed the texture; 0 for a packet in which nothing is cast.
  std::uint32_t version() const { return is_on_ ? version_ : 0; }
  /// Returns the lower corner of the box, display units.
  const Vec3& lo() const { return lo_; }
  /// Returns the size of the box, display units.
  const Vec3& size() const { return size_; }
  /// Returns the distance from a surface at which its light is looked up, display units: a surface darkens the cells that it crosses.
  double surface_offset() const { return surface_offset_; }
  /// Returns the share of the environment that arrives there, if the surface is even and nothing else is near.
  double open_share() const { return open_share_; }

 private:
  /// The parts of a packet on which the light depends.
  struct Inputs {
    IlluminationItem illumination;
    std::vector<LightItem> lights;
    std::vector<Plane> clip_planes;
    std::vector<VolumeItem> volumes;
    std::vector<IsosurfaceItem> isosurfaces;
    std::vector<MeshItem> meshes;
    std::vector<TubeItem> tubes;
    std::vector<ArrowItem> arrows;
    std::vector<GlyphItem> glyphs;
    std::vector<SpheresItem> spheres;
    bool operator==(const Inputs&) const = default;
  };

  Outcome upload(vk::Device& device, const LightCells& cells, const FramePacket& packet);

  vk::Image open_, image_;  ///< open_: one texel, everything arrives
  vk::Sampler linear_;
  std::optional<Inputs> inputs_;
  bool is_on_ = false;
  std::uint32_t version_ = 0;
  Vec3 lo_{0.0}, size_{1.0};
  double surface_offset_ = 0, open_share_ = 1;
};

}  // namespace catena::render
