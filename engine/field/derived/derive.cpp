// SPDX-License-Identifier: MIT
#include "engine/field/derived/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/field/derived/derived_formula.h"
#include "engine/field/derived/magnitude.h"
#include "engine/field/derived/node_slab.h"
#include "engine/field/grid/dense.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

template <class Grid>
using JetOf = std::conditional_t<std::is_same_v<Grid, ScalarGrid>, ScalarJet, VectorJet>;

/// Returns value and derivatives at a node.
ScalarJet jet_at(const NodeSlab<ScalarGrid>& slab, const Mapping& mapping, int derivatives, int x, int y, int z) {
  ScalarJet jet;
  jet.value = slab.value(0, x, y, z);
  if (derivatives >= 1) jet.gradient = mapping.world_from_index_gradient(slab.first(0, x, y, z));
  const Mat3& to_index = mapping.index_from_world_linear;
  if (derivatives >= 2) jet.hessian = transpose(to_index) * slab.second(0, x, y, z) * to_index;
  return jet;
}

VectorJet jet_at(const NodeSlab<VectorGrid>& slab, const Mapping& mapping, int derivatives, int x, int y, int z) {
  VectorJet jet;
  const Mat3& to_index = mapping.index_from_world_linear;
  for (int c = 0; c < 3; ++c) {
    jet.value[c] = slab.value(c, x, y, z);
    if (derivatives == 1) {
      const Vec3 gradient = mapping.world_from_index_gradient(slab.first(c, x, y, z));
      for (int j = 0; j < 3; ++j) jet.jacobian[j][c] = gradient[j];
    }
    if (derivatives == 2) {
      const Mat3 hessian = transpose(to_index) * slab.second(c, x, y, z) * to_index;
      jet.laplacian[c] = hessian[0][0] + hessian[1][1] + hessian[2][2];
    }
  }
  return jet;
}

/// Writes a quantity with first derivatives along a row of nodes, without a mask: each step over the whole row.
template <class Grid, class Write>
void first_derivatives_of_row(const NodeSlab<Grid>& slab, const Mapping& mapping, Quantity quantity, int y, int z,
                              std::vector<double>& buffer, const Write& write) {
  constexpr std::size_t C = NodeSlab<Grid>::C;
  const auto nx = std::size_t(slab.size().x);
  buffer.resize(3 * C * nx);
  for (std::size_t c = 0; c < C; ++c)
    for (std::size_t a = 0; a < 3; ++a) slab.first_of_row(int(c), int(a), y, z, buffer.data() + (3 * c + a) * nx);
  const double* rows = buffer.data();
  JetOf<Grid> jet;
  for (std::size_t x = 0; x < nx; ++x) {
    for (std::size_t c = 0; c < C; ++c) {
      const Vec3 gradient =
          mapping.world_from_index_gradient({rows[3 * c * nx + x], rows[(3 * c + 1) * nx + x], rows[(3 * c + 2) * nx + x]});
      if constexpr (C == 1) {
        jet.gradient = gradient;
      } else {
        for (int j = 0; j < 3; ++j) jet.jacobian[j][int(c)] = gradient[j];
      }
    }
    if constexpr (C == 3)
      if (quantity == Quantity::helicity)
        for (int c = 0; c < 3; ++c) jet.value[c] = slab.value(c, int(x), y, z);
    write(x, evaluate(quantity, jet));
  }
}

/// Makes the grid of `Out` whose nodes node_row(slab, y, z, write) writes, row by row; write(x, value), NaN: none.
template <class Out, class Grid, class NodeRow>
Result<AnyField> make_derived_grid(const Grid& grid, int derivatives, int order, const std::string& name, const NodeRow& node_row,
                                   const std::string& what = "it", const std::optional<DisplayRange>& range = {}) {
  constexpr std::size_t C = std::is_same_v<Out, ScalarGrid> ? 1 : 3;
  NodeSlab<Grid> slab(grid, derivatives, order);
  const Index3 size = slab.size();
  CATENA_CHECK(check_dense_memory(what, size, int(C), grid.has_mask()));
  const std::size_t plane = std::size_t(size.x) * std::size_t(size.y);
  DenseSource source{size, grid.has_mask(), [&](int z, int layers, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
                       slab.read(z, layers);
                       parallel_for(std::size_t(layers) * std::size_t(size.y), 8, [&](std::size_t begin, std::size_t end) {
                         for (std::size_t row = begin; row < end; ++row) {
                           const int y = int(row) % size.y, layer = int(row) / size.y;
                           float* out = values.data() + C * row * std::size_t(size.x);
                           node_row(slab, y, z + layer, [&](std::size_t x, const Vec3& value) {
                             for (std::size_t c = 0; c < C; ++c) out[C * x + c] = float(value[int(c)]);
                           });
                           if (!valid.empty())
                             for (int x = 0; x < size.x; ++x)
                               valid[row * std::size_t(size.x) + std::size_t(x)] = slab.is_valid(x, y, z + layer) ? 1 : 0;
                         }
                       });
                       return Done{};
                     }};
  if (slab.has_cell_mask())
    source.read_cells = [&](int z, int layers, std::span<std::uint8_t> cells) -> Outcome {
      for (std::size_t i = 0; i < plane * std::size_t(layers); ++i)
        cells[i] = slab.may_be_cell(int(i % std::size_t(size.x)), int(i / std::size_t(size.x)) % size.y, z + int(i / plane)) ? 1 : 0;
      return Done{};
    };
  source.range = range;
  Mapping mapping = grid.mapping();
  mapping.origin = mapping.world_from_index(grid.index_box().lo);
  CATENA_TRY(std::shared_ptr<const Out> made, make_dense_grid<Out>(name, mapping, source, what + " "));
  if (grid.interpolation() == Interpolation::cubic) {
    CATENA_TRY(made, made->as_cubic());
  }
  AnyField any;
  if constexpr (C == 1)
    any.scalar = std::move(made);
  else
    any.vector = std::move(made);
  return any;
}

template <class Out, class Grid>
Result<AnyField> derive_nodes(const Grid& grid, const QuantityInfo& info, int order, const std::string& name) {
  const Mapping mapping = grid.mapping();
  return make_derived_grid<Out>(grid, info.derivatives, order, name, [&](const NodeSlab<Grid>& slab, int y, int z, const auto& write) {
    thread_local std::vector<double> buffer;
    if (info.derivatives == 1 && !slab.has_mask()) return first_derivatives_of_row(slab, mapping, info.quantity, y, z, buffer, write);
    for (int x = 0; x < slab.size().x; ++x) {
      const bool is_valid = slab.is_valid(x, y, z);
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      write(std::size_t(x), is_valid ? evaluate(info.quantity, jet_at(slab, mapping, info.derivatives, x, y, z)) : Vec3(kNone));
    }
  });
}

/// Returns whether a quantity of the field is a vector.
bool is_vector(const QuantityInfo& info, const AnyField& field) {
  return info.is_vector && !(info.quantity == Quantity::laplacian && field.scalar);
}

const ScalarGrid* scalar_grid(const AnyField& field) { return field.scalar ? field.scalar->grid() : nullptr; }
const VectorGrid* vector_grid(const AnyField& field) { return field.vector ? field.vector->grid() : nullptr; }

}  // namespace

Result<std::shared_ptr<const ScalarGrid>> make_magnitude_grid(const VectorGrid& grid, const std::string& what) {
  const auto row = [&](const NodeSlab<VectorGrid>& slab, int y, int z, const auto& write) {
    for (int x = 0; x < slab.size().x; ++x)
      write(std::size_t(x), Vec3(norm(Vec3(slab.value(0, x, y, z), slab.value(1, x, y, z), slab.value(2, x, y, z)))));
  };
  auto made = make_derived_grid<ScalarGrid>(grid, 0, 2, grid.name(), row, what, grid.storage().data_range);
  if (!made) return Error{made.error().message + "; magnitudes that fit into 32-bit floats were expected"};
  return std::static_pointer_cast<const ScalarGrid>(made->scalar);
}

Result<AnyField> derive(const AnyField& field, Quantity quantity, int order, const std::string& name) {
  const QuantityInfo& info = info_of(quantity);
  if (field.scalar ? !info.of_scalar : !info.of_vector)
    return Error{fmt::format("a {} field has no {}; a {} field was expected", field.scalar ? "scalar" : "vector", in_quotes(info.name),
                             field.scalar ? "vector" : "scalar")};
  const bool vector = is_vector(info, field);
  if (const ScalarGrid* grid = scalar_grid(field))
    return vector ? derive_nodes<VectorGrid>(*grid, info, order, name) : derive_nodes<ScalarGrid>(*grid, info, order, name);
  if (const VectorGrid* grid = vector_grid(field))
    return vector ? derive_nodes<VectorGrid>(*grid, info, order, name) : derive_nodes<ScalarGrid>(*grid, info, order, name);
  return derive_formula(field, quantity, vector, name);
}

Result<AnyField> derive_component(const AnyField& field, int component, const std::string& name) {
  if (!field.vector) return Error{"a scalar field has no components; a vector field was expected"};
  const VectorGrid* grid = vector_grid(field);
  if (grid == nullptr) return component_of_formula(field.vector, component, name);
  return make_derived_grid<ScalarGrid>(*grid, 0, 2, name, [&](const NodeSlab<VectorGrid>& slab, int y, int z, const auto& write) {
    for (int x = 0; x < slab.size().x; ++x) write(std::size_t(x), Vec3(slab.value(component, x, y, z)));
  });
}

}  // namespace catena::field
