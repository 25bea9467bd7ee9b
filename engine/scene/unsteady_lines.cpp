// SPDX-License-Identifier: MIT
#include "engine/scene/unsteady_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/field/derived/expression.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/time_steps.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMaxCachedPaths = 4096;

/// How a field is computed at any position and time: expressions of variables that are computed likewise, or a formula.
struct ExactRecipe {
  std::vector<std::string> texts;  // one or three; none: a formula
  std::vector<field::NodeVariable> names;
  std::vector<std::shared_ptr<const ExactRecipe>> variables;  // one per name
  field::AnyField formula;
};

/// Returns the recipe of a field; null if it depends on a grid.
std::shared_ptr<const ExactRecipe> exact_recipe(Scene& scene, Entity entity, const json::Node& where) {
  const FieldSource& source = scene.entities.get<FieldSource>(entity);
  auto recipe = std::make_shared<ExactRecipe>();
  if (source.derived && source.derived->kind == DerivedSource::Kind::expression && source.derived->on.empty()) {
    const DerivedSource derived = *source.derived;
    recipe->texts = derived.expressions;
    for (std::size_t i = 0; i < derived.variables.size(); ++i) {
      recipe->names.push_back({derived.variables[i], {}, std::max(0, derived.components[i])});
      const Entity of = find_field(scene, derived.sources[i]);
      recipe->variables.push_back(of ? exact_recipe(scene, of, where) : nullptr);
      if (recipe->variables.back() == nullptr) return nullptr;
    }
    return recipe;
  }
  const auto loaded = resolve_field(scene, entity, where);
  if (!loaded || loaded->get()->is_grid()) return nullptr;
  recipe->formula = *loaded;
  return recipe;
}

/// A recipe, for one thread.
class ExactField : public flow::UnsteadyFormula {
 public:
  explicit ExactField(std::shared_ptr<const ExactRecipe> recipe)
      : recipe_(std::move(recipe)), expressions_(recipe_->texts, recipe_->names, 0) {
    for (const auto& variable : recipe_->variables) variables_.push_back(std::make_unique<ExactField>(variable));
  }
  /// Returns the vector; of a scalar field the value is the first component.
  Vec3 velocity(const Vec3& world, double time) override {
    Vec3 v(0.0);
    if (recipe_->texts.empty()) {
      bool is_inside = false;
      if (recipe_->formula.vector) {
        const field::VectorSample sample = recipe_->formula.vector->sample(world, cursor_);
        v = sample.value;
        is_inside = sample.inside;
      } else if (recipe_->formula.scalar) {
        const field::ScalarSample sample = recipe_->formula.scalar->sample_value(world, cursor_);
        v.x = sample.value;
        is_inside = sample.inside;
      }
      return is_inside ? v : Vec3(std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t i = 0; i < variables_.size(); ++i)
      expressions_.set(i, variables_[i]->velocity(world, time)[recipe_->names[i].component]);
    expressions_.set_time(time);
    expressions_.evaluate(world, v);
    return v;
  }

 private:
  std::shared_ptr<const ExactRecipe> recipe_;
  field::Expressions expressions_;
  std::vector<std::unique_ptr<ExactField>> variables_;
  field::Cursor cursor_;
};

/// Returns a scene with the same fields, which can go through the time steps while the fields of the original stay loaded.
std::shared_ptr<Scene> copy_fields(const Scene& scene) {
  auto copy = std::make_shared<Scene>();
  copy->path = scene.path;
  copy->time = scene.time;
  scene.entities.each<FieldSource>([&](Entity entity, const FieldSource& source) {
    copy->entities.emplace<Name>(entity, scene.entities.get<Name>(entity));
    copy->entities.emplace<FieldSource>(entity, source);
  });
  return copy;
}

/// `load_error` receives the error of a step that cannot be loaded, with its place in the scene file.
Result<flow::UnsteadyField> unsteady_field(Scene& scene, Entity entity, bool is_cubic_in_time, const json::Node& where,
                                           std::optional<Error>& load_error) {
  CATENA_TRY(const field::AnyField any, resolve_field(scene, entity, where));
  const std::string name = in_quotes(scene.entities.get<Name>(entity).value);
  if (!any.vector) return json::error_at(where, name + " is a scalar field; a vector field was expected for path lines and streak lines");
  flow::UnsteadyField out;
  out.name = "field " + name;
  out.is_cubic_in_time = is_cubic_in_time;
  if (auto recipe = exact_recipe(scene, entity, where)) {
    const FieldSource& source = scene.entities.get<FieldSource>(entity);
    out.box.extend(Vec3(source.box[0]));
    out.box.extend(Vec3(source.box[1]));
    out.times = times_of_field(scene, entity);
    out.make_formula = [recipe] { return std::make_unique<ExactField>(recipe); };
    return out;
  }
  out.times = times_of_field(scene, entity);
  if (out.times.size() < 2)
    return json::error_at(where, name + " has one time step; a field with several steps was expected for path lines and streak lines");
  for (std::size_t i = 1; i < out.times.size(); ++i)
    if (!(out.times[i] > out.times[i - 1]))
      return json::error_at(where, fmt::format("the times of {} do not rise: step {} is at {} and step {} at {}", name, i - 1,
                                               to_text(out.times[i - 1]), i, to_text(out.times[i])));
  out.load = [scratch = copy_fields(scene), entity, where, name, &load_error](std::size_t step) -> Result<field::VectorFieldPtr> {
    set_step(*scratch, static_cast<int>(step));
    auto loaded = resolve_field(*scratch, entity, where);
    if (loaded && !loaded->vector) loaded = json::error_at(where, fmt::format("step {} of {} is no vector field", step, name));
    if (loaded) return loaded->vector;
    load_error = loaded.error();
    return *load_error;
  };
  return out;
}

/// Start and end of the lines. Error: they are not within the times of the field.
Result<std::array<double, 2>> times_of(const Scene& scene, const flow::UnsteadyField& field, const UnsteadyLineRequest& request,
                                       const json::Node& where) {
  std::array<double, 2> times =
      request.times.value_or(field.times.empty() ? scene.time.range : std::array{field.times.front(), field.times.back()});
  const json::Node& node = json::member_or_parent(where, "times");
  if (request.kind == LineKind::streak && !request.times && step_count(scene) > 1) {
    const auto now = current_step_time(scene);
    times[1] = now ? now->value : static_cast<double>(scene.time.step);
  }
  if (request.times && times[0] == times[1])
    return json::error_at(node, "the start and the end of \"times\" are equal; two times were expected");
  if (request.kind == LineKind::streak && times[1] < times[0])
    return json::error_at(node, "\"times\" of streak lines fall; a start before the end was expected");
  if (field.load)
    for (const double time : times)
      if (time < field.times.front() || time > field.times.back())
        return json::error_at(node, fmt::format("the time {} is outside of those of {}, {} to {}", to_text(time), field.name,
                                                to_text(field.times.front()), to_text(field.times.back())));
  return times;
}

}  // namespace

std::vector<double> times_of_field(const Scene& scene, Entity field) {
  std::vector<double> times;
  std::size_t count = 1;
  scene.entities.each<FieldSource>([&](Entity other, const FieldSource& source) {
    if (!source.file || source.has_own_step || (other != field && !is_derived_from(scene, field, other))) return;
    std::vector<double> stated;
    if (source.series.empty()) {
      const auto known = step_times(source);
      stated.assign(known.begin(), known.end());
    } else {
      for (const std::string& file : source.series)
        if (const std::vector<double> of_file = field::read_times(file); !of_file.empty()) stated.push_back(of_file.front());
    }
    const std::size_t steps = source.series.empty() ? stated.size() : source.series.size();
    if (steps <= count) return;
    count = steps;
    times = std::move(stated);
  });
  if (times.size() == count && count > 1) return times;
  const auto [begin, end] = scene.time.range;
  const bool are_of_scene = count < 2 && scene.time.steps > 1;
  if (are_of_scene) count = static_cast<std::size_t>(scene.time.steps);
  times.resize(count < 2 ? 0 : count);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto step = static_cast<double>(i);
    times[i] = are_of_scene ? begin + (end - begin) * step / static_cast<double>(count - 1) : step;
  }
  return times;
}

Result<std::vector<flow::CurvePtr>> trace_unsteady_lines(Scene& scene, Entity entity, std::span<const Vec3> positions,
                                                         const UnsteadyLineRequest& request, const json::Node& where) {
  const json::Node& field_node = json::member_or_parent(where, "field");
  std::optional<Error> load_error;
  CATENA_TRY(const flow::UnsteadyField field, unsteady_field(scene, entity, request.is_cubic_in_time, field_node, load_error));
  CATENA_TRY(const auto times, times_of(scene, field, request, where));
  std::vector<flow::CurvePtr> curves;
  if (times[0] == times[1]) return curves;
  flow::PathlineOptions options;
  options.start = times[0];
  options.end = times[1];
  options.progress = request.progress;
  options.max_all_knots = knot_limit();
  if (request.tolerance > 0) options.tolerance = request.tolerance;
  const auto cannot_trace = [&](std::size_t position, const Error& error) -> Outcome {
    if (request.skips_unusable_positions) return Done{};
    const json::Node node = request.node_of ? request.node_of(position) : where;
    return with_cause(json::error_at(node, error.message), error);
  };
  const auto add = [&](std::size_t position, const flow::CurvePtr& curve) {
    curves.push_back(curve);
    if (request.line_positions != nullptr) request.line_positions->push_back(position);
  };
  const auto failed = [&](const Error& error) {
    return load_error ? *load_error : with_cause(json::error_at(field_node, field.name + ": " + error.message), error);
  };
  if (request.kind == LineKind::streak) {
    const auto lines = flow::trace_streaklines(field, positions, options);
    if (!lines) return failed(lines.error());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!(*lines)[i]) CATENA_CHECK(cannot_trace(i, (*lines)[i].error()));
      if ((*lines)[i])
        for (const flow::CurvePtr& curve : *(*lines)[i]) add(i, curve);
    }
    return curves;
  }
  const auto key = [&](const Vec3& p) {
    return Scene::PathKey{entity.id,      times, request.tolerance, request.is_cubic_in_time, field.load ? field.times.size() : 0,
                          {p.x, p.y, p.z}};
  };
  if (scene.traced_paths.size() > kMaxCachedPaths) scene.traced_paths.clear();
  std::vector<Vec3> missing;
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!scene.traced_paths.contains(key(positions[i]))) {
      missing.push_back(positions[i]);
      at.push_back(i);
    }
  std::vector<flow::CurvePtr> all(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (const auto found = scene.traced_paths.find(key(positions[i])); found != scene.traced_paths.end()) all[i] = found->second;
  if (!missing.empty()) {
    const auto lines = flow::trace_pathlines(field, missing, options);
    if (!lines) return failed(lines.error());
    for (std::size_t n = 0; n < missing.size(); ++n) {
      if (!(*lines)[n]) {
        CATENA_CHECK(cannot_trace(at[n], (*lines)[n].error()));
        continue;
      }
      all[at[n]] = *(*lines)[n];
      scene.traced_paths.emplace(key(missing[n]), *(*lines)[n]);
    }
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (all[i]) add(i, all[i]);
  return curves;
}

Result<flow::CurvePtr> resolve_pathline(Scene& scene, const std::string& name, const Vec3& seed, UnsteadyLineRequest request,
                                        const json::Node& where) {
  const Entity field = find_field(scene, name);
  if (!field) return resolve_field(scene, name, where).error();
  request.node_of = [&](std::size_t) { return json::member_or_parent(where, "seed"); };
  CATENA_TRY(const auto curves, trace_unsteady_lines(scene, field, std::array{seed}, request, where));
  return curves.front();
}

}  // namespace catena::scene
