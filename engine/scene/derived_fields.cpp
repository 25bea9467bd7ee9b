// SPDX-License-Identifier: MIT
#include "engine/scene/derived_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/field/derived/derive.h"
#include "engine/field/derived/node_function.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"

namespace catena::scene {
namespace {

using Kind = DerivedSource::Kind;

std::vector<std::string> sources_of(const FieldSource& source) {
  if (source.label) return {source.label->label_map};
  if (!source.derived) return {};
  std::vector<std::string> names = source.derived->sources;
  if (!source.derived->on.empty()) names.push_back(source.derived->on);
  return names;
}

/// Returns the nodes at which fields are combined: those of `on`, of the first field on a grid, or of the box of the source.
field::Nodes nodes_of(const std::vector<field::AnyField>& fields, const field::AnyField* on, const FieldSource& source) {
  if (on != nullptr) return {*on};
  for (const field::AnyField& any : fields)
    if (any.get()->is_grid()) return {any};
  return {{}, source.resolution, source.box};
}

Result<field::AnyField> make(const DerivedSource& derived, const std::vector<field::AnyField>& fields, const field::Nodes& nodes,
                             double time, const std::string& name) {
  switch (derived.kind) {
    case Kind::quantity:
      return field::derive(fields[0], derived.quantity, derived.order, name);
    case Kind::component:
      return field::derive_component(fields[0], derived.component, name);
    case Kind::smooth:
      return field::smooth(fields[0], derived.sigma, name);
    case Kind::resample:
      return field::resample(fields[0], nodes, name);
    case Kind::vector:
      return field::join_components({fields[0], fields[1], fields[2]}, nodes, name);
    case Kind::expression:
      break;
  }
  std::vector<field::NodeVariable> variables;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool wants_component = derived.components[i] >= 0;
    if (fields[i].scalar && wants_component)
      return Error{in_quotes(derived.sources[i]) + " is a scalar field; its name without a component was expected"};
    if (fields[i].vector && !wants_component)
      return Error{in_quotes(derived.sources[i]) + " is a vector field; a component like " + in_quotes(derived.sources[i] + ".x") +
                   " was expected"};
    variables.push_back({derived.variables[i], fields[i], std::max(0, derived.components[i])});
  }
  return field::evaluate_expressions(derived.expressions, variables, time, nodes, name);
}

}  // namespace

Result<field::AnyField> resolve_derived(Scene& scene, Entity entity) {
  const FieldSource source = scene.entities.get<FieldSource>(entity);
  const DerivedSource& derived = *source.derived;
  const std::string name = scene.entities.get<Name>(entity).value;
  std::vector<field::AnyField> fields;
  for (const std::string& of : derived.sources) {
    CATENA_TRY(fields.emplace_back(), resolve_field(scene, of, source.where));
    if (fields.back().paged)
      scene.notes.push_back(
          fmt::format("field {}: derived from the level of {} that is loaded, not from the finest one", in_quotes(name), in_quotes(of)));
  }
  field::AnyField on;
  if (!derived.on.empty()) {
    CATENA_TRY(on, resolve_field(scene, derived.on, source.where));
    if (!on.get()->is_grid())
      return json::error_at(source.where, "\"on\" names a formula, which has no nodes; a field on a grid was expected");
  }
  const auto time = current_step_time(scene);
  auto made = make(derived, fields, nodes_of(fields, on.get() ? &on : nullptr, source), time ? time->value : scene.time.step, name);
  if (!made) return with_cause(json::error_at(source.where, "field " + in_quotes(name) + ": " + made.error().message), made.error());
  if (!made->get()->is_grid()) {  // images sample it as they sample its source
    const FieldSource& of = scene.entities.get<FieldSource>(find_field(scene, derived.sources.front()));
    const auto [resolution, box] = std::pair(of.resolution, of.box);
    scene.entities.get<FieldSource>(entity).resolution = resolution;
    scene.entities.get<FieldSource>(entity).box = box;
  }
  return made;
}

bool is_derived_from(const Scene& scene, Entity field, Entity source) {
  std::vector<Entity> open{field}, seen;
  while (!open.empty()) {
    const Entity next = open.back();
    open.pop_back();
    for (const std::string& name : sources_of(scene.entities.get<FieldSource>(next))) {
      const Entity of = find_field(scene, name);
      if (!of || std::ranges::find(seen, of) != seen.end()) continue;
      if (of == source) return true;
      seen.push_back(of);
      open.push_back(of);
    }
  }
  return false;
}

bool drop_derived(Scene& scene) {
  std::vector<Entity> dropped;
  scene.entities.each<FieldSource>([&](Entity entity, const FieldSource& source) {
    if (source.loaded.get() == nullptr || (!source.derived && !source.label)) return;
    bool is_stale = source.derived && source.derived->kind == Kind::expression;  // of the time
    scene.entities.each<FieldSource>([&](Entity other, const FieldSource& of) {
      if (of.file && of.loaded.get() == nullptr && is_derived_from(scene, entity, other)) is_stale = true;
    });
    if (is_stale) dropped.push_back(entity);
  });
  for (const Entity entity : dropped) {
    FieldSource& source = scene.entities.get<FieldSource>(entity);
    source.loaded = source.rendered = {};
    source.has_changed_step = true;
  }
  return !dropped.empty();
}

std::string source_text(const FieldSource& source) {
  if (source.file) return source.file->path + (source.file->grid.empty() ? "" : ":" + source.file->grid);
  if (source.label) return "labels of " + source.label->label_map;
  if (!source.derived) return source.analytic;
  const DerivedSource& derived = *source.derived;
  if (derived.kind == Kind::expression) return fmt::format("{}", fmt::join(derived.expressions, ", "));
  const std::string of = fmt::format("{}", fmt::join(derived.sources, ", "));
  switch (derived.kind) {
    case Kind::component:
      return fmt::format("{} of {}", "xyz"[derived.component], of);
    case Kind::smooth:
      return fmt::format("{} smoothed", of);
    case Kind::resample:
      return fmt::format("{} at the nodes of {}", of, derived.on);
    case Kind::vector:
      return fmt::format("vector of {}", of);
    default:
      return fmt::format("{} of {}", field::info_of(derived.quantity).name, of);
  }
}

std::string derived_unit(const Scene& scene, const DerivedSource& derived) {
  if (derived.kind == Kind::expression || derived.sources.empty()) return {};
  const Entity of = find_field(scene, derived.sources.front());
  const std::string unit = of ? unit_of(scene, of) : std::string();
  return derived.kind == Kind::quantity ? field::unit_of(derived.quantity, unit, length_unit(scene)) : unit;
}

}  // namespace catena::scene
