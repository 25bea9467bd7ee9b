// SPDX-License-Identifier: MIT
/// Stereo composition: packs the finished images of several views into one (render/frame/packing.h). Each view is rendered like any image
/// into the renderer's output image; store_view() swaps that image with another one, so that no view waits for a copy. Frame thread only.
#pragma once
#include <map>
#include <vector>

#include "render/frame/packing.h"
#include "render/vk/commands.h"
#include "shaders/shared/stereo_compose.h"

namespace catena::render {

/// Composes the views of one packet; keeps the view images for the next one.
class StereoComposer {
 public:
  explicit StereoComposer(vk::Device& device) : device_(&device) {}

  /// To be called before the views are rendered. An Error if the packing does not support this number of views or the packed image is empty
  /// or exceeds the device's image size.
  Outcome begin(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height);
  /// Swaps the finished image of a view with the image stored for it for the previous packet (or an empty one).
  void store_view(std::size_t view, vk::Image& image);
  /// To be called after all views are rendered: records the composition into image().
  Outcome record(vk::Commands& commands);

  /// Returns the composed image.
  vk::Image& image() { return composed_; }

 private:
  Result<const vk::Pipeline*> pipeline(std::uint32_t pattern);
  Outcome record_view(vk::Commands& commands, std::size_t view);
  Outcome record_anaglyph(vk::Commands& commands);

  vk::Device* device_;
  Packing packing_ = Packing::single;
  PackedSize size_;
  std::vector<vk::Image> views_;
  std::vector<vk::Buffer> data_;  ///< one per view
  vk::Buffer matrices_;
  vk::Image composed_;
  std::map<std::pair<VkFormat, std::uint32_t>, vk::Pipeline> pipelines_;  ///< key: format and pattern
};

/// Returns the matrices of Dubois' projection for LCD screens with red-cyan glasses, or of the gray anaglyph; linear light.
shared::AnaglyphData anaglyph_matrices(Packing packing);

}  // namespace catena::render
