// SPDX-License-Identifier: MIT
/// Implementation of the renderer, shared by two source files: renderer.cpp renders, read_back.cpp reads images back.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/light/light_grid.h"
#include "render/passes/hand_shadow.h"
#include "render/passes/pass.h"
#include "render/passes/renderer.h"
#include "render/passes/stereo_compose.h"
#include "render/passes/ui.h"

namespace catena::render {

struct Renderer::Impl {
  std::unique_ptr<vk::Device> device;  // declared first, destroyed last
  std::optional<ResidencyManager> residency;
  LightGrid light;
  HandShadow hand_shadow;
  Targets targets;
  std::vector<vk::Image>
      /// target::volume of the eyes that are not being rendered; the first eye's volume is in `targets` at the end of a frame.
      eye_volumes;
  std::vector<std::unique_ptr<Pass>> passes;       ///< in the order of the list; null if the packet does not need it
  std::vector<bool> needed_passes, wanted_passes;  ///< passes that the last view needs; that a view of the image so far needs
  double retired_build_ms = 0;                     ///< build time of destroyed passes
  TargetSet drawn_targets = 0;                     ///< targets written by the last image
  std::optional<StereoComposer> stereo_composer;
  std::optional<WindowPainter> window_painter;
  bool is_composed = false;                       ///< the last image is composed of several views
  std::uint32_t view_width = 0, view_height = 0;  ///< size of one view, and of its depth and ids, pixels
  /// View depth from which depths are counted, world units.
  double reference_depth = 0;
  vk::Image ray_depth;
  std::uint32_t ray_depth_spacing = 0;  ///< spacing in the last image; 0: it has no ray depth
  std::vector<std::string> rendered_passes;
  std::size_t budget_sharers = 1;  ///< grids among which the remaining budget is divided

  /// Drops everything of a failed frame, as it may be incomplete. Returns `result`.
  template <class Outcome_>
  Outcome_ reset_on_error(Outcome_ result);
  /// Runs `work`; after a failure by lack of memory, runs it a second time with the budget divided among the packet's grids.
  template <class Work>
  auto within_budget(const FramePacket& packet, const Work& work) -> decltype(work());
  /// Returns the bytes of the budget that resident grids must leave free.
  std::uint64_t reserved_bytes(const Frame& frame) const;
  /// Returns the existing passes in order, and optionally their names.
  std::vector<Pass*> active_passes(std::vector<std::string>* names = nullptr) const;
  /// Returns the ray sampler of the existing passes; null: there is none.
  RaySampler* ray_sampler() const;
  vk::Image& output_image() { return is_composed ? stereo_composer->image() : targets.output; }
  /// Destroys all passes with their pipelines; the next image re-creates them.
  void drop_passes();
  /// Creates and destroys passes as the packet needs, uploads, and allocates the targets.
  Outcome prepare(Frame& frame);
  /// Records the passes; adjacent passes with equal targets share one rendering scope.
  Outcome record(vk::Commands& commands, Frame& frame, const std::vector<Pass*>& list);
  /// Renders one view into targets.output.
  Outcome draw(const FramePacket& packet, const RenderSettings& settings, std::size_t eye = 0, std::size_t eyes = 1, bool is_first = true,
               bool is_last = true);
  /// Loads the pages that the rays of the last image missed. Returns whether there were any.
  Result<bool> load_pages(const RenderSettings& settings);
  /// Renders the half-opacity depth of the frame, if requested.
  Outcome draw_ray_depth(Frame& frame);
  /// Returns the number of texels set in a mask image.
  Result<std::uint64_t> count_marks(vk::Image& marks);
  /// Renders all eyes, the first one last, and composes them.
  Outcome draw_eyes(const FramePacket& packet, const RenderSettings& settings);
  /// Renders the packet and its planes, and composes them.
  Outcome draw_planes(const FramePacket& packet, const RenderSettings& settings);
  /// Paints the window image; if memory is short, frees the resident grids and tries a second time.
  Outcome paint(std::uint32_t width, std::uint32_t height, const UiItems& items);
};

template <class Outcome_>
Outcome_ Renderer::Impl::reset_on_error(Outcome_ result) {
  if (result) return result;
  drop_passes();
  residency->clear();
  light.clear();
  hand_shadow = HandShadow{};
  targets = Targets{};
  eye_volumes.clear();
  return result;
}

}  // namespace catena::render
