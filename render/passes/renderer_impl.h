/// What a renderer is made of, for the two files that it is written in: renderer.cpp draws, read_back.cpp brings back what was drawn.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/passes/pass.h"
#include "render/passes/renderer.h"
#include "render/passes/stereo_compose.h"
#include "render/passes/ui.h"

namespace catena::render {

struct Renderer::Impl {
  std::unique_ptr<vk::Device> device;  // first in, last out
  std::optional<ResidencyManager> residency;
  Targets targets;
  std::vector<vk::Image>
      eye_volumes;  ///< target::volume of the eyes that are not drawn just now, but the first's, which is there at the end
  std::vector<std::unique_ptr<Pass>> passes;  ///< of the list's, in its order; null where the packet does not want it
  double retired_build_ms = 0;                ///< of passes that have gone
  TargetSet drawn_targets = 0;                ///< by the last picture
  std::optional<StereoComposer> stereo_composer;
  std::optional<WindowPainter> window_painter;
  bool is_composed = false;                       ///< the last picture is made of several views
  std::uint32_t view_width = 0, view_height = 0;  ///< of one view; its depth and ids
  double reference_depth = 0;
  vk::Image ray_depth;
  std::uint32_t ray_depth_spacing = 0;  ///< of the last picture; 0: it has none
  std::vector<std::string> rendered_passes;
  std::size_t budget_sharers = 1;  ///< grids that must share what the budget leaves

  /// What a failed frame leaves may be half made: all of it goes.
  template <class Outcome_>
  Outcome_ reset_on_error(Outcome_ result);
  template <class Work>
  auto within_budget(const FramePacket& packet, const Work& work) -> decltype(work());
  std::uint64_t reserved_bytes(const Frame& frame) const;
  std::vector<Pass*> active_passes(std::vector<std::string>* names = nullptr) const;
  vk::Image& output_image() { return is_composed ? stereo_composer->image() : targets.output; }
  void drop_passes();
  Outcome prepare(Frame& frame);
  Outcome record(vk::Commands& commands, Frame& frame, const std::vector<Pass*>& list);
  Outcome draw(const FramePacket& packet, const RenderSettings& settings, std::size_t eye = 0, std::size_t eyes = 1);
  Outcome draw_ray_depth(Frame& frame);
  Result<std::uint64_t> count_marks(vk::Image& marks);
  Outcome draw_eyes(const FramePacket& packet, const RenderSettings& settings);
  Outcome paint(std::uint32_t width, std::uint32_t height, const UiItems& items);
};

template <class Outcome_>
Outcome_ Renderer::Impl::reset_on_error(Outcome_ result) {
  if (result) return result;
  drop_passes();
  residency->clear();
  targets = Targets{};
  eye_volumes.clear();
  return result;
}

}  // namespace catena::render
