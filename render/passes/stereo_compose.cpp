// SPDX-License-Identifier: MIT
#include "render/passes/stereo_compose.h"

#include <fmt/format.h>

#include "render/frame/grid_cells.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kStereoVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kStereoPackShader[] = {
#include "spirv/stereo_compose.frag.inc"
};
constexpr std::uint32_t kStereoAnaglyphShader[] = {
#include "spirv/anaglyph.frag.inc"
};

constexpr std::uint32_t kAnaglyph = 16;  // pattern of the pipeline besides those of stereo_compose.frag

bool is_anaglyph(Packing packing) { return packing == Packing::anaglyph || packing == Packing::anaglyph_gray; }

std::uint32_t pattern_of(Packing packing) {
  switch (packing) {
    case Packing::rows:
      return STEREO_PATTERN_ROWS;
    case Packing::columns:
      return STEREO_PATTERN_COLUMNS;
    case Packing::checkerboard:
      return STEREO_PATTERN_CHECKERBOARD;
    case Packing::anaglyph:
    case Packing::anaglyph_gray:
      return kAnaglyph;
    default:
      return STEREO_PATTERN_WHOLE;
  }
}

glm::mat3 rows(const glm::vec3& r, const glm::vec3& g, const glm::vec3& b) {
  return glm::mat3(r.x, g.x, b.x, r.y, g.y, b.y, r.z, g.z, b.z);
}

}  // namespace

shared::AnaglyphData anaglyph_matrices(Packing packing) {
  CATENA_ASSERT(is_anaglyph(packing));
  shared::AnaglyphData data{};
  if (packing == Packing::anaglyph_gray) {
    const glm::vec3 luminance(0.2126f, 0.7152f, 0.0722f), none(0.0f);
    data.left = rows(luminance, none, none);
    data.right = rows(none, luminance, luminance);
    return data;
  }
  // matrices of E. Dubois, A projection method to generate anaglyph stereo images, 2001; rows R, G, B
  data.left = rows({0.4561f, 0.500484f, 0.176381f}, {-0.0400822f, -0.0378246f, -0.0157589f}, {-0.0152161f, -0.0205971f, -0.00546856f});
  data.right = rows({-0.0434706f, -0.0879388f, -0.00155529f}, {0.378476f, 0.73364f, -0.0184503f}, {-0.0721527f, -0.112961f, 1.2264f});
  return data;
}

Outcome StereoComposer::begin(Packing packing, std::size_t views, std::uint32_t width, std::uint32_t height) {
  if (is_anaglyph(packing) && views != 2) return Error{fmt::format("an anaglyph has {} views, expected 2", views)};
  const PackedSize size = packed_size(packing, views, width, height);
  const std::uint32_t max_size = device_->info().limits.maxImageDimension2D;
  if (size.width == 0 || size.height == 0 || size.width > max_size || size.height > max_size)
    return Error{fmt::format("{} views of {} x {} pixels make an image of {} x {}, expected 1 to {} in each direction", views, width,
                             height, size.width, size.height, max_size)};
  packing_ = packing;
  size_ = size;
  const std::size_t shown = packing == Packing::single ? 1 : views;
  views_.resize(shown);
  data_.resize(shown);
  return Done{};
}

void StereoComposer::store_view(std::size_t view, vk::Image& image) { std::swap(views_.at(view), image); }

Outcome StereoComposer::record(vk::Commands& commands) {
  const vk::ImageInfo& one = views_.front().info();
  const VkExtent3D& have = composed_.info().extent;
  if (!composed_ || have.width != size_.width || have.height != size_.height || composed_.info().format != one.format) {
    vk::ImageInfo info;
    info.format = one.format;
    info.extent = {std::uint32_t(size_.width), std::uint32_t(size_.height), 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    CATENA_TRY(composed_, vk::Image::create(*device_, info));
  }
  for (vk::Image& view : views_) commands.transition(view, vk::kFragmentRead);
  const vk::ColorTarget target{&composed_, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&target, 1}, {});
  const std::size_t count = is_anaglyph(packing_) ? 0 : views_.size();
  if (is_anaglyph(packing_)) CATENA_CHECK(record_anaglyph(commands));
  for (std::size_t k = 0; k < count; ++k) CATENA_CHECK(record_view(commands, k));
  commands.end_pass();
  commands.transition(composed_, vk::kTransferRead);
  return Done{};
}

Result<const vk::Pipeline*> StereoComposer::pipeline(std::uint32_t pattern) {
  vk::Pipeline& pipeline = pipelines_[{composed_.info().format, pattern}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kStereoVertexShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}};
    info.colors = {composed_.info().format};
    if (pattern == kAnaglyph) {
      info.fragment = kStereoAnaglyphShader;
      info.layout_bindings.push_back({2, vk::DescriptorKind::texture});
    } else {
      info.fragment = kStereoPackShader;
      info.constants = {pattern};
    }
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome StereoComposer::record_view(vk::Commands& commands, std::size_t view) {
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(pattern_of(packing_)));
  // area of the view in the image, and the number of its pixels per image pixel
  const auto k = std::uint32_t(view), n = std::uint32_t(views_.size());
  VkRect2D area{{0, 0}, {std::uint32_t(size_.width), std::uint32_t(size_.height)}};
  shared::StereoComposeData data{{0, 0}, 1, 1, k, n};
  if (packing_ == Packing::side_by_side || packing_ == Packing::side_by_side_half) {
    area.extent.width /= n;
    area.offset.x = std::int32_t(k * area.extent.width);
    if (packing_ == Packing::side_by_side_half) data.block_x = n;
  }
  if (packing_ == Packing::top_bottom || packing_ == Packing::top_bottom_half) {
    area.extent.height /= n;
    area.offset.y = std::int32_t(k * area.extent.height);
    if (packing_ == Packing::top_bottom_half) data.block_y = n;
  }
  if (packing_ == Packing::grid) {
    const int cell = grid_cell(int(k));
    area.extent = {area.extent.width / 2, area.extent.height / 2};
    area.offset = {std::int32_t(cell % 2 * area.extent.width), std::int32_t(cell / 2 * area.extent.height)};
  }
  data.first = {float(area.offset.x), float(area.offset.y)};
  CATENA_CHECK(vk::write_uniform(*device_, data_[view], data));
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &data_[view], nullptr, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, &views_[view], nullptr}};
  commands.set_scissor(area);
  commands.bind(*pipe, bindings);
  commands.draw_triangle();
  return Done{};
}

Outcome StereoComposer::record_anaglyph(vk::Commands& commands) {
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(pattern_of(packing_)));
  CATENA_CHECK(vk::write_uniform(*device_, matrices_, anaglyph_matrices(packing_)));
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &matrices_, nullptr, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, &views_[0], nullptr},
                                  {2, vk::DescriptorKind::texture, nullptr, &views_[1], nullptr}};
  commands.bind(*pipe, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
