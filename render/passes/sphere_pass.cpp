// SPDX-License-Identifier: MIT
// Draws the SphereSet of point sets: one instanced square per sphere (shaders/shared/sphere.h), 24 bytes each.
#include <algorithm>
#include <cmath>

#include "render/passes/passes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"
#include "shaders/shared/sphere.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kSphereVertexShader[] = {
#include "spirv/sphere.vert.inc"
};
constexpr std::uint32_t kSphereFragmentShader[] = {
#include "spirv/sphere.frag.inc"
};

constexpr std::uint32_t kCorners = 6;

std::uint32_t packed(const Color& c) {
  const auto share = [](float x) { return static_cast<std::uint32_t>(std::lround(std::clamp(x, 0.0f, 1.0f) * 255)); };
  return share(c.r) | share(c.g) << 8 | share(c.b) << 16;
}

class SpherePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    std::unique_ptr<SpherePass> self(new SpherePass);
    vk::GraphicsInfo info;
    info.vertex = kSphereVertexShader;
    info.fragment = kSphereFragmentShader;
    info.layout_bindings = {
        {0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::buffer}, {vk::kSharedBinding, vk::DescriptorKind::sampled}};
    info.colors = opaque_formats();
    info.has_depth = true;
    CATENA_TRY(self->pipeline_, vk::Pipeline::create(device, info));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }

  Outcome prepare(Frame& frame) override {
    const FramePacket& packet = frame.packet;
    left_out_ = packet.tubes.empty() ? packet.omitted : std::string();
    if (packet.spheres == built_) return Done{};
    built_.clear();
    buffers_.clear();
    bounds_ = {};
    for (const SpheresItem& item : packet.spheres)
      for (std::size_t i = 0; i < item.spheres->offsets.size(); ++i)
        bounds_.extend(item.spheres->position(i), double(item.spheres->radii[i]));
    if (bounds_.empty()) return Done{};
    origin_ = bounds_.center();
    for (const SpheresItem& item : packet.spheres) CATENA_CHECK(upload(frame.device, item));
    built_ = packet.spheres;
    return Done{};
  }
  Bounds bounds() const override { return bounds_; }
  std::string warning() const override { return left_out_; }

  Outcome record(vk::Commands& commands, Frame& frame) override {
    if (buffers_.empty()) return Done{};
    CATENA_CHECK(vk::write_uniform(frame.device, uniform_, frame.rays.mesh_frame_data(origin_)));
    for (const auto& [buffer, count] : buffers_) {
      const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                      {1, vk::DescriptorKind::buffer, &buffer, nullptr, nullptr}};
      commands.bind(pipeline_, bindings);
      commands.draw(kCorners, count);
    }
    return Done{};
  }

 private:
  Outcome upload(vk::Device& device, const SpheresItem& item) {
    const SphereSet& balls = *item.spheres;
    if (balls.offsets.empty()) return Done{};
    std::vector<shared::SphereData> data;
    data.reserve(balls.offsets.size());
    const std::uint32_t id = item.id | (item.is_clipped ? 0u : UNCLIPPED);
    for (std::size_t i = 0; i < balls.offsets.size(); ++i)
      data.push_back({glm::vec3(balls.position(i) - origin_), balls.radii[i], packed(balls.colors[i]), id});
    CATENA_TRY(vk::Buffer buffer, vk::upload_buffer(device, std::as_bytes(std::span(data)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    buffers_.emplace_back(std::move(buffer), static_cast<std::uint32_t>(data.size()));
    return Done{};
  }

  vk::Pipeline pipeline_;
  vk::Buffer uniform_;
  std::vector<std::pair<vk::Buffer, std::uint32_t>> buffers_;
  Vec3 origin_{0.0};
  Bounds bounds_;
  std::vector<SpheresItem> built_;
  std::string left_out_;
};

}  // namespace

const PassEntry kSpherePass{"points", [](const Frame& frame) { return !frame.packet.spheres.empty(); }, SpherePass::create};

}  // namespace catena::render
