// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <map>

#include "render/passes/passes.h"
#include "render/passes/slice.h"
#include "render/passes/triangles.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kLayersScreenShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kLayersMeshShader[] = {
#include "spirv/layer_mesh.frag.inc"
};
constexpr std::uint32_t kLayerTailShader[] = {
#include "spirv/layer_tail.frag.inc"
};

/// Bytes per pixel: color and depth of each layer, two ids, the depth buffer, the rest image, and 4 in reserve.
constexpr std::uint64_t kLayerBytes = 12 * MAX_LAYERS + 32;

using Clear = std::array<float, 4>;

struct TranslucentMesh {
  MeshItem item;
  Triangles triangles;
  vk::Buffer layer_data;
};

class LayersPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(SliceDrawer drawer, SliceDrawer::create(device));
    return std::unique_ptr<Pass>(new LayersPass(std::move(drawer)));
  }
  PassUse use(const Frame& frame) const override { return {frame.has(target::opaque_depth) ? target::opaque_depth : 0, 0, true}; }
  Outcome prepare(Frame& frame) override;
  bool has_new_data() const override { return slabs_.has_arrived(); }
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;

 private:
  struct Images {
    vk::Image color, depth;
  };
  explicit LayersPass(SliceDrawer drawer) : slice_drawer_(std::move(drawer)) {}
  Outcome prepare_meshes(Frame& frame);
  Outcome prepare_images(Frame& frame);
  Result<const vk::Pipeline*> mesh_pipeline(vk::Device& device, std::uint32_t mode, bool has_opaque);
  Outcome draw_mesh(vk::Commands& commands, Frame& frame, TranslucentMesh& mesh, const PeelState& peel);
  Outcome draw_all(vk::Commands& commands, Frame& frame, const PeelState& peel);
  Outcome draw_rest(vk::Commands& commands, Frame& frame, const PeelState& peel, Images& last, vk::Image& id);
  bool collects_rest() const { return !meshes_.empty() || slices_.size() > MAX_LAYERS; }

  SliceDrawer slice_drawer_;
  std::vector<TranslucentMesh> meshes_;
  SlabCache slabs_;
  std::vector<Slice> slices_;
  std::vector<SliceItem> slice_items_;
  std::uint64_t version_ = 0;  ///< number of changes found by prepare()
  std::map<std::array<std::uint32_t, 2>, vk::Pipeline> mesh_pipelines_;
  vk::Pipeline rest_pipeline_;
  std::uint32_t count_ = 0;
  std::array<Images, MAX_LAYERS> layers_;
  std::array<vk::Image, 2> ids_;  // of the current layer and the previous one
  vk::Image depth_buffer_, rest_;
};

Outcome LayersPass::prepare_meshes(Frame& frame) {
  std::size_t count = 0;
  for (const MeshItem& item : frame.packet.meshes) {
    if (!is_translucent(item)) continue;
    if (count == meshes_.size()) meshes_.emplace_back();
    TranslucentMesh& mesh = meshes_[count++];
    if (mesh.item == item) continue;
    ShapeMesh shape;
    add_mesh(shape, item);
    CATENA_CHECK(mesh.triangles.upload(frame.device, shape));
    mesh.item = item;
    ++version_;
  }
  version_ += meshes_.size() > count;
  while (meshes_.size() > count) meshes_.pop_back();
  return Done{};
}

Outcome LayersPass::prepare_images(Frame& frame) {
  const auto fit = [&](vk::Image& image, VkFormat format, VkImageUsageFlags usage) -> Outcome {
    return vk::ensure_image(frame.device, image, format, frame.packet.width, frame.packet.height, usage);
  };
  constexpr VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  for (std::uint32_t i = 0; i < MAX_LAYERS; ++i) {
    if (i >= count_) {
      layers_[i] = {};
      continue;
    }
    CATENA_CHECK(fit(layers_[i].color, kOpaqueFormat, color));
    CATENA_CHECK(fit(layers_[i].depth, kDepthValueFormat, color));
  }
  for (vk::Image& id : ids_) CATENA_CHECK(fit(id, kIdFormat, color));
  CATENA_CHECK(fit(depth_buffer_, kDepthBufferFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
  if (!collects_rest()) rest_ = {};
  return collects_rest() ? fit(rest_, kTailFormat, color) : Done{};
}

Outcome LayersPass::prepare(Frame& frame) {
  CATENA_CHECK(prepare_meshes(frame));
  CATENA_CHECK(prepare_slices(frame, slabs_, slices_, render::is_translucent));
  std::vector<SliceItem> items;
  std::ranges::copy_if(frame.packet.slices, std::back_inserter(items), [](const SliceItem& item) { return is_translucent(item); });
  version_ += items != slice_items_;
  slice_items_ = std::move(items);
  std::stable_sort(meshes_.begin(), meshes_.end(), [](const auto& a, const auto& b) { return a.item.id < b.item.id; });
  std::stable_sort(slices_.begin(), slices_.end(), [](const auto& a, const auto& b) { return a.id() < b.id(); });
  count_ = collects_rest() ? MAX_LAYERS : std::uint32_t(slices_.size());
  CATENA_CHECK(prepare_images(frame));
  for (std::uint32_t i = 0; i < count_; ++i) frame.layers.push_back({&layers_[i].color, &layers_[i].depth});
  frame.layers_version = version_;
  return Done{};
}

Bounds LayersPass::bounds() const {
  Bounds all;
  for (const TranslucentMesh& mesh : meshes_) all.extend(mesh.triangles.bounds());
  for (const Slice& slice : slices_) all.extend(slice.grid().world_bounds());
  return all;
}

Result<const vk::Pipeline*> LayersPass::mesh_pipeline(vk::Device& device, std::uint32_t mode, bool has_opaque) {
  vk::Pipeline& pipeline = mesh_pipelines_[{mode, has_opaque}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    set_triangle_stage(info);
    info.fragment = kLayersMeshShader;
    info.constants = {0};
    set_peel_stage(info, mode, has_opaque);
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

Outcome LayersPass::draw_mesh(vk::Commands& commands, Frame& frame, TranslucentMesh& mesh, const PeelState& peel) {
  if (mesh.triangles.empty()) return Done{};
  CATENA_CHECK(vk::write_uniform(frame.device, mesh.layer_data, layer_data(frame.rays, mesh.item.opacity)));
  CATENA_TRY(const vk::Pipeline* pipe, mesh_pipeline(frame.device, peel.mode, peel.opaque_depth != nullptr));
  CATENA_TRY(const vk::Binding binding, mesh.triangles.frame_binding(frame.device, frame.rays));
  std::vector<vk::Binding> bindings{binding};
  add_peel_bindings(bindings, peel, mesh.layer_data);
  commands.set_scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
  commands.bind(*pipe, bindings);
  mesh.triangles.draw(commands);
  return Done{};
}

/// Draws in ascending order of ids: of items at equal depth, the depth buffer keeps the first and the next layer peels the next.
Outcome LayersPass::draw_all(vk::Commands& commands, Frame& frame, const PeelState& peel) {
  std::size_t m = 0, s = 0;
  while (m < meshes_.size() || s < slices_.size()) {
    const bool mesh = s == slices_.size() || (m < meshes_.size() && meshes_[m].item.id <= slices_[s].id());
    CATENA_CHECK(mesh ? draw_mesh(commands, frame, meshes_[m++], peel) : slice_drawer_.draw(commands, frame.rays, slices_[s++], peel));
  }
  return Done{};
}

/// Blends everything behind the other layers into the last layer.
Outcome LayersPass::draw_rest(vk::Commands& commands, Frame& frame, const PeelState& peel, Images& last, vk::Image& id) {
  const vk::ColorTarget targets[] = {{&rest_, Clear{0, 0, 0, 1}}, {&last.depth, Clear{NO_DEPTH, 0, 0, 0}}, {&id, Clear{0, 0, 0, 0}}};
  commands.begin_pass(targets, {});
  CATENA_CHECK(draw_all(commands, frame, peel));
  commands.end_pass();
  if (!rest_pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kLayersScreenShader;
    info.fragment = kLayerTailShader;
    info.layout_bindings = {{0, vk::DescriptorKind::texture}};
    info.colors = {kOpaqueFormat};
    CATENA_TRY(rest_pipeline_, vk::Pipeline::create(frame.device, info));
  }
  commands.transition(rest_, vk::kFragmentRead);
  const vk::ColorTarget color{&last.color, Clear{0, 0, 0, 0}};
  commands.begin_pass({&color, 1}, {});
  const vk::Binding binding{0, vk::DescriptorKind::texture, nullptr, &rest_, nullptr};
  commands.bind(rest_pipeline_, {&binding, 1});
  commands.draw_triangle();
  commands.end_pass();
  return Done{};
}

Outcome LayersPass::record(vk::Commands& commands, Frame& frame) {
  PeelState peel;
  peel.placeholder = &frame.targets.placeholder;
  peel.placeholder_id = &slice_drawer_.placeholder_id();
  peel.opaque_depth = frame.has(target::opaque_depth) ? &frame.targets.opaque_depth : nullptr;
  for (std::uint32_t k = 0; k < count_; ++k) {
    vk::Image &id = ids_[k % 2], &passed_id = ids_[(k + 1) % 2];
    if (k > 0) {
      peel.previous_depth = &layers_[k - 1].depth;
      peel.previous_id = &passed_id;
      commands.transition(layers_[k - 1].depth, vk::kFragmentRead);
      commands.transition(passed_id, vk::kFragmentRead);
    }
    if (k + 1 == MAX_LAYERS && collects_rest()) {
      peel.mode = MODE_TAIL;
      CATENA_CHECK(draw_rest(commands, frame, peel, layers_[k], id));
      break;
    }
    peel.mode = k == 0 ? MODE_FIRST : MODE_LAYER;
    const vk::ColorTarget targets[] = {
        {&layers_[k].color, Clear{0, 0, 0, 0}}, {&layers_[k].depth, Clear{NO_DEPTH, 0, 0, 0}}, {&id, Clear{0, 0, 0, 0}}};
    commands.begin_pass(targets, {&depth_buffer_, 0.0f});
    CATENA_CHECK(draw_all(commands, frame, peel));
    commands.end_pass();
  }
  for (std::uint32_t k = 0; k < count_; ++k)
    for (vk::Image* image : {&layers_[k].color, &layers_[k].depth}) commands.transition(*image, vk::kFragmentRead);
  return Done{};
}

}  // namespace

bool is_translucent(const MeshItem& item) { return item.opacity > 0 && item.opacity < 1; }

bool needs_layers(const FramePacket& packet) {
  const auto any = [](const auto& items) {
    return std::any_of(items.begin(), items.end(), [](const auto& item) { return is_translucent(item); });
  };
  return any(packet.meshes) || any(packet.slices);
}

const PassEntry kLayersPass{"layers", [](const Frame& frame) { return needs_layers(frame.packet); }, LayersPass::create, target::opaque,
                            kLayerBytes};

}  // namespace catena::render
