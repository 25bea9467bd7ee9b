/// Volumes, translucent isosurfaces and layers, one raycast for all of them (at most MAX_VOLUMES, MAX_SURFACES and MAX_LAYERS, MAX_GRIDS
/// grids together with those that colour them, MAX_GRIDS_WITH_LAYERS where there are layers), in front of the opaque depth. Tables and
/// brick maps are rebuilt only when a transfer function, a level or a grid changes.
#pragma once
#include <compare>
#include <map>
#include <optional>

#include "render/raycast/bound_grids.h"
#include "render/raycast/render_settings.h"
#include "render/raycast/still_tiles.h"

namespace catena::render {

class VolumeRaycast {
 public:
  static Result<VolumeRaycast> create(vk::Device& device);
  Outcome prepare(std::span<const Mirrored<VolumeItem>> volumes, std::span<const Mirrored<IsosurfaceItem>> surfaces);
  /// Within a pass over a target of any size: a picture's rays, or some of them.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area, const RayScene& scene);
  /// What follows is one of so many eyes' pictures: each keeps its own from picture to picture.
  void turn_to(std::size_t eye, std::size_t eyes) {
    eyes_.resize(eyes);
    eye_ = eye;
  }
  /// Into `target` of the picture's size, not within a pass. `keep`: what it holds since the last call stays where it would come out the
  /// same, to the bit (still_tiles.h).
  Outcome record_into(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                      const RayScene& scene, vk::Image& target, bool keep);
  /// As record(), of settings that end at half of the light: instead of colours the depth t at which alpha passes 0.5 (red), NO_DEPTH where
  /// it never does. Not of layers alone.
  Outcome record_half_depth(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                            const RayScene& scene);
  bool has_half_depth() const { return !volumes_.empty() || !surfaces_.empty(); }
  /// Whether the last record_into() left most of it as it was.
  bool has_kept() const { return has_kept_; }
  /// Something else has drawn into the eye's target.
  void forget_target() { eye().kept.reset(); }
  /// Tiles that record_into() has marched again, where it has kept the others; null: it has not, or nothing was opaque.
  vk::Image* changed_tiles() { return has_kept_ && eye().kept->picture.opaque ? &eye().opaque->changed() : nullptr; }

 private:
  struct Volume {
    std::shared_ptr<const GridMirror> mirror;
    VolumeItem item;
    TransferLut lut;
    TransferLut factors;  ///< without entries: 1 everywhere
    BrickMap map;
    std::uint32_t table_start = 0, factor_start = 0;
  };
  struct Surface {
    SurfaceState state;
    IsosurfaceItem item;
  };
  struct Colors {
    ColorGrid grid;
    std::size_t owner = 0;  ///< a volume, or behind those a surface
    std::uint32_t table_start = 0;
  };
  /// What a pipeline is made for.
  struct Kind {
    std::uint32_t flags = 0, opaque = 0, volumes = 0, surfaces = 0, layers = 0, modes = 0, color_grids = 0, jitter = 0, colors = 0, fog = 0,
                  tables = 0;
    bool tiles = false;  ///< only those that have changed
    bool half_depth = false;
    auto operator<=>(const Kind&) const = default;
    bool single() const { return volumes == 1 && surfaces == 0 && layers == 0 && colors == 0; }
    bool layers_alone() const { return volumes == 0 && surfaces == 0; }
    std::uint32_t grid_slots() const { return layers_alone() ? 0 : single() ? 1 : layers > 0 ? MAX_GRIDS_WITH_LAYERS : MAX_GRIDS; }
  };
  /// What is to be drawn, and how.
  struct Ready {
    Kind kind;
    shared::FrameData frame;
    std::vector<BoundGrid> grids;
  };
  struct Kept {
    Kind kind;
    StillPicture picture;
  };
  /// What stays of an eye's picture.
  struct Eye {
    std::optional<StillTiles> opaque;
    std::optional<Kept> kept;
  };
  Eye& eye() { return eyes_[eye_]; }
  VolumeRaycast() = default;
  Ready ready(const CameraRays& rays, const RaySettings& settings, const RayScene& scene) const;
  Outcome draw(vk::Commands& commands, const Ready& ready, const VkRect2D& area, const RayScene& scene);
  Result<bool> update_volume(Volume& volume, const Mirrored<VolumeItem>& next);
  Result<bool> update_colors(std::span<const Mirrored<VolumeItem>> volumes, std::span<const Mirrored<IsosurfaceItem>> surfaces);
  Outcome upload_tables();
  shared::GridData volume_data(const CameraRays& rays, const Volume& volume) const;
  std::vector<vk::Binding> bindings(const Kind& kind, std::span<const BoundGrid> bound, const RayScene& scene);
  Result<const vk::Pipeline*> pipeline(const Kind& kind);

  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  std::map<Kind, vk::Pipeline> pipelines_;
  std::vector<Volume> volumes_;
  std::vector<Surface> surfaces_;
  std::vector<Colors> colors_;
  vk::Buffer tables_, uniform_;
  std::uint64_t looks_ = 0;  ///< counts what prepare() has found new
  std::vector<Eye> eyes_{1};
  std::size_t eye_ = 0;
  bool has_kept_ = false;
};

}  // namespace catena::render
