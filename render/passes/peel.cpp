#include "render/passes/peel.h"

#include "engine/base/assert.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kData = 5, kOpaqueDepth = 6, kPassedDepth = 7, kPassedId = 8;

}  // namespace

void set_peel_stage(vk::GraphicsInfo& info, std::uint32_t mode, bool has_opaque) {
  info.slots.push_back({kData, vk::Resource::uniform});
  for (const std::uint32_t binding : {kOpaqueDepth, kPassedDepth, kPassedId}) info.slots.push_back({binding, vk::Resource::texture});
  CATENA_ASSERT(info.constants.size() == 1);  // constants 1 and 2 are these
  info.constants.insert(info.constants.end(), {mode, has_opaque});
  info.colors = opaque_formats();
  info.depth = mode != MODE_REST;
  if (mode != MODE_REST) return;
  info.colors[0] = kRestFormat;
  info.blends = {vk::Blend::collect, vk::Blend::least, vk::Blend::keep};
}

void add_peel_bindings(std::vector<vk::Binding>& bindings, const Peel& peel, const vk::Buffer& layer_data) {
  const auto texture = [&](std::uint32_t binding, const vk::Image* image, const vk::Image* otherwise) {
    bindings.push_back({binding, vk::Resource::texture, nullptr, image ? image : otherwise, nullptr});
  };
  bindings.push_back({kData, vk::Resource::uniform, &layer_data, nullptr, nullptr});
  texture(kOpaqueDepth, peel.opaque_depth, peel.none);
  texture(kPassedDepth, peel.passed_depth, peel.none);
  texture(kPassedId, peel.passed_id, peel.none_id);
}

shared::LayerData layer_data(const CameraRays& rays, float opacity) {
  shared::LayerData data{};
  data.reference_depth = float(rays.reference_depth);
  data.depth_near = float(rays.depth_near);
  data.depth_far = float(rays.depth_far);
  data.orthographic = rays.camera.orthographic;
  data.opacity = opacity;
  return data;
}

}  // namespace catena::render
