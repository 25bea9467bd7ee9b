#include "render/passes/mesh.h"

#include <algorithm>

#include "render/passes/grid_bindings.h"
#include "render/passes/targets.h"
#include "render/vk/upload.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/mesh.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/mesh.frag.inc"
};

struct Vertex {
  glm::vec3 position, normal, color;
};

bool same(const Color& a, const Color& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }
bool same(const MeshItem& a, const MeshItem& b) { return a.geometry == b.geometry && same(a.color, b.color); }
template <class Items>
bool same(const Items& a, const Items& b);
bool same(const TubeItem& a, const TubeItem& b) {
  return a.radius == b.radius && same(a.color, b.color) && a.points == b.points && same(a.colors, b.colors);
}
bool same(const ArrowItem& a, const ArrowItem& b) {
  return a.base == b.base && a.tip == b.tip && a.radius == b.radius && same(a.color, b.color);
}
bool same(const IndicatorItem& a, const IndicatorItem& b) { return same(a.tube, b.tube) && same(a.arrow, b.arrow); }
bool same(const CursorItem& a, const CursorItem& b) {
  return a.probe == b.probe && a.proxies == b.proxies && a.active == b.active && a.force_n == b.force_n && a.size == b.size &&
         a.leaving == b.leaving;
}
template <class Items>
bool same(const Items& a, const Items& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}

}  // namespace

Result<MeshPass> MeshPass::create(vk::Device& device) {
  MeshPass self;
  self.device_ = &device;
  vk::GraphicsInfo info;
  info.vertex = kVertexShader;
  info.fragment = kFragmentShader;
  info.slots = {{0, vk::Resource::uniform}};
  info.colors = {kOpaqueFormat, kDepthValueFormat};
  info.depth = true;
  info.vertex_stride = sizeof(Vertex);
  for (std::uint32_t i = 0; i < 3; ++i) info.attributes.push_back({i, VK_FORMAT_R32G32B32_SFLOAT, std::uint32_t(i * sizeof(glm::vec3))});
  CATENA_TRY(self.pipeline_, vk::Pipeline::create(device, info));
  return self;
}

Outcome MeshPass::prepare(const FramePacket& packet) {
  if (!built_ || !same(packet.meshes, built_meshes_)) {
    Shape shape;
    for (const MeshItem& mesh : packet.meshes) add_mesh(shape, mesh);
    CATENA_CHECK(upload(meshes_, shape));
    built_meshes_ = packet.meshes;
  }
  if (!built_ || !same(packet.tubes, built_tubes_) || !same(packet.arrows, built_arrows_)) {
    Bounds bounds;
    for (const TubeItem& tube : packet.tubes)
      for (const Vec3& p : tube.points) bounds.add(p, tube.radius);
    Shape shape;
    for (const TubeItem& tube : packet.tubes) add_tube(shape, tube, tube_sides(tube.radius, bounds.diagonal()));
    for (const ArrowItem& arrow : packet.arrows) add_cone(shape, arrow.base, arrow.tip, arrow.radius, arrow.color);
    CATENA_CHECK(upload(tubes_, shape));
    built_tubes_ = packet.tubes;
    built_arrows_ = packet.arrows;
  }
  if (!built_ || !same(packet.cursors, built_cursors_) || !same(packet.indicators, built_indicators_)) {
    Shape shape;
    for (const CursorItem& cursor : packet.cursors) add_cursor(shape, cursor);
    for (const IndicatorItem& indicator : packet.indicators) {
      add_tube(shape, indicator.tube, 12);
      add_cone(shape, indicator.arrow.base, indicator.arrow.tip, indicator.arrow.radius, indicator.arrow.color);
    }
    CATENA_CHECK(upload(cursors_, shape));
    built_cursors_ = packet.cursors;
    built_indicators_ = packet.indicators;
  }
  built_ = true;
  return Done{};
}

Outcome MeshPass::upload(Mesh& mesh, const Shape& shape) {
  mesh.index_count = 0;
  mesh.bounds = {};
  if (shape.triangles.empty()) return Done{};
  for (const MeshVertex& v : shape.vertices) mesh.bounds.add(v.position);
  mesh.origin = mesh.bounds.centre();
  std::vector<Vertex> vertices;
  vertices.reserve(shape.vertices.size());
  for (const MeshVertex& v : shape.vertices)
    vertices.push_back({glm::vec3(v.position - mesh.origin), glm::vec3(v.normal), {v.color.r, v.color.g, v.color.b}});
  CATENA_TRY(mesh.vertices, vk::upload_buffer(*device_, std::as_bytes(std::span(vertices)), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
  CATENA_TRY(mesh.indices, vk::upload_buffer(*device_, std::as_bytes(std::span(shape.triangles)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  mesh.index_count = std::uint32_t(shape.triangles.size());
  return Done{};
}

Bounds MeshPass::bounds() const {
  Bounds all = meshes_.bounds;
  all.add(tubes_.bounds);
  all.add(cursors_.bounds);
  return all;
}

Outcome MeshPass::record(vk::Commands& commands, const CameraRays& rays) {
  for (Mesh* mesh : {&meshes_, &tubes_, &cursors_}) {
    if (mesh->index_count == 0) continue;
    CATENA_CHECK(write_uniform(*device_, mesh->uniform, rays.mesh(mesh->origin)));
    const vk::Binding binding{0, vk::Resource::uniform, &mesh->uniform, nullptr, nullptr};
    commands.bind(pipeline_, {&binding, 1});
    commands.draw_indexed(mesh->vertices, mesh->indices, mesh->index_count);
  }
  return Done{};
}

}  // namespace catena::render
