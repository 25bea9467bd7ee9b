#include "render/passes/overlay.h"

#include <algorithm>
#include <cstring>

#include "render/passes/grid_bindings.h"
#include "render/passes/overlay/furniture.h"
#include "render/vk/upload.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/overlay.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/overlay.frag.inc"
};
constexpr std::uint32_t kBlendShader[] = {
#include "spirv/overlay_blend.comp.inc"
};
constexpr VkFormat kAtlasFormat = VK_FORMAT_R8_UNORM;
constexpr VkFormat kOverlayFormat = VK_FORMAT_R8G8B8A8_UNORM;  // premultiplied
constexpr vk::Use kComputeBoth{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
constexpr double kSlackShare = 1e-3;  // of the distance: a label on a surface is not behind it

/// Host memory with these items, larger than before only if it must be.
template <class T>
Outcome write_items(vk::Device& device, vk::Buffer& buffer, const std::vector<T>& items) {
  const std::size_t bytes = std::max<std::size_t>(1, items.size()) * sizeof(T);
  if (!buffer || buffer.size() < bytes) {
    CATENA_TRY(buffer, vk::Buffer::create(device, 2 * bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vk::Memory::upload));
  }
  if (!items.empty()) std::memcpy(buffer.bytes().data(), items.data(), items.size() * sizeof(T));
  return Done{};
}

}  // namespace

Result<OverlayPass> OverlayPass::create(vk::Device& device) {
  OverlayPass self;
  self.device_ = &device;
  self.typesetter_ = std::make_unique<Typesetter>();
  vk::GraphicsInfo draw;
  draw.vertex = kVertexShader;
  draw.fragment = kFragmentShader;
  draw.slots = {{0, vk::Resource::uniform},
                {1, vk::Resource::buffer},
                {2, vk::Resource::buffer},
                {3, vk::Resource::texture},
                {4, vk::Resource::texture}};
  draw.colors = {kOverlayFormat};
  draw.blend = true;
  CATENA_TRY(self.draw_, vk::Pipeline::create(device, draw));
  vk::ComputeInfo blend;
  blend.shader = kBlendShader;
  blend.slots = {{0, vk::Resource::texture}, {1, vk::Resource::storage_image}};
  CATENA_TRY(self.blend_, vk::Pipeline::create(device, blend));
  return self;
}

Outcome OverlayPass::upload_atlas() {
  const GlyphAtlas& atlas = typesetter_->atlas();
  if (atlas_ && (atlas_version_ == atlas.version())) return Done{};
  // without a glyph: one row, never read
  const auto height = std::uint32_t(std::max(1, atlas.height()));
  if (!atlas_ || atlas_.info().extent.height != height) {
    vk::ImageInfo info;
    info.format = kAtlasFormat;
    info.extent = {std::uint32_t(GlyphAtlas::kWidth), height, 1};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    CATENA_TRY(atlas_, vk::Image::create(*device_, info));
  }
  CATENA_CHECK(vk::upload_planes(*device_, atlas_, 1, [&](std::uint32_t, std::uint32_t, std::byte* out) {
    if (!atlas.pixels().empty()) std::memcpy(out, atlas.pixels().data(), atlas.pixels().size());
  }));
  atlas_version_ = atlas.version();
  return Done{};
}

Outcome OverlayPass::prepare(const FramePacket& packet, const CameraRays& rays) {
  const Overlay& overlay = packet.overlay;
  Canvas canvas(packet, *typesetter_);
  draw_labels(canvas, overlay, rays.camera, rays.reference_depth);
  draw_scalar_bars(canvas, overlay);
  if (overlay.orientation_marker) draw_orientation_marker(canvas, *overlay.orientation_marker, rays.camera);
  if (overlay.status) draw_status(canvas, *overlay.status);
  draw_texts(canvas, overlay);
  const std::vector<shared::OverlayShape>& shapes = canvas.finish();
  count_ = std::uint32_t(shapes.size());
  slack_ = kSlackShare * rays.depth_far;
  CATENA_CHECK(write_items(*device_, shapes_, shapes));
  CATENA_CHECK(write_items(*device_, stops_, canvas.stops()));
  CATENA_CHECK(upload_atlas());
  const VkExtent3D& have = image_.info().extent;
  if (image_ && have.width == packet.width && have.height == packet.height) return Done{};
  vk::ImageInfo info;
  info.format = kOverlayFormat;
  info.extent = {packet.width, packet.height, 1};
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  CATENA_TRY(image_, vk::Image::create(*device_, info));
  return Done{};
}

Outcome OverlayPass::record(vk::Commands& commands, Targets& targets, vk::Image* opaque_depth) {
  if (count_ == 0) return Done{};
  const VkExtent3D& extent = image_.info().extent;
  shared::OverlayData data{};
  data.half_size = {0.5f * float(extent.width), 0.5f * float(extent.height)};
  data.depth_slack = float(slack_);
  data.has_depth = opaque_depth != nullptr;
  CATENA_CHECK(write_uniform(*device_, uniform_, data));

  // the shapes, in order
  if (opaque_depth) commands.use(*opaque_depth, vk::kShaderRead);
  const vk::ColorTarget target{&image_, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&target, 1}, {});
  const vk::Binding drawn[] = {{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                               {1, vk::Resource::buffer, &shapes_, nullptr, nullptr},
                               {2, vk::Resource::buffer, &stops_, nullptr, nullptr},
                               {3, vk::Resource::texture, nullptr, &atlas_, nullptr},
                               {4, vk::Resource::texture, nullptr, opaque_depth ? opaque_depth : &targets.none, nullptr}};
  commands.bind(draw_, drawn);
  commands.draw(6 * count_, 1);
  commands.end_pass();

  // into the picture
  commands.use(image_, vk::kFragmentRead);
  commands.use(targets.picture, kComputeBoth);
  const vk::Binding blended[] = {{0, vk::Resource::texture, nullptr, &image_, nullptr},
                                 {1, vk::Resource::storage_image, nullptr, &targets.picture, nullptr}};
  commands.bind(blend_, blended);
  commands.dispatch((extent.width + 15) / 16, (extent.height + 3) / 4, 1);
  commands.use(targets.picture, vk::kTransferRead);
  return Done{};
}

}  // namespace catena::render
