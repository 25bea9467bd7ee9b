/// Image uploads through one staging buffer of bounded size.
#pragma once
#include <functional>

#include "render/vk/commands.h"

namespace catena::render {

/// Fills `image` in pieces of whole z-ranges: fill(first_z, count_z, bytes) writes the texels x fastest. `granule` z-planes stay
/// together. Ends with the image ready for shaders.
Outcome upload_planes(vk::Device& device, vk::Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill);

}  // namespace catena::render
