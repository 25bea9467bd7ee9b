// SPDX-License-Identifier: MIT
#include "render/passes/tubes.h"

#include <algorithm>
#include <cmath>

#include "engine/base/threads.h"
#include "render/passes/pass.h"
#include "render/vk/commands.h"
#include "shaders/shared/tube.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kTubesVertexShader[] = {
#include "spirv/tube.vert.inc"
};
constexpr std::uint32_t kRibbonsVertexShader[] = {
#include "spirv/ribbon.vert.inc"
};
constexpr std::uint32_t kRibbonsFragmentShader[] = {
#include "spirv/ribbon.frag.inc"
};
constexpr std::uint32_t kTubesFragmentShader[] = {
#include "spirv/mesh.frag.inc"
};

constexpr std::size_t kMaxRings = 1 << 14;    // maximum rings of a chunk; all chunks share one index buffer
constexpr std::size_t kTubesAtOnce = 1 << 9;  // tubes whose rings are made in one parallel loop
constexpr std::uint32_t kTrianglesAtOnce = 50000;

/// Packs x in -1..1 for unpackSnorm2x16.
std::uint32_t packed_share(double x) { return static_cast<std::uint16_t>(std::lround(std::clamp(x, -1.0, 1.0) * 32767)); }

std::uint32_t packed_direction(const Vec3& unit) {
  const double sum = std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z);
  if (!(sum > 0)) return 0;
  double x = unit.x / sum, y = unit.y / sum;
  if (unit.z < 0) {
    const double fold = (1 - std::fabs(y)) * (x >= 0 ? 1 : -1);
    y = (1 - std::fabs(x)) * (y >= 0 ? 1 : -1);
    x = fold;
  }
  return packed_share(x) | packed_share(y) << 16;
}

std::uint32_t packed_color(const Color& c) {
  const auto share = [](float x) { return static_cast<std::uint32_t>(std::lround(std::clamp(x, 0.0f, 1.0f) * RING_COLOR_MAX)); };
  return share(c.r) | share(c.g) << 10 | share(c.b) << 20;
}

/// Returns the indices of the walls between consecutive rings, ordered as in add_tube: all round, or across a ribbon (sides 0).
std::vector<std::uint32_t> wall_indices(std::size_t rings, std::uint32_t sides) {
  const std::uint32_t walls = sides > 0 ? sides : RIBBON_WALLS;
  std::vector<std::uint32_t> indices;
  indices.reserve((rings - 1) * walls * 6);
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    const std::uint32_t a = r << RING_SHIFT, b = (r + 1) << RING_SHIFT;
    for (std::uint32_t k = 0; k < walls; ++k) {
      const std::uint32_t l = k + 1 == sides ? 0 : k + 1;
      indices.insert(indices.end(), {a + k, a + l, b + l, a + k, b + l, b + k});
    }
  }
  return indices;
}

/// Returns the rings of one tube. The ends of an open tube have radius 0, so that the walls to the next tube are degenerate; a closed tube
/// is enclosed in rings marked RING_GAP.
std::vector<shared::TubeRingData> packed_rings(const TubeItem& tube, const Vec3& origin) {
  bool closed = false;
  const std::vector<TubeRing> rings = tube_rings(tube, closed);
  const std::uint32_t id = tube.id | (tube.is_clipped ? 0u : UNCLIPPED);
  std::vector<shared::TubeRingData> packed;
  packed.reserve(rings.size() + 2);
  const auto add = [&](const TubeRing& ring, double radius, std::uint32_t what) {
    packed.push_back({glm::vec3(ring.center - origin), static_cast<float>(radius), static_cast<float>(ring.normal_tilt),
                      packed_direction(ring.tangent), packed_direction(ring.normal), packed_color(ring.color) | what, id});
  };
  if (closed) add(rings.front(), 0, RING_GAP);
  for (const TubeRing& ring : rings) add(ring, ring.radius, 0);
  if (closed) add(rings.front(), 0, RING_GAP);
  return packed;
}

}  // namespace

/// Collects the rings of all tubes and uploads them in chunks.
class Tubes::Filler {
 public:
  Filler(Tubes& tubes, vk::Device& device) : tubes_(tubes), device_(device) {}

  Outcome add(std::span<const TubeItem> tubes) {
    std::vector<std::vector<shared::TubeRingData>> made(tubes.size());
    parallel_for(tubes.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) made[i] = packed_rings(tubes[i], tubes_.origin_);
    });
    for (std::size_t i = 0; i < tubes.size(); ++i) {
      for (const shared::TubeRingData& ring : made[i]) CATENA_CHECK(add(ring, tubes[i].radius));
      made[i] = {};
    }
    return Done{};
  }
  Outcome flush() {
    if (rings_.size() >= 2) {
      Chunk piece{{}, static_cast<std::uint32_t>(rings_.size()), std::move(runs_)};
      CATENA_TRY(piece.rings, vk::upload_buffer(device_, std::as_bytes(std::span(rings_)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
      tubes_.longest_chunk_ = std::max(tubes_.longest_chunk_, piece.count);
      tubes_.chunks_.push_back(std::move(piece));
    }
    rings_.clear();
    runs_.clear();
    return Done{};
  }

 private:
  Outcome add(const shared::TubeRingData& ring, double radius) {
    put(ring, radius);
    if (rings_.size() < kMaxRings) return Done{};
    CATENA_CHECK(flush());
    // the next chunk continues from the last ring
    put(ring, radius);
    return Done{};
  }
  void put(const shared::TubeRingData& ring, double radius) {
    const auto extend_run = [&](Run& run) {
      run.bounds.extend(tubes_.origin_ + Vec3(ring.center), radius);
      run.radius = std::max(run.radius, radius);
    };
    if (!runs_.empty()) extend_run(runs_.back());
    if (rings_.size() % kRunLength == 0) extend_run(runs_.emplace_back());
    rings_.push_back(ring);
  }

  Tubes& tubes_;
  vk::Device& device_;
  std::vector<shared::TubeRingData> rings_;
  std::vector<Run> runs_;
};

Outcome Tubes::upload(vk::Device& device, std::span<const TubeItem> tubes) {
  chunks_.clear();
  indices_.clear();
  longest_chunk_ = 0;
  bounds_ = {};
  for (const TubeItem& tube : tubes)
    for (const Vec3& p : tube.points) bounds_.extend(p, tube.radius);
  if (bounds_.empty()) return Done{};
  origin_ = bounds_.center();
  Filler filler(*this, device);
  for (std::size_t i = 0; i < tubes.size(); i += kTubesAtOnce)
    CATENA_CHECK(filler.add(tubes.subspan(i, std::min(kTubesAtOnce, tubes.size() - i))));
  return filler.flush();
}

Result<const vk::Buffer*> Tubes::indices(vk::Device& device, std::uint32_t sides) {
  vk::Buffer& buffer = indices_[sides];
  if (!buffer.handle()) {
    const std::vector<std::uint32_t> walls = wall_indices(longest_chunk_, sides);
    CATENA_TRY(buffer, vk::upload_buffer(device, std::as_bytes(std::span(walls)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  }
  return &buffer;
}

Result<const vk::Pipeline*> TubeDrawer::pipeline(std::uint32_t sides) {
  std::optional<vk::Pipeline>& made = sides > 0 ? tubes_ : ribbons_;
  if (made) return &*made;
  vk::GraphicsInfo info;
  info.layout_bindings = {
      {0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::buffer}, {vk::kSharedBinding, vk::DescriptorKind::sampled}};
  info.colors = opaque_formats();
  info.has_depth = true;
  info.vertex = sides > 0 ? std::span<const std::uint32_t>(kTubesVertexShader) : kRibbonsVertexShader;
  info.fragment = sides > 0 ? std::span<const std::uint32_t>(kTubesFragmentShader) : kRibbonsFragmentShader;
  CATENA_TRY(made, vk::Pipeline::create(*device_, info));
  return &*made;
}

Outcome TubeDrawer::draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes, const std::function<void()>& pause) {
  if (tubes.empty()) return Done{};
  CATENA_CHECK(vk::write_uniform(*device_, tubes.uniform_, rays.mesh_frame_data(tubes.origin_)));
  std::uint32_t since_pause = 0;  // triangles since the last pause
  for (const Tubes::Chunk& piece : tubes.chunks_) {
    const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &tubes.uniform_, nullptr, nullptr},
                                    {1, vk::DescriptorKind::buffer, &piece.rings, nullptr, nullptr}};
    const auto sides_of = [&](const Tubes::Run& run) -> std::optional<std::uint32_t> {
      if (!may_be_visible(rays.camera, run.bounds.center(), 0.5 * run.bounds.diagonal())) return std::nullopt;
      return static_cast<std::uint32_t>(tube_sides(run.radius, min_pixel_size(rays.camera, run.bounds)));
    };
    for (std::size_t first = 0, end = 0; first < piece.runs.size(); first = end) {
      const std::optional<std::uint32_t> sides = sides_of(piece.runs[first]);
      for (end = first + 1; end < piece.runs.size() && sides_of(piece.runs[end]) == sides;) ++end;
      if (!sides) continue;
      CATENA_TRY(const vk::Pipeline* pipeline, this->pipeline(*sides));
      CATENA_TRY(const vk::Buffer* indices, tubes.indices(*device_, *sides));
      commands.bind(*pipeline, bindings);
      commands.bind_indices(*indices, VK_INDEX_TYPE_UINT32);
      const std::uint32_t a_wall = 2 * (*sides > 0 ? *sides : RIBBON_WALLS), max_walls = kTrianglesAtOnce / a_wall;
      const std::uint32_t last = std::min<std::uint32_t>(static_cast<std::uint32_t>(end) * Tubes::kRunLength, piece.count - 1);
      for (std::uint32_t wall = static_cast<std::uint32_t>(first) * Tubes::kRunLength; wall < last; wall += max_walls) {
        const std::uint32_t count = std::min(last - wall, max_walls);
        if (since_pause + count * a_wall > kTrianglesAtOnce) {
          pause();
          since_pause = 0;
        }
        commands.draw_mesh(wall * a_wall * 3, count * a_wall * 3, 0, *sides);
        since_pause += count * a_wall;
      }
    }
  }
  return Done{};
}

}  // namespace catena::render
