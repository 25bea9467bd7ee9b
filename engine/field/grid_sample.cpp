// Any field sampled on a cube of nodes. Nodes that the field does not cover are marked invalid.
#include <algorithm>
#include <cmath>

#include "engine/base/assert.h"
#include "engine/base/numbers.h"
#include "engine/base/parallel_for.h"
#include "engine/field/grid_make.h"

namespace catena::field {
namespace {

struct Nodes {
  Index3 size;
  Mapping mapping;
  std::size_t layer, count;
};

Nodes nodes(int resolution, double lo, double hi) {
  CATENA_ASSERT(resolution >= 2 && lo < hi);
  const double spacing = (hi - lo) / (resolution - 1);
  Nodes n;
  n.size = {resolution, resolution, resolution};
  n.mapping = Mapping::from_linear(Mat3(spacing), Vec3(lo));
  n.layer = static_cast<std::size_t>(resolution) * resolution;
  n.count = n.layer * resolution;
  return n;
}

/// visit(node number, world position, cursor) for all nodes, in parallel by layers of z.
template <class Visit>
void for_nodes(const Nodes& n, const Visit& visit) {
  parallel_for(static_cast<std::size_t>(n.size.z), 1, [&](std::size_t begin, std::size_t end) {
    Cursor cursor;
    for (std::size_t z = begin; z < end; ++z)
      for (int y = 0; y < n.size.y; ++y)
        for (int x = 0; x < n.size.x; ++x)
          visit(z * n.layer + static_cast<std::size_t>(y) * n.size.x + x, n.mapping.world_from_index(Vec3(x, y, static_cast<double>(z))),
                cursor);
  });
}

/// An empty mask where every node is valid.
std::span<const std::uint8_t> mask(const std::vector<std::uint8_t>& valid) {
  const bool all = std::find(valid.begin(), valid.end(), 0) == valid.end();
  return all ? std::span<const std::uint8_t>{} : std::span<const std::uint8_t>(valid);
}

Result<std::shared_ptr<const ScalarGrid>> sample_scalar(const ScalarField& field, const Nodes& n) {
  std::vector<float> values(n.count);
  std::vector<std::uint8_t> valid(n.count);
  for_nodes(n, [&](std::size_t at, const Vec3& world, Cursor& cursor) {
    const ScalarSample s = field.sample(world, cursor);
    values[at] = static_cast<float>(s.value);
    valid[at] = s.inside;
  });
  return try_make_scalar_grid(field.name(), n.mapping, n.size, values, mask(valid));
}

Result<std::shared_ptr<const VectorGrid>> sample_vector(const VectorField& field, const Nodes& n) {
  std::vector<float> values(3 * n.count);
  std::vector<std::uint8_t> valid(n.count);
  for_nodes(n, [&](std::size_t at, const Vec3& world, Cursor& cursor) {
    const VectorSample s = field.sample(world, cursor);
    for (int a = 0; a < 3; ++a) values[3 * at + a] = static_cast<float>(s.value[a]);
    valid[at] = s.inside;
  });
  return try_make_vector_grid(field.name(), n.mapping, n.size, values, mask(valid));
}

}  // namespace

std::shared_ptr<const ScalarGrid> sample_on_grid(const ScalarField& field, int resolution, double lo, double hi) {
  return sample_scalar(field, nodes(resolution, lo, hi)).value();
}

std::shared_ptr<const VectorGrid> sample_on_grid(const VectorField& field, int resolution, double lo, double hi) {
  return sample_vector(field, nodes(resolution, lo, hi)).value();
}

Result<AnyField> try_sample_on_grid(const AnyField& field, int resolution, double lo, double hi) {
  const std::string what =
      "field \"" + field.get()->name() + "\", " + std::to_string(resolution) + " nodes an axis from " + to_text(lo) + " to " + to_text(hi);
  const double spacing = (hi - lo) / (resolution - 1);
  if (!std::isfinite(spacing) || !(lo + spacing > lo))
    return Error{what + ": the spacing is not a usable number; a smaller or larger box was expected"};
  AnyField sampled;
  GridStats stats;
  if (field.scalar) {
    auto grid = sample_scalar(*field.scalar, nodes(resolution, lo, hi));
    if (!grid) return Error{what + ": the grid " + grid.error().message};
    sampled.scalar = *grid;
    stats = (*grid)->stats();
  } else {
    auto grid = sample_vector(*field.vector, nodes(resolution, lo, hi));
    if (!grid) return Error{what + ": the grid " + grid.error().message};
    sampled.vector = *grid;
    stats = (*grid)->stats();
  }
  if (stats.nan_count > 0)
    return Error{what + ": " + std::to_string(stats.nan_count) + " samples do not fit into 32-bit floats; smaller values were expected"};
  return sampled;
}

}  // namespace catena::field
