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

constexpr std::size_t kMaxRings = 1 << 16;    // of a piece: all pieces share their indices
constexpr std::size_t kTubesAtOnce = 1 << 9;  // whose rings are made together, on all cores
constexpr std::uint32_t kTrianglesAtOnce = 50000;

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

/// The walls between neighbours of `rings` rings, as add_tube makes them: all round, or across a ribbon.
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

void pack(std::vector<shared::TubeRingData>& to, const TubeRing& ring, const Vec3& origin, std::uint32_t what, std::uint32_t id) {
  to.push_back({glm::vec3(ring.centre - origin), what == RING_GAP ? 0.0f : static_cast<float>(ring.radius), static_cast<float>(ring.lean),
                packed_direction(ring.tangent), packed_direction(ring.normal), packed_color(ring.color, what), id});
}

void pack(std::vector<shared::RibbonRingData>& to, const TubeRing& ring, const Vec3& origin, std::uint32_t what, std::uint32_t id) {
  to.push_back({glm::vec3(ring.centre - origin), what == RING_GAP ? 0.0f : static_cast<float>(ring.radius), packed_direction(ring.tangent),
                packed_color(ring.color, what), id});
}

/// The rings of one tube; `round`: their sides as the shader has them. An open tube's tips are points, and so is all that leads from one
/// tube to the next; about a closed one there are gaps.
template <class Ring>
std::vector<Ring> packed_rings(const TubeItem& tube, int sides, std::uint32_t round, const Vec3& origin) {
  bool closed = false;
  const std::vector<TubeRing> rings = tube_rings(tube, sides, closed);
  const std::uint32_t id = tube.id | (tube.clipped ? 0u : UNCLIPPED);
  std::vector<Ring> packed;
  packed.reserve(rings.size() + 2);
  if (closed) pack(packed, rings.front(), origin, RING_GAP, id);
  for (const TubeRing& ring : rings) pack(packed, ring, origin, round, id);
  if (closed) pack(packed, rings.front(), origin, RING_GAP, id);
  return packed;
}

}  // namespace

/// Collects the rings of all tubes of one kind, and puts them on the device piece by piece.
template <class Ring>
class Tubes::Filler {
 public:
  Filler(Tubes& tubes, vk::Device& device, std::size_t kind) : tubes_(tubes), device_(device), kind_(kind) {}

  Outcome add(std::span<const TubeItem* const> tubes) {
    const std::uint32_t round = kSides[kind_] > 0 ? static_cast<std::uint32_t>(kind_) : 0;
    std::vector<std::vector<Ring>> made(tubes.size());
    parallel_for(tubes.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) made[i] = packed_rings<Ring>(*tubes[i], kSides[kind_], round, tubes_.origin_);
    });
    for (std::vector<Ring>& rings : made) {
      for (const Ring& ring : rings) CATENA_CHECK(add(ring));
      rings = {};
    }
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
  Outcome add(const Ring& ring) {
    rings_.push_back(ring);
    if (rings_.size() < kMaxRings) return Done{};
    CATENA_CHECK(flush());
    // the next piece goes on from the last ring
    rings_.push_back(ring);
    return Done{};
  }
  Outcome flush() {
    if (rings_.size() >= 2) {
      Piece piece{{}, static_cast<std::uint32_t>(rings_.size()), kind_};
      CATENA_TRY(piece.rings, vk::upload_buffer(device_, std::as_bytes(std::span(rings_)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
      longest_ = std::max(longest_, rings_.size());
      tubes_.pieces_.push_back(std::move(piece));
    }
    rings_.clear();
    return Done{};
  }

  Tubes& tubes_;
  vk::Device& device_;
  std::size_t kind_, longest_ = 0;
  std::vector<Ring> rings_;
};

template <class Ring>
Outcome Tubes::fill(vk::Device& device, std::span<const TubeItem> tubes, std::size_t kind) {
  std::vector<const TubeItem*> of_kind;
  for (const TubeItem& tube : tubes)
    if (tube.radius > 0 && sides_.at(tube.radius) == kSides[kind]) of_kind.push_back(&tube);
  Filler<Ring> filler(*this, device, kind);
  for (std::size_t i = 0; i < of_kind.size(); i += kTubesAtOnce)
    CATENA_CHECK(filler.add(std::span(of_kind).subspan(i, std::min(kTubesAtOnce, of_kind.size() - i))));
  return filler.finish();
}

Outcome Tubes::upload(vk::Device& device, std::span<const TubeItem> tubes, const Camera& camera) {
  pieces_.clear();
  bounds_ = {};
  sides_.clear();
  for (const TubeItem& tube : tubes)
    for (const Vec3& p : tube.points) bounds_.add(p, tube.radius);
  if (bounds_.empty()) return Done{};
  origin_ = bounds_.centre();
  const double pixel = smallest_pixel(camera, bounds_);
  for (const TubeItem& tube : tubes)
    if (tube.radius > 0) sides_.emplace(tube.radius, tube_sides(tube.radius, pixel));
  for (std::size_t kind = 0; kind < std::size(kSides); ++kind)
    CATENA_CHECK(kSides[kind] > 0 ? fill<shared::TubeRingData>(device, tubes, kind) : fill<shared::RibbonRingData>(device, tubes, kind));
  return Done{};
}

bool Tubes::suits(const Camera& camera) const {
  if (bounds_.empty()) return true;
  // the two eyes of a view may lie on either side of a border
  const double pixel = smallest_pixel(camera, bounds_);
  return std::ranges::all_of(sides_, [&](const auto& made) {
    const auto& [radius, sides] = made;
    return sides <= tube_sides(radius, 0.95 * pixel) && sides >= tube_sides(radius, 1.05 * pixel);
  });
}

Outcome TubeDrawer::prepare(const Tubes& tubes) {
  vk::GraphicsInfo info;
  info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::buffer}};
  info.colors = opaque_formats();
  info.depth = true;
  for (const Tubes::Piece& piece : tubes.pieces_) {
    const bool ribbon = Tubes::kSides[piece.kind] == 0;
    std::optional<vk::Pipeline>& pipeline = ribbon ? ribbons_ : tubes_;
    if (pipeline) continue;
    info.vertex = ribbon ? std::span<const std::uint32_t>(kRibbonsVertexShader) : kTubesVertexShader;
    info.fragment = ribbon ? std::span<const std::uint32_t>(kRibbonsFragmentShader) : kTubesFragmentShader;
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return Done{};
}

Outcome TubeDrawer::draw(vk::Commands& commands, const CameraRays& rays, Tubes& tubes, const std::function<void()>& pause) {
  if (tubes.empty()) return Done{};
  CATENA_CHECK(vk::write_uniform(*device_, tubes.uniform_, rays.mesh(tubes.origin_)));
  std::uint32_t since_pause = 0;  // triangles
  for (const Tubes::Piece& piece : tubes.pieces_) {
    const vk::Binding bindings[] = {{0, vk::Resource::uniform, &tubes.uniform_, nullptr, nullptr},
                                    {1, vk::Resource::buffer, &piece.rings, nullptr, nullptr}};
    const int sides = Tubes::kSides[piece.kind];
    const std::uint32_t a_ring = 2 * static_cast<std::uint32_t>(sides > 0 ? sides : RIBBON_WALLS), walls = piece.count - 1;
    for (std::uint32_t first = 0; first < walls; first += kTrianglesAtOnce / a_ring) {
      const std::uint32_t count = std::min(walls - first, kTrianglesAtOnce / a_ring);
      if (since_pause + count * a_ring > kTrianglesAtOnce) {
        pause();
        since_pause = 0;
      }
      commands.bind(sides > 0 ? *tubes_ : *ribbons_, bindings);
      commands.bind_indices(tubes.indices_[piece.kind], VK_INDEX_TYPE_UINT32);
      commands.draw_mesh(first * a_ring * 3, count * a_ring * 3, 0);
      since_pause += count * a_ring;
    }
  }
  return Done{};
}

}  // namespace catena::render
