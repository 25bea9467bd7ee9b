// SPDX-License-Identifier: MIT
#include "engine/base/text.h"
#include "engine/study/study_tables.h"
#include "engine/study/trial_scene.h"

namespace catena::study {
namespace {

using schema::integer;
using schema::number;

const StudyTable<StimulusRules>& stimulus_table() {
  using T = StimulusRules;
  static const auto table =
      StudyTable<T>()
          .bind(number("path_mm", "mm", "Length of the path of every trial.").with_limits({0.0, 1e4, true}), &T::path_mm)
          .bind(number("clearance_mm", "mm", "Minimum distance of the start from every context streamline.").within(0, 1e4),
                &T::clearance_mm)
          .bind(integer("context_streamlines", "", "Number of context streamlines, which show the whole flow.", 0, 200),
                &T::context_streamlines)
          .bind(number("context_length_mm", "mm", "Maximum length of a context streamline from its seed, in each direction.")
                    .with_limits({0.0, 1e5, true}),
                &T::context_length_mm)
          .bind(number("parallel", "", "3D: minimum share of the path's length that remains after projection onto the image plane.")
                    .within(0, 1),
                &T::parallel)
          .bind(number("crossing_deg", "degrees", "Advection: minimum angle between the path and its target.").within(0, 90),
                &T::crossing_deg)
          .bind(number("turn_deg", "degrees", "Minimum angle between the path's tangent at the start and that at the middle or the end.")
                    .within(0, 180),
                &T::turn_deg)
          .bind(number("min_curvature_radius_mm", "mm", "Minimum radius of curvature of the path.").within(0, 1e4),
                &T::min_curvature_radius_mm)
          .bind(integer("candidates", "", "Number of starts that are tried in a field before the next field is generated.", 1, 10000),
                &T::candidates)
          .bind(number("region", "", "Share of each edge of the field's box, about its centre, within which the starts lie.")
                    .with_limits({0.0, 1.0, true}),
                &T::region);
  return table;
}

const StudyTable<Limits>& limits_table() {
  using T = Limits;
  static const auto table =
      StudyTable<T>()
          .bind(number("announced_limit_s", "s", "Time limit that the instructions state; it is not enforced.")
                    .with_limits({0.0, 3600, true}),
                &T::announced_limit_s)
          .bind(number("timeout_s", "s", "Time after the start of the clock at which a trial ends.").with_limits({0.0, 3600, true}),
                &T::timeout_s)
          .bind(number("reject_error_mm", "mm", "Maximum error of a trial that the analysis accepts.").with_limits({0.0, 1e6, true}),
                &T::reject_error_mm)
          .bind(number("reject_time_s", "s", "Maximum time of a trial that the analysis accepts.").with_limits({0.0, 3600, true}),
                &T::reject_time_s);
  return table;
}

/// Adds a key whose value is an object that another table reads.
template <class Outer, class Inner>
void bind_object(StudyTable<Outer>& table, const std::string& name, const StudyTable<Inner>& inner, Inner Outer::*member,
                 const std::string& help) {
  table.custom(schema::object(name, inner.keys(), help).with_default("its defaults"),
               [name, &inner, member](const NoContext& none, const json::Node& object, Outer& out) -> Outcome {
                 const json::Node* node = object.find(name);
                 if (node == nullptr) return Done{};
                 CATENA_CHECK(json::expect_object(*node, name));
                 return inner.read(none, *node, out.*member);
               });
}

/// Reads the properties of the scene that the study needs: the camera, and the scale (meters per unit).
Outcome read_scene_template(Task& task) {
  const json::Node& scene = task.scene_template;
  CATENA_CHECK(json::expect_object(scene, "scene"));
  CATENA_CHECK(check_placeholders(scene));
  if (const json::Node* chain = scene.find("chain"))
    return json::error_at(*chain, "the scene of a task has a \"chain\"; what is felt was expected in \"conditions\"");
  const json::Node* fields = scene.find("fields");
  if (fields == nullptr || fields->find(task.field) == nullptr)
    return json::error_at(json::member_or_parent(task.where, "field"),
                          "\"field\" is " + in_quotes(task.field) + "; the name of one of the \"fields\" of the task's scene was expected");
  const json::Node* workspace = scene.find("workspace");
  if (workspace == nullptr || workspace->kind != json::Kind::object)
    return json::error_at(scene, "the scene of a task has no \"workspace\"; {\"metres_per_unit\": M} was expected, for millimetres");
  CATENA_TRY(task.meters_per_unit, json::require_number(*workspace, "metres_per_unit", json::NumberRange::positive));
  const json::Node* camera = scene.find("camera");
  if (camera == nullptr || camera->kind != json::Kind::object)
    return json::error_at(scene, "the scene of a task has no \"camera\"; one was expected: it says which way is depth");
  CATENA_TRY(task.camera_position, json::require_vec3(*camera, "position"));
  CATENA_TRY(task.image_plane_point, json::require_vec3(*camera, "target"));
  task.view_direction = direction(task.image_plane_point - task.camera_position);
  if (task.view_direction == Vec3(0.0))
    return json::error_at(*camera->find("target"), "\"target\" is the camera's position; another place was expected");
  task.orthographic = camera->find("height") != nullptr;
  return Done{};
}

Outcome check_task(const NoContext&, const json::Node& node, Task& task) {
  task.where = node;
  if (node.find("target") == nullptr)
    task.target = task.kind == TaskKind::tracing ? Target::end : task.dimensions == 2 ? Target::circle : Target::plane;
  if ((task.kind == TaskKind::tracing) != (task.target == Target::end))
    return json::error_at(*node.find("target"), task.kind == TaskKind::tracing
                                                    ? "\"target\" of a tracing task is not \"end\"; the path's end was expected"
                                                    : "\"target\" of an advection task is \"end\"; \"circle\" or \"plane\" was expected");
  if (!(task.start_radius_mm < task.rules.path_mm && task.target_radius_mm < task.rules.path_mm))
    return json::error_at(node, "\"start_radius_mm\" or \"target_radius_mm\" is not below the path's length; less was expected");
  return read_scene_template(task);
}

}  // namespace

const StudyTable<Task>& task_table() {
  using T = Task;
  static const auto table = [] {
    StudyTable<T> t;
    t.bind(schema::identifier("name", "Name of the task, in the tables.").required(), &T::name);
    t.bind(schema::choice(
               "kind", {"advection", "tracing"},
               "What the subject does. `advection`: follow the flow, of which a short piece is visible at the cursor; `tracing`: follow "
               "a visible path.")
               .required(),
           &T::kind);
    t.bind(integer("dimensions", "", "Dimensions of the task; 2: everything is measured in the image plane.", 2, 3).required(),
           &T::dimensions);
    t.bind(schema::choice("target", {"circle", "plane", "end"},
                          "What ends a trial: crossing a circle about the start, crossing a horizontal plane, or reaching the path's end. "
                          "Circle and plane pass through the path's end.")
               .with_default("`end`; advection: 2D `circle`, 3D `plane`"),
           &T::target);
    t.bind(schema::text("field", "Name of the field of the scene that the path follows.").required(), &T::field);
    bind_object(t, "stimulus", stimulus_table(), &T::rules, "Rules by which the start and the path are found.");
    bind_object(t, "limits", limits_table(), &T::limits, "Time limits, and the limits beyond which the analysis rejects a trial.");
    t.bind(number("start_radius_mm", "mm", "Radius of the ball (2D: circle) about the start; the clock starts when the cursor leaves it.")
               .with_limits({0.0, 1e4, true}),
           &T::start_radius_mm);
    t.bind(number("target_radius_mm", "mm", "Tracing: distance from the path's end at which the end counts as reached.")
               .with_limits({0.0, 1e4, true}),
           &T::target_radius_mm);
    t.bind(
        number("indicator_mm", "mm", "Advection: length of the local indicator, from the cursor downstream.").with_limits({0.0, 1e4, true}),
        &T::indicator_mm);
    t.custom(schema::object("scene", {}, "Scene (scene.md) without a chain; some strings stand for values of the trial.").required(),
             [](const NoContext&, const json::Node& object, T& task) -> Outcome {
               const json::Node* scene = object.find("scene");
               if (scene == nullptr) return json::error_at(object, "key \"scene\" is missing; a scene was expected");
               task.scene_template = *scene;
               return Done{};
             });
    t.check(check_task);
    return t;
  }();
  return table;
}

}  // namespace catena::study
