// SPDX-License-Identifier: MIT
#include "render/vk/pipeline.h"

#include <utility>

#include "render/vk/instance.h"

namespace catena::render::vk {
namespace {

/// Shader module, destroyed once the pipeline is created.
class ShaderModule {
 public:
  explicit ShaderModule(Device& device) : device_(device) {}
  ~ShaderModule() {
    if (module_) vkDestroyShaderModule(device_.handle(), module_, nullptr);
  }
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;
  Outcome load(Spirv words) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    words = device_.shaders().resolve(words);
    info.codeSize = words.size_bytes();
    info.pCode = words.data();
    CATENA_VK(vkCreateShaderModule(device_.handle(), &info, nullptr, &module_), "load a shader");
    return Done{};
  }
  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, const VkSpecializationInfo* constants) const {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = which;
    info.module = module_;
    info.pName = "main";
    info.pSpecializationInfo = constants;
    return info;
  }

 private:
  Device& device_;
  VkShaderModule module_ = VK_NULL_HANDLE;
};

/// Specialization constants with the ids 0, 1, 2, ... Points into the vector passed to the constructor.
struct Specialization {
  std::vector<VkSpecializationMapEntry> entries;
  VkSpecializationInfo info{};
  explicit Specialization(const std::vector<std::uint32_t>& constants) {
    for (std::uint32_t i = 0; i < constants.size(); ++i)
      entries.push_back({i, std::uint32_t(i * sizeof(std::uint32_t)), sizeof(std::uint32_t)});
    info.mapEntryCount = std::uint32_t(entries.size());
    info.pMapEntries = entries.data();
    info.dataSize = constants.size() * sizeof(std::uint32_t);
    info.pData = constants.data();
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;
};

VkPipelineColorBlendAttachmentState blend_state(Blend blend) {
  VkPipelineColorBlendAttachmentState state{};
  if (blend == Blend::keep) return state;
  state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  state.blendEnable = blend != Blend::replace;
  state.srcColorBlendFactor = state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
  state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  if (blend == Blend::over) {
    state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  }
  if (blend == Blend::over_straight) {
    state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  }
  if (blend == Blend::min) state.colorBlendOp = state.alphaBlendOp = VK_BLEND_OP_MIN;
  return state;
}

}  // namespace

VkDescriptorType descriptor_type(DescriptorKind resource) {
  switch (resource) {
    case DescriptorKind::uniform:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case DescriptorKind::buffer:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case DescriptorKind::sampled:
      return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case DescriptorKind::texture:
      return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case DescriptorKind::storage_image:
      return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  }
  return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

Outcome Pipeline::create_layout(std::span<const LayoutBinding> slots, VkShaderStageFlags stages) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const LayoutBinding& slot : slots) bindings.push_back({slot.binding, descriptor_type(slot.kind), 1, stages, nullptr});
  uses_shared_image_ = std::ranges::any_of(slots, [](const LayoutBinding& slot) { return slot.binding == kSharedBinding; });
  VkDescriptorSetLayoutCreateInfo set{};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = std::uint32_t(bindings.size());
  set.pBindings = bindings.data();
  CATENA_VK(vkCreateDescriptorSetLayout(device_->handle(), &set, nullptr, &set_), "create a descriptor layout");
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_;
  CATENA_VK(vkCreatePipelineLayout(device_->handle(), &layout, nullptr, &layout_), "create a pipeline layout");
  return Done{};
}

Result<Pipeline> Pipeline::create(Device& device, const GraphicsInfo& info) {
  Pipeline self;
  self.device_ = &device;
  CATENA_CHECK(self.create_layout(info.layout_bindings, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT));
  ShaderModule vertex(device), fragment(device);
  CATENA_CHECK(vertex.load(info.vertex));
  CATENA_CHECK(fragment.load(info.fragment));
  const Specialization constants(info.constants);
  const VkPipelineShaderStageCreateInfo stages[] = {vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, nullptr),
                                                    fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT, &constants.info)};

  // vertex input
  const VkVertexInputBindingDescription binding{0, info.vertex_stride, VK_VERTEX_INPUT_RATE_VERTEX};
  std::vector<VkVertexInputAttributeDescription> attributes;
  for (const VertexAttribute& a : info.attributes) attributes.push_back({a.location, 0, a.format, a.offset});
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  input.vertexBindingDescriptionCount = info.vertex_stride ? 1 : 0;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = std::uint32_t(attributes.size());
  input.pVertexAttributeDescriptions = attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;

  // fixed state: viewport and scissor at record time, no culling
  VkPipelineViewportStateCreateInfo viewport{};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamics{};
  dynamics.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamics.dynamicStateCount = 2;
  dynamics.pDynamicStates = dynamic;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.cullMode = VK_CULL_MODE_NONE;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = info.has_depth;
  depth.depthCompareOp = VK_COMPARE_OP_GREATER;
  std::vector<VkPipelineColorBlendAttachmentState> blends(info.colors.size(), blend_state(Blend::replace));
  for (std::size_t i = 0; i < info.blends.size(); ++i) blends[i] = blend_state(info.blends[i]);
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = std::uint32_t(blends.size());
  blend.pAttachments = blends.data();

  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = std::uint32_t(info.colors.size());
  rendering.pColorAttachmentFormats = info.colors.data();
  rendering.depthAttachmentFormat = info.has_depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
  VkGraphicsPipelineCreateInfo create{};
  create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  create.pNext = &rendering;
  create.stageCount = 2;
  create.pStages = stages;
  create.pVertexInputState = &input;
  create.pInputAssemblyState = &assembly;
  create.pViewportState = &viewport;
  create.pRasterizationState = &raster;
  create.pMultisampleState = &samples;
  create.pDepthStencilState = &depth;
  create.pColorBlendState = &blend;
  create.pDynamicState = &dynamics;
  create.layout = self.layout_;
  CATENA_VK(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &create, nullptr, &self.pipeline_), "create a graphics pipeline");
  ++device.counters().pipelines;
  return self;
}

Result<Pipeline> Pipeline::create(Device& device, const ComputeInfo& info) {
  Pipeline self;
  self.device_ = &device;
  self.bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  CATENA_CHECK(self.create_layout(info.layout_bindings, VK_SHADER_STAGE_COMPUTE_BIT));
  ShaderModule shader(device);
  CATENA_CHECK(shader.load(info.shader));
  const Specialization constants(info.constants);
  VkComputePipelineCreateInfo create{};
  create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  create.stage = shader.stage(VK_SHADER_STAGE_COMPUTE_BIT, &constants.info);
  create.layout = self.layout_;
  CATENA_VK(vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &create, nullptr, &self.pipeline_), "create a compute pipeline");
  ++device.counters().pipelines;
  return self;
}

void Pipeline::swap(Pipeline& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(set_, other.set_);
  std::swap(layout_, other.layout_);
  std::swap(pipeline_, other.pipeline_);
  std::swap(bind_point_, other.bind_point_);
  std::swap(uses_shared_image_, other.uses_shared_image_);
}

Pipeline::~Pipeline() {
  if (!device_) return;
  device_->retire([device = device_, set = set_, layout = layout_, pipeline = pipeline_] {
    vkDestroyPipeline(device->handle(), pipeline, nullptr);
    vkDestroyPipelineLayout(device->handle(), layout, nullptr);
    vkDestroyDescriptorSetLayout(device->handle(), set, nullptr);
  });
}

}  // namespace catena::render::vk
