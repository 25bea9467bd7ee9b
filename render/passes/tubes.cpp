#include "render/passes/tubes.h"

#include <algorithm>
#include <cmath>

#include "render/passes/pass.h"
#include "render/vk/commands.h"
#include "shaders/shared/tube.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kTubesVertexShader[] = {
#include "spirv/tube.vert.inc"
};
constexpr std::uint32_t kTubesFragmentShader[] = {
#include "spirv/mesh.frag.inc"
};

constexpr std::size_t kMaxRings = 1 << 16;  // of a piece: all pieces share their indices

/// A share of -1..1 as unpackSnorm2x16 reads it.
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

std::uint32_t packed_color(const Color& c, std::uint32_t sides) {
  const auto share = [](float x) { return static_cast<std::uint32_t>(std::lround(std::clamp(x, 0.0f, 1.0f) * RING_COLOR_MOST)); };
  return share(c.r) | share(c.g) << 10 | share(c.b) << 20 | sides << RING_SIDES_SHIFT;
}

/// The walls between neighbours of `rings` rings, as add_tube makes them.
std::vector<std::uint32_t> wall_indices(std::size_t rings, std::uint32_t sides) {
  std::vector<std::uint32_t> indices;
  indices.reserve((rings - 1) * sides * 6);
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    const std::uint32_t a = r << RING_SHIFT, b = (r + 1) << RING_SHIFT;
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t l = (k + 1) % sides;
      indices.insert(indices.end(), {a + k, a + l, b + l, a + k, b + l, b + k});
    }
  }
  return indices;
}

}  // namespace

/// Collects the rings of all tubes of as many sides, and puts them on the device piece by piece.
class Tubes::Filler {
 public:
  Filler(Tubes& tubes, vk::Device& device, std::size_t kind) : tubes_(tubes), device_(device), kind_(kind) {}

  Outcome add(const TubeItem& tube) {
    bool closed = false;
    const std::vector<TubeRing> rings = tube_rings(tube, kSides[kind_], closed);
    if (rings.empty()) return Done{};
    const std::uint32_t id = tube.id | (tube.clipped ? 0u : UNCLIPPED);
    // an open tube's tips are points, and so is all that leads from one tube to the next; about a closed one there are gaps
    if (closed) CATENA_CHECK(add(rings.front(), id, RING_GAP));
    for (const TubeRing& ring : rings) CATENA_CHECK(add(ring, id, static_cast<std::uint32_t>(kind_)));
    if (closed) CATENA_CHECK(add(rings.front(), id, RING_GAP));
    return Done{};
  }
  Outcome flush() {
    if (rings_.size() < 2) return Done{};
    Piece piece{{}, static_cast<std::uint32_t>(rings_.size()), kind_};
    CATENA_TRY(piece.rings, vk::upload_buffer(device_, std::as_bytes(std::span(rings_)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    longest_ = std::max(longest_, rings_.size());
    tubes_.pieces_.push_back(std::move(piece));
    rings_.clear();
    return Done{};
  }
  Outcome finish() {
    CATENA_CHECK(flush());
    if (longest_ == 0) return Done{};
    const std::vector<std::uint32_t> indices = wall_indices(longest_, static_cast<std::uint32_t>(kSides[kind_]));
    CATENA_TRY(tubes_.indices_[kind_], vk::upload_buffer(device_, std::as_bytes(std::span(indices)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    return Done{};
  }

 private:
  Outcome add(const TubeRing& ring, std::uint32_t id, std::uint32_t sides) {
    const bool gap = sides == RING_GAP;
    rings_.push_back({glm::vec3(ring.centre - tubes_.origin_), gap ? 0.0f : static_cast<float>(ring.radius), static_cast<float>(ring.lean),
                      packed_direction(ring.tangent), packed_direction(ring.normal), packed_color(ring.color, sides), id});
    if (rings_.size() < kMaxRings) return Done{};
    // the next piece goes on from the last ring
    const shared::TubeRingData last = rings_.back();
    CATENA_CHECK(flush());
    rings_.push_back(last);
    return Done{};
  }

  Tubes& tubes_;
  vk::Device& device_;
  std::size_t kind_, longest_ = 0;
  std::vector<shared::TubeRingData> rings_;
};

Outcome Tubes::upload(vk::Device& device, std::span<const TubeItem> tubes) {
  pieces_.clear();
  bounds_ = {};
  for (const TubeItem& tube : tubes)
    for (const Vec3& p : tube.points) bounds_.add(p, tube.radius);
  if (bounds_.empty()) return Done{};
  origin_ = bounds_.centre();
  for (std::size_t kind = 0; kind < std::size(kSides); ++kind) {
    Filler filler(*this, device, kind);
    for (const TubeItem& tube : tubes)
      if (tube_sides(tube.radius, bounds_.diagonal()) == kSides[kind]) CATENA_CHECK(filler.add(tube));
    CATENA_CHECK(filler.finish());
  }
  return Done{};
}

Result<TubeDrawer> TubeDrawer::create(vk::Device& device) {
  TubeDrawer self;
  self.device_ = &device;
  vk::GraphicsInfo info;
  info.vertex = kTubesVertexShader;
  info.fragment = kTubesFragmentShader;
  info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::buffer}};
  info.colors = opaque_formats();
  info.depth = true;
  CATENA_TRY(self.pipeline_, vk::Pipeline::create(device, info));
  return self;
}

Outcome TubeDrawer::draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes) {
  if (tubes.empty()) return Done{};
  CATENA_CHECK(vk::write_uniform(*device_, tubes.uniform_, rays.mesh(tubes.origin_)));
  for (const Tubes::Piece& piece : tubes.pieces_) {
    const vk::Binding bindings[] = {{0, vk::Resource::uniform, &tubes.uniform_, nullptr, nullptr},
                                    {1, vk::Resource::buffer, &piece.rings, nullptr, nullptr}};
    commands.bind(pipeline_, bindings);
    commands.bind_indices(tubes.indices_[piece.kind], VK_INDEX_TYPE_UINT32);
    commands.draw_mesh(0, (piece.count - 1) * static_cast<std::uint32_t>(Tubes::kSides[piece.kind]) * 6, 0);
  }
  return Done{};
}

}  // namespace catena::render
