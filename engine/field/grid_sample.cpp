// Any field sampled on a cube of nodes. Nodes that the field does not cover are marked invalid.
#include <cmath>
#include <type_traits>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "engine/field/dense.h"
#include "engine/field/grid_storage.h"

namespace catena::field {
namespace {

struct Nodes {
  Index3 size;
  Mapping mapping;
};

Nodes nodes(int resolution, double lo, double hi) {
  CATENA_ASSERT(resolution >= 2 && lo < hi);
  return {{resolution, resolution, resolution}, Mapping::from_linear(Mat3((hi - lo) / (resolution - 1)), Vec3(lo))};
}

void store(const ScalarSample& s, float* out) { out[0] = static_cast<float>(s.value); }
void store(const VectorSample& s, float* out) {
  for (int a = 0; a < 3; ++a) out[a] = static_cast<float>(s.value[a]);
}

/// The field at the nodes, in parallel by rows of x.
template <class Field>
DenseSource samples_of(const Field& field, const Nodes& n) {
  constexpr std::size_t components = std::is_same_v<Field, VectorField> ? 3 : 1;
  return {n.size, true, [&field, n](int z, int layers, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
            const std::size_t rows = static_cast<std::size_t>(layers) * n.size.y;
            parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
              Cursor cursor;
              for (std::size_t row = begin; row < end; ++row)
                for (int x = 0; x < n.size.x; ++x) {
                  const double y = static_cast<double>(row % n.size.y), layer = z + static_cast<double>(row / n.size.y);
                  const auto sample = field.sample(n.mapping.world_from_index(Vec3(x, y, layer)), cursor);
                  const std::size_t at = row * n.size.x + x;
                  store(sample, &values[components * at]);
                  valid[at] = sample.inside;
                }
            });
            return Done{};
          }};
}

template <class Grid, class Field>
Result<std::shared_ptr<const Grid>> sampled(const Field& field, const Nodes& n, const std::string& prefix = {}) {
  return make_dense<Grid>(field.name(), n.mapping, samples_of(field, n), prefix, /*drop_full_mask=*/true);
}

}  // namespace

std::shared_ptr<const ScalarGrid> sample_on_grid(const ScalarField& field, int resolution, double lo, double hi) {
  return sampled<ScalarGrid>(field, nodes(resolution, lo, hi)).value();
}

std::shared_ptr<const VectorGrid> sample_on_grid(const VectorField& field, int resolution, double lo, double hi) {
  return sampled<VectorGrid>(field, nodes(resolution, lo, hi)).value();
}

Result<AnyField> try_sample_on_grid(const AnyField& field, int resolution, double lo, double hi) {
  const std::string what =
      "field \"" + field.get()->name() + "\", " + std::to_string(resolution) + " nodes an axis from " + to_text(lo) + " to " + to_text(hi);
  const double spacing = (hi - lo) / (resolution - 1);
  if (!std::isfinite(spacing) || !(lo + spacing > lo))
    return Error{what + ": the spacing is not a usable number; a smaller or larger box was expected"};
  const Nodes n = nodes(resolution, lo, hi);
  CATENA_CHECK(ask_for_dense(what + ": the grid", n.size, field.scalar ? 1 : 3, true));
  AnyField made;
  GridStats stats;
  if (field.scalar) {
    CATENA_TRY(made.scalar, sampled<ScalarGrid>(*field.scalar, n, what + ": the grid "));
    stats = made.scalar->grid()->stats();
  } else {
    CATENA_TRY(made.vector, sampled<VectorGrid>(*field.vector, n, what + ": the grid "));
    stats = made.vector->grid()->stats();
  }
  if (stats.nan_count > 0)
    return Error{what + ": " + std::to_string(stats.nan_count) + " samples do not fit into 32-bit floats; smaller values were expected"};
  return made;
}

namespace {

using ScalarWalk = Walk<float, double>;
constexpr auto scalar_corner = [](float v) -> double { return v; };
constexpr auto finite_scalar_corner = [](double v) { return std::isfinite(v); };

ScalarWalk& walk_to(const ScalarGrid& grid, const ScalarGrid::Storage& storage, const Index3& base, Cursor& cursor) {
  ScalarWalk& walk = walk_of<ScalarWalk>(cursor, &grid, grid.version(), storage);
  if (!walk.filled || !(walk.base == base)) [[unlikely]]
    fetch(walk, storage, base, scalar_corner, finite_scalar_corner);
  return walk;
}

}  // namespace

ScalarGrid::ScalarGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage,
                       const GridStats& stats, Interpolation interpolation)
    : storage_(std::move(storage)), stats_(stats), interpolation_(interpolation) {
  CATENA_ASSERT(storage_ && storage_->values);
  set_domain(std::move(name), mapping, index_box);
}

ScalarGrid::~ScalarGrid() = default;

std::shared_ptr<const ScalarGrid> ScalarGrid::interpolated(Interpolation interpolation) const {
  return std::make_shared<ScalarGrid>(name(), mapping(), index_box(), storage_, stats_, interpolation);
}

ScalarSample ScalarGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  ScalarSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const ScalarWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  const Vec3 place = place_in_cell(index, walk.base);
  if (interpolation_ == Interpolation::linear) [[likely]] {
    Vec3 g;
    trilinear(walk.corner, place, s.value, g);
    s.gradient = mapping().world_gradient(g);
  } else {
    s.value = walk.corner[(place.x >= 0.5 ? 1u : 0u) + (place.y >= 0.5 ? 2u : 0u) + (place.z >= 0.5 ? 4u : 0u)];
  }
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

Reason ScalarGrid::why_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return Reason::not_finite;
  return reason_outside(walk_to(*this, *storage_, storage_->base_of(index), cursor), index_box(), index, finite_scalar_corner);
}

ScalarCell ScalarGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const ScalarWalk& walk = walk_to(*this, *storage_, storage_->clamp(base), cursor);
  ScalarCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 ScalarGrid::base_of(const Vec3& index) const noexcept { return storage_->base_of(index); }
std::size_t ScalarGrid::bytes() const noexcept { return storage_->bytes(); }
float ScalarGrid::background() const { return storage_->values->tree().background(); }
bool ScalarGrid::has_mask() const { return storage_->may_be_invalid; }

void ScalarGrid::read_block(const Index3& origin, const Index3& size, std::span<float> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const float* values = leaf ? leaf->data()->mValues : nullptr;
    const float constant = leaf ? 0.f : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = out.data() + (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x)
          row[x - origin.x] = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
      }
  });
}

void ScalarGrid::read_cell_valid(const Index3& origin, const Index3& size, std::span<std::uint8_t> out) const {
  CATENA_ASSERT(out.size() >= static_cast<std::size_t>(size.x) * size.y * size.z);
  Cursor cursor;
  std::size_t n = 0;
  for (std::int32_t z = origin.z; z < origin.z + size.z; ++z)
    for (std::int32_t y = origin.y; y < origin.y + size.y; ++y)
      for (std::int32_t x = origin.x; x < origin.x + size.x; ++x, ++n) {
        const Index3 base{x, y, z};
        out[n] = storage_->legal(base) && (!storage_->may_be_invalid || walk_to(*this, *storage_, base, cursor).valid);
      }
}

bool ScalarGrid::constant_block(const Index3& origin, float& value) const {
  const auto accessor = storage_->values->getAccessor();
  if (accessor.probeLeaf(coord(origin))) return false;
  value = accessor.getValue(coord(origin));
  return true;
}

namespace {

using VectorWalk = Walk<nanovdb::Vec3f, Vec3>;
constexpr auto vector_corner = [](const nanovdb::Vec3f& v) { return Vec3(v[0], v[1], v[2]); };
constexpr auto finite_vector_corner = [](const Vec3& v) { return is_finite(v); };

VectorWalk& walk_to(const VectorGrid& grid, const VectorGrid::Storage& storage, const Index3& base, Cursor& cursor) {
  VectorWalk& walk = walk_of<VectorWalk>(cursor, &grid, grid.version(), storage);
  if (!walk.filled || !(walk.base == base)) [[unlikely]]
    fetch(walk, storage, base, vector_corner, finite_vector_corner);
  return walk;
}

}  // namespace

VectorGrid::VectorGrid(std::string name, const Mapping& mapping, const Box& index_box, std::unique_ptr<Storage> storage,
                       const GridStats& stats)
    : storage_(std::move(storage)), stats_(stats) {
  CATENA_ASSERT(storage_ && storage_->values);
  set_domain(std::move(name), mapping, index_box);
}

VectorGrid::~VectorGrid() = default;

VectorSample VectorGrid::sample(const Vec3& world, Cursor& cursor) const noexcept {
  VectorSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  s.value = trilinear(walk.corner, place_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

LineSample VectorGrid::sample_line(const Vec3& world, Cursor& cursor) const noexcept {
  LineSample s;
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return s;
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->base_of(index), cursor);
  static_cast<LineAxis&>(s) = line_axis(walk.corner, place_in_cell(index, walk.base));
  s.inside = walk.valid && index_box().contains(index, domain_slack);
  return s;
}

Reason VectorGrid::why_outside(const Vec3& world, Cursor& cursor) const noexcept {
  const Vec3 index = mapping().index_from_world(world);
  if (!is_finite(index)) return Reason::not_finite;
  return reason_outside(walk_to(*this, *storage_, storage_->base_of(index), cursor), index_box(), index, finite_vector_corner);
}

VectorCell VectorGrid::cell(const Index3& base, Cursor& cursor) const noexcept {
  const VectorWalk& walk = walk_to(*this, *storage_, storage_->clamp(base), cursor);
  VectorCell c;
  c.base = walk.base;
  c.valid = walk.valid;
  c.corner = walk.corner;
  return c;
}

Index3 VectorGrid::base_of(const Vec3& index) const noexcept { return storage_->base_of(index); }
std::size_t VectorGrid::bytes() const noexcept { return storage_->bytes(); }
bool VectorGrid::has_mask() const { return storage_->may_be_invalid; }

void VectorGrid::read_block(const Index3& origin, const Index3& size, std::span<float> xyz_out) const {
  CATENA_ASSERT(xyz_out.size() >= 3 * static_cast<std::size_t>(size.x) * size.y * size.z);
  for_blocks(*storage_->values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const nanovdb::Vec3f* values = leaf ? leaf->data()->mValues : nullptr;
    const nanovdb::Vec3f constant = leaf ? nanovdb::Vec3f(0.f) : accessor.getValue(block);
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        float* row = xyz_out.data() + 3 * (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const nanovdb::Vec3f& v = values ? values[(x & 7) * 64 + (y & 7) * 8 + (z & 7)] : constant;
          for (int c = 0; c < 3; ++c) row[3 * (x - origin.x) + c] = v[c];
        }
      }
  });
}

}  // namespace catena::field
