#include "render/passes/still_surfaces.h"

#include <cstring>

#include "render/passes/pass.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kStillSurfacesVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kStillSurfacesFragmentShader[] = {
#include "spirv/still_surfaces.frag.inc"
};

}  // namespace

bool StillSurfaces::Look::is(const Look& other) const {
  if (version != other.version || surfaces.size() != other.surfaces.size()) return false;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    shared::FrameData a = surfaces[i], b = other.surfaces[i];
    // they follow from all that is drawn; the picture's own are taken
    a.depth_near = b.depth_near = a.depth_far = b.depth_far = 0;
    if (std::memcmp(&a, &b, sizeof(a)) != 0) return false;
  }
  return true;
}

Outcome StillSurfaces::fit(vk::Device& device, const VkExtent3D& picture) {
  const VkExtent3D& have = color_.info().extent;
  if (look_ && have.width == picture.width && have.height == picture.height) return Done{};
  look_.reset();
  has_kept_ = false;
  CATENA_CHECK(vk::fit_image(device, color_, kOpaqueFormat, picture.width, picture.height));
  CATENA_CHECK(vk::fit_image(device, depth_, kDepthValueFormat, picture.width, picture.height));
  CATENA_CHECK(vk::fit_image(device, id_, kIdFormat, picture.width, picture.height));
  return vk::fit_image(device, depth_buffer_, kDepthBufferFormat, picture.width, picture.height,
                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
}

Outcome StillSurfaces::update(vk::Commands& commands, Look look, const std::function<Outcome()>& draw) {
  has_kept_ = look_ && look_->is(look);
  if (has_kept_) return Done{};
  look_.reset();
  const std::array<float, 4> empty{0, 0, 0, 0}, far{NO_DEPTH, 0, 0, 0};
  const vk::ColorTarget targets[] = {{&color_, empty}, {&depth_, far}, {&id_, empty}};
  commands.begin_pass(targets, {&depth_buffer_, 0.0f});
  CATENA_CHECK(draw());
  commands.end_pass();
  for (vk::Image* image : {&color_, &depth_, &id_}) commands.use(*image, vk::kFragmentRead);
  look_ = std::move(look);
  return Done{};
}

Outcome StillSurfaces::draw(vk::Device& device, vk::Commands& commands, const shared::FrameData& frame) {
  if (!pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kStillSurfacesVertexShader;
    info.fragment = kStillSurfacesFragmentShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::texture}, {2, vk::Resource::texture}, {3, vk::Resource::texture}};
    info.colors = opaque_formats();
    info.depth = true;
    CATENA_TRY(pipeline_, vk::Pipeline::create(device, info));
  }
  CATENA_CHECK(vk::write_uniform(device, uniform_, frame));
  const vk::Binding bindings[] = {{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::Resource::texture, nullptr, &color_, nullptr},
                                  {2, vk::Resource::texture, nullptr, &depth_, nullptr},
                                  {3, vk::Resource::texture, nullptr, &id_, nullptr}};
  commands.bind(pipeline_, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
