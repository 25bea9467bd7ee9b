// SPDX-License-Identifier: MIT
#include "render/vk/commands.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "render/vk/instance.h"

namespace catena::render::vk {

Result<Commands> Commands::begin(Device& device) {
  CATENA_TRY(const VkCommandBuffer buffer, device.acquire_command_buffer());
  Commands self(device, buffer);
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  CATENA_VK(vkBeginCommandBuffer(buffer, &begin), "begin a command buffer");
  self.timestamp_ = device.timestamps().begin(buffer);
  return self;
}

Commands::~Commands() {
  device_->timestamps().cancel(timestamp_);
  if (buffer_) device_->retire([device = device_, buffer = buffer_] { device->release_command_buffer(buffer); });
}

void Commands::transition(Image& image, const ResourceUse& next) {
  constexpr VkAccessFlags2 writes = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const bool same = image.layout == next.layout && image.stage == next.stage && image.access == next.access;
  if (same && !(next.access & writes)) return;
  barrier(image.handle(), image.aspect(), {image.layout, image.stage, image.access}, next);
  image.layout = next.layout;
  image.stage = next.stage;
  image.access = next.access;
}

void Commands::barrier(VkImage image, VkImageAspectFlags aspect, const ResourceUse& from, const ResourceUse& to) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, 1, 0, 1};
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(buffer_, &info);
}

void Commands::barrier(const Buffer& buffer, const ResourceUse& from, const ResourceUse& to) {
  VkBufferMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.buffer = buffer.handle();
  barrier.size = VK_WHOLE_SIZE;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.bufferMemoryBarrierCount = 1;
  info.pBufferMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(buffer_, &info);
}

void Commands::copy(const Buffer& from, VkDeviceSize offset, Image& to, VkOffset3D at, VkExtent3D extent) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {to.aspect(), 0, 0, 1};
  region.imageOffset = at;
  region.imageExtent = extent;
  vkCmdCopyBufferToImage(buffer_, from.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  ++device_->counters().uploads;
  device_->counters().upload_bytes += texel_bytes(to.info().format) * extent.width * extent.height * extent.depth;
}

void Commands::copy(const Buffer& from, const Buffer& to, VkDeviceSize size) {
  const VkBufferCopy region{0, 0, size};
  vkCmdCopyBuffer(buffer_, from.handle(), to.handle(), 1, &region);
  ++device_->counters().uploads;
  device_->counters().upload_bytes += size;
}

void Commands::copy(Image& from, const Buffer& to) {
  transition(from, kTransferRead);
  VkBufferImageCopy region{};
  region.imageSubresource = {from.aspect(), 0, 0, 1};
  region.imageExtent = from.info().extent;
  vkCmdCopyImageToBuffer(buffer_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1, &region);
  barrier(to, kTransferWrite, kHostRead);
}

void Commands::blit(const Image& from, const Image& to) { blit(from, to.handle(), {to.info().extent.width, to.info().extent.height}); }

void Commands::blit(const Image& from, VkImage to, VkExtent2D extent) {
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {std::int32_t(from.info().extent.width), std::int32_t(from.info().extent.height), 1};
  region.dstOffsets[1] = {std::int32_t(extent.width), std::int32_t(extent.height), 1};
  vkCmdBlitImage(buffer_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                 VK_FILTER_LINEAR);
}

void Commands::begin_pass(std::span<const ColorTarget> colors, const DepthTarget& depth, const std::optional<VkRect2D>& area) {
  VkExtent3D extent = depth.image ? depth.image->info().extent : colors.front().image->info().extent;
  std::vector<VkRenderingAttachmentInfo> attachments;
  for (const ColorTarget& target : colors) {
    transition(*target.image, kColorTarget);
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = target.image->view();
    info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    info.loadOp = target.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (target.clear) std::copy(target.clear->begin(), target.clear->end(), info.clearValue.color.float32);
    attachments.push_back(info);
  }
  VkRenderingAttachmentInfo depth_info{};
  depth_info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  if (depth.image) {
    transition(*depth.image, kDepthTarget);
    depth_info.imageView = depth.image->view();
    depth_info.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth_info.loadOp = depth.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    depth_info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth_info.clearValue.depthStencil.depth = depth.clear.value_or(0);
  }
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = area.value_or(VkRect2D{{0, 0}, {extent.width, extent.height}});
  info.layerCount = 1;
  info.colorAttachmentCount = std::uint32_t(attachments.size());
  info.pColorAttachments = attachments.data();
  info.pDepthAttachment = depth.image ? &depth_info : nullptr;
  vkCmdBeginRendering(buffer_, &info);
  const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
  vkCmdSetViewport(buffer_, 0, 1, &viewport);
  set_scissor(info.renderArea);
}

void Commands::end_pass() { vkCmdEndRendering(buffer_); }
void Commands::set_scissor(const VkRect2D& area) { vkCmdSetScissor(buffer_, 0, 1, &area); }

void Commands::bind(const Pipeline& pipeline, std::span<const Binding> own) {
  vkCmdBindPipeline(buffer_, pipeline.bind_point(), pipeline.handle());
  std::vector<Binding> bindings(own.begin(), own.end());
  if (pipeline.uses_shared_image())
    bindings.push_back({kSharedBinding, DescriptorKind::sampled, nullptr, device_->shared_image(), device_->shared_sampler()});
  std::vector<VkDescriptorBufferInfo> buffers(bindings.size());
  std::vector<VkDescriptorImageInfo> images(bindings.size());
  std::vector<VkWriteDescriptorSet> writes;
  for (std::size_t i = 0; i < bindings.size(); ++i) {
    const Binding& b = bindings[i];
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstBinding = b.binding;
    write.descriptorCount = 1;
    write.descriptorType = descriptor_type(b.kind);
    if (b.kind == DescriptorKind::buffer || b.kind == DescriptorKind::uniform) {
      buffers[i] = {b.buffer->handle(), 0, VK_WHOLE_SIZE};
      write.pBufferInfo = &buffers[i];
    } else {
      images[i] = {b.sampler ? b.sampler->handle() : VK_NULL_HANDLE, b.image->view(),
                   b.kind == DescriptorKind::storage_image ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      write.pImageInfo = &images[i];
    }
    writes.push_back(write);
  }
  if (!writes.empty())
    device_->push_descriptors()(buffer_, pipeline.bind_point(), pipeline.layout(), 0, std::uint32_t(writes.size()), writes.data());
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances) { vkCmdDraw(buffer_, vertices, instances, 0, 0); }
void Commands::draw_triangle() { vkCmdDraw(buffer_, 3, 1, 0, 0); }

void Commands::draw_indexed(const Buffer& vertices, const Buffer& indices, std::uint32_t index_count) {
  bind_mesh(vertices, indices, VK_INDEX_TYPE_UINT32);
  draw_mesh(0, index_count, 0);
}

void Commands::bind_mesh(const Buffer& vertices, const Buffer& indices, VkIndexType type) {
  const VkBuffer buffer = vertices.handle();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(buffer_, 0, 1, &buffer, &offset);
  bind_indices(indices, type);
}

void Commands::bind_indices(const Buffer& indices, VkIndexType type) { vkCmdBindIndexBuffer(buffer_, indices.handle(), 0, type); }

void Commands::draw_mesh(std::uint32_t first_index, std::uint32_t index_count, std::uint32_t first_vertex, std::uint32_t instance) {
  vkCmdDrawIndexed(buffer_, index_count, 1, first_index, std::int32_t(first_vertex), instance);
}

void Commands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) { vkCmdDispatch(buffer_, x, y, z); }

Result<std::uint64_t> Commands::submit(VkSemaphore wait, VkSemaphore signal) {
  device_->timestamps().end(buffer_, timestamp_);
  CATENA_VK(vkEndCommandBuffer(buffer_), "record commands");
  CATENA_TRY(const std::uint64_t value, device_->submit(buffer_, wait, signal));
  device_->retire([device = device_, lap = timestamp_] { device->counters().gpu_ns += device->timestamps().read_ns(lap); });
  timestamp_.reset();
  return value;
}

Outcome Commands::finish() {
  CATENA_TRY(const std::uint64_t value, submit());
  return device_->wait(value);
}

Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill) {
  // the budget includes staging memory: little remaining memory allows only small chunks
  const VkDeviceSize staging_limit = std::min<VkDeviceSize>(VkDeviceSize(32) << 20, device.memory_available() / 4);
  const VkExtent3D extent = image.info().extent;
  const VkDeviceSize plane = texel_bytes(image.info().format) * extent.width * extent.height;
  const auto granules = std::uint32_t(std::max<VkDeviceSize>(1, staging_limit / (plane * granule)));
  const std::uint32_t piece = std::min(extent.depth, granules * granule);
  CATENA_TRY(const Buffer staging, Buffer::create(device, plane * piece, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
  for (std::uint32_t first = 0; first < extent.depth; first += piece) {
    const std::uint32_t count = std::min(piece, extent.depth - first);
    fill(first, count, staging.bytes().data());
    CATENA_TRY(Commands commands, Commands::begin(device));
    commands.transition(image, kTransferWrite);
    commands.copy(staging, 0, image, {0, 0, std::int32_t(first)}, {extent.width, extent.height, count});
    if (first + count == extent.depth) commands.transition(image, kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
  CATENA_TRY(const Buffer staging, Buffer::create(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
  std::memcpy(staging.bytes().data(), bytes.data(), bytes.size());
  CATENA_TRY(Buffer buffer, Buffer::create(device, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::device));
  CATENA_TRY(Commands commands, Commands::begin(device));
  commands.copy(staging, buffer, bytes.size());
  commands.barrier(buffer, kTransferWrite, {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
  CATENA_CHECK(commands.finish());
  return buffer;
}

}  // namespace catena::render::vk
