// SPDX-License-Identifier: MIT
// Samples any field on a cube of nodes. Nodes at which the field has no value are marked invalid.
#include <cmath>
#include <type_traits>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "engine/field/grid/dense.h"

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

ScalarSample sampled_at(const ScalarField& field, const Vec3& world, Cursor& cursor) { return field.sample_value(world, cursor); }
VectorSample sampled_at(const VectorField& field, const Vec3& world, Cursor& cursor) { return field.sample(world, cursor); }

/// Evaluates the field at the nodes, in parallel over rows along x.
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
                  const auto sample = sampled_at(field, n.mapping.world_from_index(Vec3(x, y, layer)), cursor);
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
  return make_dense_grid<Grid>(field.name(), n.mapping, samples_of(field, n), prefix, /*drop_full_mask=*/true);
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
      "field \"" + field.get()->name() + "\", " + std::to_string(resolution) + " nodes per axis from " + to_text(lo) + " to " + to_text(hi);
  const double spacing = (hi - lo) / (resolution - 1);
  if (!std::isfinite(spacing) || !(lo + spacing > lo))
    return Error{what + ": the spacing is not a usable number; a smaller or larger box was expected"};
  const Nodes n = nodes(resolution, lo, hi);
  CATENA_CHECK(check_dense_memory(what + ": the grid", n.size, field.scalar ? 1 : 3, true));
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

}  // namespace catena::field
