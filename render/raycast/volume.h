/// Volumes, translucent isosurfaces and layers, one raycast for all of them (at most MAX_VOLUMES, MAX_SURFACES and MAX_LAYERS, MAX_GRIDS
/// grids together with those that colour them, MAX_GRIDS_WITH_LAYERS where there are layers), in front of the opaque depth. Tables and
/// brick maps are rebuilt only when a transfer function, a level or a grid changes.
#pragma once
#include <compare>
#include <map>
#include <optional>

#include "render/raycast/dirty_tiles.h"
#include "render/raycast/grid_bindings.h"
#include "render/raycast/render_settings.h"

namespace catena::render {

class VolumeRaycast {
 public:
  static Result<VolumeRaycast> create(vk::Device& device);
  Outcome prepare(std::span<const ResidentItem<VolumeItem>> volumes, std::span<const ResidentItem<IsosurfaceItem>> surfaces);
  /// CellFinder a pass over a target of any size: a picture's rays, or some of them.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area, const RayScene& scene);
  /// What follows is one of so many eyes' pictures: each keeps its own from picture to picture.
  void select_eye(std::size_t eye, std::size_t eyes) {
    eye_states_.resize(eyes);
    eye_index_ = eye;
  }
  /// Into `target` of the picture's size, not within a pass. `keep`: what it holds since the last call stays where it would come out the
  /// same, to the bit (still_tiles.h).
  Outcome record_into(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                      const RayScene& scene, vk::Image& target, bool keep);
  /// As record(), of settings that end at half of the light: instead of colours the depth t at which alpha passes 0.5 (red), NO_DEPTH where
  /// it never does. Not of layers alone.
  Outcome record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                    const RayScene& scene);
  bool has_half_opacity_depth() const { return !volumes_.empty() || !surfaces_.empty(); }
  /// Whether the last record_into() left most of it as it was.
  bool reused_previous() const { return reused_previous_; }
  /// Something else has drawn into the eye's target.
  void invalidate_target() { eye_state().reuse.reset(); }
  /// Tiles that record_into() has marched again, where it has kept the others; null: it has not, or nothing was opaque.
  vk::Image* dirty_tiles() {
    return reused_previous_ && eye_state().reuse->state.has_opaque ? &eye_state().opaque_tiles->dirty_tiles() : nullptr;
  }

 private:
  struct Volume {
    std::shared_ptr<const ResidentGrid> resident;
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
  struct ColorGridUse {
    ColorGrid grid;
    std::size_t owner = 0;  ///< a volume, or behind those a surface
    std::uint32_t table_start = 0;
  };
  /// What a pipeline is made for.
  struct PipelineKey {
    std::uint32_t flags = 0, has_opaque = 0, volumes = 0, surfaces = 0, layers = 0, modes = 0, color_grids = 0, jitter = 0, colors = 0,
                  fog = 0, tables = 0;
    bool dirty_only = false;  ///< only those that have changed
    bool half_opacity_depth = false;
    auto operator<=>(const PipelineKey&) const = default;
    bool is_single_volume() const { return volumes == 1 && surfaces == 0 && layers == 0 && colors == 0; }
    bool is_layers_only() const { return volumes == 0 && surfaces == 0; }
    std::uint32_t grid_slots() const {
      return is_layers_only() ? 0 : is_single_volume() ? 1 : layers > 0 ? MAX_GRIDS_WITH_LAYERS : MAX_GRIDS;
    }
  };
  /// What is to be drawn, and how.
  struct DrawState {
    PipelineKey key;
    shared::FrameData frame;
    std::vector<GridBinding> grids;
  };
  struct ReuseState {
    PipelineKey key;
    RayImageState state;
  };
  /// What stays of an eye's picture.
  struct EyeState {
    std::optional<DirtyTiles> opaque_tiles;
    std::optional<ReuseState> reuse;
  };
  EyeState& eye_state() { return eye_states_[eye_index_]; }
  VolumeRaycast() = default;
  DrawState make_draw_state(const CameraRays& rays, const RaySettings& settings, const RayScene& scene) const;
  Outcome draw(vk::Commands& commands, const DrawState& ready, const VkRect2D& area, const RayScene& scene);
  Result<bool> update_volume(Volume& volume, const ResidentItem<VolumeItem>& next);
  Result<bool> update_colors(std::span<const ResidentItem<VolumeItem>> volumes, std::span<const ResidentItem<IsosurfaceItem>> surfaces);
  Outcome upload_tables();
  shared::GridData volume_data(const CameraRays& rays, const Volume& volume) const;
  std::vector<vk::Binding> bindings(const PipelineKey& kind, std::span<const GridBinding> bound, const RayScene& scene);
  Result<const vk::Pipeline*> pipeline(const PipelineKey& kind);

  vk::Device* device_ = nullptr;
  vk::Sampler linear_;
  std::map<PipelineKey, vk::Pipeline> pipelines_;
  std::vector<Volume> volumes_;
  std::vector<Surface> surfaces_;
  std::vector<ColorGridUse> colors_;
  vk::Buffer tables_, uniform_;
  std::uint64_t appearance_version_ = 0;  ///< counts what prepare() has found new
  std::vector<EyeState> eye_states_{1};
  std::size_t eye_index_ = 0;
  bool reused_previous_ = false;
};

}  // namespace catena::render
