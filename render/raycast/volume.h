// SPDX-License-Identifier: MIT
/// Exact raycast of volumes, translucent isosurfaces and layers together (at most MAX_VOLUMES, MAX_SURFACES and MAX_LAYERS; at most
/// MAX_GRIDS grids including coloring grids, MAX_GRIDS_WITH_LAYERS if there are layers), in front of the opaque depth. Tables and brick
/// maps are rebuilt only when a transfer function, a level or a grid changes. Frame thread.
#pragma once
#include <compare>
#include <map>
#include <optional>

#include "render/raycast/dirty_tiles.h"
#include "render/raycast/grid_bindings.h"
#include "render/raycast/render_settings.h"

namespace catena::render {

/// Exact raycast: device state of its volumes, surfaces and coloring grids, and reusable images per eye.
class VolumeRaycast {
 public:
  static Result<VolumeRaycast> create(vk::Device& device);
  /// Uploads what changed.
  Outcome prepare(std::span<const ResidentItem<VolumeItem>> volumes, std::span<const ResidentItem<IsosurfaceItem>> surfaces);
  /// Records the rays within a render pass over a target of any size: all rays of an image, or a sparse sample.
  Outcome record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area, const RayScene& scene);
  /// Selects the eye (of `eyes`) of the following calls: images reused from frame to frame are kept per eye.
  void select_eye(std::size_t eye, std::size_t eyes) {
    eye_states_.resize(eyes);
    eye_index_ = eye;
  }
  /// Renders into `target` of the image's size, not inside a render pass. `keep`: its content from the last call is reused where the result
  /// would be identical to the bit (dirty_tiles.h).
  Outcome record_into(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                      const RayScene& scene, vk::Image& target, bool keep);
  /// Like record(), but writes the depth t at which alpha exceeds 0.5 into the red channel, NO_DEPTH where it never does; the settings must
  /// terminate rays at a transmittance of 0.5. Not for layers alone.
  Outcome record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                    const RayScene& scene);
  /// Returns whether record_half_opacity_depth() can be used.
  bool has_half_opacity_depth() const { return !volumes_.empty() || !surfaces_.empty(); }
  /// Returns whether the last record_into() reused most of its previous result.
  bool reused_previous() const { return reused_previous_; }
  /// Invalidates the reused content: the eye's target was overwritten by others.
  void invalidate_target() { eye_state().reuse.reset(); }
  /// Returns the mask of the tiles that record_into() re-marched, if it reused the others; null: nothing was reused, or there was nothing
  /// opaque.
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
    std::size_t owner = 0;  ///< index of a volume, or number of volumes plus index of a surface
    std::uint32_t table_start = 0;
  };
  /// Parameters that a pipeline is specialized for.
  struct PipelineKey {
    std::uint32_t flags = 0, has_opaque = 0, volumes = 0, surfaces = 0, layers = 0, modes = 0, color_grids = 0, jitter = 0, colors = 0,
                  fog = 0, tables = 0;
    bool dirty_only = false;  ///< only dirty tiles are rendered
    bool half_opacity_depth = false;
    auto operator<=>(const PipelineKey&) const = default;
    bool is_single_volume() const { return volumes == 1 && surfaces == 0 && layers == 0 && colors == 0; }
    bool is_layers_only() const { return volumes == 0 && surfaces == 0; }
    std::uint32_t grid_slots() const {
      return is_layers_only() ? 0 : is_single_volume() ? 1 : layers > 0 ? MAX_GRIDS_WITH_LAYERS : MAX_GRIDS;
    }
  };
  /// Input of a draw: pipeline, frame data and grids.
  struct DrawState {
    PipelineKey key;
    shared::FrameData frame;
    std::vector<GridBinding> grids;
  };
  struct ReuseState {
    PipelineKey key;
    RayImageState state;
  };
  /// Images of one eye that are reused from frame to frame.
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
  std::uint64_t appearance_version_ = 0;  ///< counts changes found by prepare()
  std::vector<EyeState> eye_states_{1};
  std::size_t eye_index_ = 0;
  bool reused_previous_ = false;
};

}  // namespace catena::render
