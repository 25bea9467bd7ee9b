// SPDX-License-Identifier: MIT
#include "engine/field/derived/node_function.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/field/derived/expression.h"
#include "engine/field/derived/node_slab.h"
#include "engine/field/grid/dense.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/measure/voxels.h"

namespace catena::field {
namespace {

/// Nodes of a grid or a cube, by their index from 0.
struct Lattice {
  Index3 size;
  Mapping mapping;
};

Lattice lattice_of(const Nodes& nodes) {
  if (const Field* grid = nodes.on.get()) {
    const Vec3 extent = grid->index_box().hi - grid->index_box().lo;
    Mapping mapping = grid->mapping();
    mapping.origin = mapping.world_from_index(grid->index_box().lo);
    return {{int(extent.x) + 1, int(extent.y) + 1, int(extent.z) + 1}, mapping};
  }
  const double spacing = (nodes.box[1] - nodes.box[0]) / (nodes.resolution - 1);
  return {{nodes.resolution, nodes.resolution, nodes.resolution}, Mapping::from_linear(Mat3(spacing), Vec3(nodes.box[0]))};
}

/// Values of one field at the nodes of some layers.
class NodeInput {
 public:
  NodeInput(const AnyField& field, const Lattice& lattice, const Field* on) : field_(field), lattice_(lattice) {
    if (on == nullptr || !field.get()->is_grid() || !is_same_lattice(*field.get(), *on)) return;
    if (field.scalar && field.scalar->grid()) scalars_.emplace(*field.scalar->grid(), 0);
    if (field.vector && field.vector->grid()) vectors_.emplace(*field.vector->grid(), 0);
  }
  void read(int z, int layers) {
    if (scalars_) scalars_->read(z, layers);
    if (vectors_) vectors_->read(z, layers);
  }
  /// Sets the value at a node, a scalar as its first component. Returns false where the field has none.
  bool get(int x, int y, int z, Cursor& cursor, Vec3& value) const {
    if (scalars_) {
      value.x = scalars_->value(0, x, y, z);
      return scalars_->is_valid(x, y, z);
    }
    if (vectors_) {
      for (int c = 0; c < 3; ++c) value[c] = vectors_->value(c, x, y, z);
      return vectors_->is_valid(x, y, z);
    }
    const Vec3 world = lattice_.mapping.world_from_index(Vec3(x, y, z));
    if (field_.scalar) {
      const ScalarSample sample = field_.scalar->sample_value(world, cursor);
      value.x = sample.value;
      return sample.inside;
    }
    const VectorSample sample = field_.vector->sample(world, cursor);
    value = sample.value;
    return sample.inside;
  }

 private:
  const AnyField& field_;
  const Lattice& lattice_;
  std::optional<NodeSlab<ScalarGrid>> scalars_;
  std::optional<NodeSlab<VectorGrid>> vectors_;
};

/// Makes a grid of `Out`. make_worker() returns, for a range of rows, work(world, values, result), which computes the value at a node from
/// those of the fields.
template <class Out, class MakeWorker>
Result<AnyField> make_at_nodes(const std::vector<const AnyField*>& fields, const Nodes& nodes, const std::string& name,
                               const MakeWorker& make_worker) {
  constexpr std::size_t C = std::is_same_v<Out, ScalarGrid> ? 1 : 3;
  const Lattice lattice = lattice_of(nodes);
  const Index3 size = lattice.size;
  CATENA_CHECK(check_dense_memory("it", size, int(C), true));
  std::vector<std::unique_ptr<NodeInput>> inputs;
  for (const AnyField* field : fields) inputs.push_back(std::make_unique<NodeInput>(*field, lattice, nodes.on.get()));
  std::atomic<std::uint64_t> holes = 0;
  const DenseSource source{size, true, [&](int z, int layers, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
                             for (const auto& input : inputs) input->read(z, layers);
                             parallel_for(std::size_t(layers) * std::size_t(size.y), 64, [&](std::size_t begin, std::size_t end) {
                               auto work = make_worker();
                               std::vector<Cursor> cursors(inputs.size());
                               std::vector<Vec3> at_node(inputs.size());
                               std::uint64_t not_finite = 0;
                               for (std::size_t row = begin; row < end; ++row)
                                 for (int x = 0; x < size.x; ++x) {
                                   const int y = int(row) % size.y, layer = z + int(row) / size.y;
                                   bool has_value = true;
                                   for (std::size_t i = 0; i < inputs.size() && has_value; ++i)
                                     has_value = inputs[i]->get(x, y, layer, cursors[i], at_node[i]);
                                   Vec3 result(0.0);
                                   if (has_value) work(lattice.mapping.world_from_index(Vec3(x, y, layer)), at_node, result);
                                   const std::size_t at = row * std::size_t(size.x) + std::size_t(x);
                                   bool is_finite = true;
                                   for (std::size_t c = 0; c < C; ++c) {
                                     values[C * at + c] = float(result[int(c)]);
                                     is_finite = is_finite && std::isfinite(values[C * at + c]);
                                   }
                                   if (!is_finite) {
                                     ++not_finite;
                                     for (std::size_t c = 0; c < C; ++c) values[C * at + c] = 0;
                                   }
                                   valid[at] = has_value && is_finite ? 1 : 0;
                                 }
                               holes += not_finite;
                             });
                             return Done{};
                           }};
  AnyField any;
  auto made = make_dense_grid<Out>(name, lattice.mapping, source, "it ", true);
  if (!made && holes > 0) return Error{fmt::format("{}; it is not finite at {} nodes", made.error().message, holes.load())};
  if (!made) return made.error();
  if constexpr (C == 1)
    any.scalar = *made;
  else
    any.vector = *made;
  if (holes > 0)
    any.notes.push_back(fmt::format("{} of {} nodes have no finite value; they are left out", holes.load(),
                                    std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z)));
  return any;
}

}  // namespace

Result<AnyField> evaluate_expressions(const std::vector<std::string>& expressions, const std::vector<NodeVariable>& variables, double time,
                                      const Nodes& nodes, const std::string& name) {
  std::vector<const AnyField*> fields;
  for (const NodeVariable& variable : variables) fields.push_back(&variable.field);
  const auto make_worker = [&] {
    auto evaluators = std::make_unique<Expressions>(expressions, variables, time);
    return [evaluators = std::move(evaluators), &variables](const Vec3& world, const std::vector<Vec3>& values, Vec3& result) {
      for (std::size_t i = 0; i < values.size(); ++i)
        evaluators->set(i, variables[i].field.scalar ? values[i].x : values[i][variables[i].component]);
      evaluators->evaluate(world, result);
    };
  };
  if (expressions.size() == 1) return make_at_nodes<ScalarGrid>(fields, nodes, name, make_worker);
  return make_at_nodes<VectorGrid>(fields, nodes, name, make_worker);
}

Result<AnyField> resample(const AnyField& field, const Nodes& nodes, const std::string& name) {
  const auto make_worker = [] { return [](const Vec3&, const std::vector<Vec3>& values, Vec3& result) { result = values[0]; }; };
  if (field.scalar) return make_at_nodes<ScalarGrid>({&field}, nodes, name, make_worker);
  return make_at_nodes<VectorGrid>({&field}, nodes, name, make_worker);
}

Result<AnyField> join_components(const std::array<AnyField, 3>& components, const Nodes& nodes, const std::string& name) {
  for (const AnyField& component : components)
    if (!component.scalar) return Error{"a component is a vector field; three scalar fields were expected"};
  const auto make_worker = [] {
    return [](const Vec3&, const std::vector<Vec3>& values, Vec3& result) { result = {values[0].x, values[1].x, values[2].x}; };
  };
  return make_at_nodes<VectorGrid>({&components[0], &components[1], &components[2]}, nodes, name, make_worker);
}

}  // namespace catena::field
