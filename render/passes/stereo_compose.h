/// The finished pictures of several views into one (render/frame/packing.h). Each view is drawn on its own, as any picture is, into the
/// renderer's picture; keep() takes that image away and puts another in its place, so that no view waits for a copy.
/// Frame thread only.
#pragma once
#include <map>
#include <vector>

#include "render/frame/packing.h"
#include "render/vk/commands.h"
#include "shaders/shared/stereo_compose.h"

namespace catena::render {

class StereoComposer {
 public:
  explicit StereoComposer(vk::Device& device) : device_(&device) {}

  /// Before the views: how many there are. Errors: a packing that does not take so many, a picture beyond the device.
  Outcome begin(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height);
  /// Swaps the finished picture of a view with the image that was kept for it last time (or none).
  void store_view(std::size_t view, vk::Image& picture);
  /// After the views: draws the packed picture.
  Outcome record(vk::Commands& commands);

  vk::Image& image() { return composed_; }

 private:
  Result<const vk::Pipeline*> pipeline(std::uint32_t pattern);
  Outcome record_view(vk::Commands& commands, std::size_t view);
  Outcome record_anaglyph(vk::Commands& commands);

  vk::Device* device_;
  Packing packing_ = Packing::single;
  PackedSize size_;
  std::vector<vk::Image> views_;
  std::vector<vk::Buffer> data_;  ///< one a view
  vk::Buffer matrices_;
  vk::Image composed_;
  std::map<std::pair<VkFormat, std::uint32_t>, vk::Pipeline> pipelines_;  ///< by format and pattern
};

/// Of Dubois' projection for LCD screens with red-cyan glasses, and of the grey one; linear light.
shared::AnaglyphData anaglyph_matrices(Packing packing);

}  // namespace catena::render
