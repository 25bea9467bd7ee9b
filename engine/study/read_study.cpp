#include <filesystem>
#include <set>

#include "engine/base/text.h"
#include "engine/schema/table.h"
#include "engine/study/study.h"
#include "engine/study/trial_scene.h"

namespace catena::study {

const char* kind_word(TaskKind kind) { return kind == TaskKind::advection ? "advection" : "tracing"; }

namespace {

using schema::integer;
using schema::number;

/// What reading needs besides.
struct None {};
template <class T>
using StudyTable = schema::Table<T, const None>;

constexpr None kNone{};

const StudyTable<StimulusRules>& stimulus_table() {
  using T = StimulusRules;
  static const auto table =
      StudyTable<T>()
          .bind(number("path_mm", "mm", "Length of every correct path.").positive(), &T::path_mm)
          .bind(number("clearance_mm", "mm", "The start is at least so far from every global streamline.").not_negative(), &T::clearance_mm)
          .bind(integer("lines", "", "Global streamlines.", 0, 200), &T::lines)
          .bind(number("line_mm", "mm", "The longest that one is, each way.").positive(), &T::line_mm)
          .bind(number("parallel", "", "3D: at least this share of the path's length is seen in the picture plane.").within(0, 1),
                &T::parallel)
          .bind(number("crossing_deg", "degrees", "Advection: the path meets its target at this angle or a steeper one.").within(0, 90),
                &T::crossing_deg)
          .bind(number("turn_deg", "degrees", "The path turns at least this much from its start to its middle or its end.").within(0, 180),
                &T::turn_deg)
          .bind(number("bend_mm", "mm", "The path's radius of curvature is nowhere smaller.").not_negative(), &T::bend_mm)
          .bind(integer("candidates", "", "Starts that are tried in a field, before another field is.", 1, 10000), &T::candidates)
          .bind(number("region", "", "Share of the field's box, about its middle, in which starts lie.").limited({0.0, 1.0, true}),
                &T::region);
  return table;
}

const StudyTable<Limits>& limits_table() {
  using T = Limits;
  static const auto table =
      StudyTable<T>()
          .bind(number("told_s", "s", "What the subject is told; it is not enforced.").positive(), &T::told_s)
          .bind(number("ends_s", "s", "Here a trial ends.").positive(), &T::ends_s)
          .bind(number("reject_error_mm", "mm", "A trial with a larger error is left out of the analysis.").positive(), &T::reject_error_mm)
          .bind(number("reject_time_s", "s", "So is one that took longer.").positive(), &T::reject_time_s);
  return table;
}

/// A key whose object another table reads.
template <class Outer, class Inner>
void bind_object(StudyTable<Outer>& table, const std::string& name, const StudyTable<Inner>& inner, Inner Outer::*member,
                 const std::string& help) {
  table.hand(schema::object(name, inner.keys(), help).by_default("its defaults"),
             [name, &inner, member](const None& none, const json::Node& object, Outer& out) -> Outcome {
               const json::Node* node = object.find(name);
               if (node == nullptr) return Done{};
               CATENA_CHECK(json::expect_object(*node, name));
               return inner.read(none, *node, out.*member);
             });
}

/// What the study must know of the scene: where the eye is, and how large the hand's millimetre.
Outcome read_scene_template(Task& task) {
  const json::Node& scene = task.scene;
  CATENA_CHECK(json::expect_object(scene, "scene"));
  CATENA_CHECK(check_values(scene));
  if (const json::Node* chain = scene.find("chain"))
    return json::error_at(*chain, "the scene of a task has a \"chain\"; what is felt was expected in \"conditions\"");
  const json::Node* fields = scene.find("fields");
  if (fields == nullptr || fields->find(task.field) == nullptr)
    return json::error_at(json::member_or(task.where, "field"),
                          "\"field\" is " + in_quotes(task.field) + "; the name of one of the \"fields\" of the task's scene was expected");
  const json::Node* workspace = scene.find("workspace");
  if (workspace == nullptr || workspace->kind != json::Kind::object)
    return json::error_at(scene, "the scene of a task has no \"workspace\"; {\"metres_per_unit\": M} was expected, for millimetres");
  CATENA_TRY(task.metres_per_unit, json::require_number(*workspace, "metres_per_unit", json::Range::positive));
  const json::Node* camera = scene.find("camera");
  if (camera == nullptr || camera->kind != json::Kind::object)
    return json::error_at(scene, "the scene of a task has no \"camera\"; one was expected: it says which way is depth");
  CATENA_TRY(task.eye, json::require_vec3(*camera, "position"));
  CATENA_TRY(task.plane, json::require_vec3(*camera, "target"));
  task.view = direction(task.plane - task.eye);
  if (task.view == Vec3(0.0))
    return json::error_at(*camera->find("target"), "\"target\" is the camera's position; another place was expected");
  task.orthographic = camera->find("height") != nullptr;
  return Done{};
}

Outcome check_task(const None&, const json::Node& node, Task& task) {
  task.where = node;
  if (node.find("target") == nullptr)
    task.target = task.kind == TaskKind::tracing ? Target::end : task.dimensions == 2 ? Target::circle : Target::plane;
  if ((task.kind == TaskKind::tracing) != (task.target == Target::end))
    return json::error_at(*node.find("target"), task.kind == TaskKind::tracing
                                                    ? "\"target\" of a tracing task is not \"end\"; the path's end was expected"
                                                    : "\"target\" of an advection task is \"end\"; \"circle\" or \"plane\" was expected");
  if (!(task.start_mm < task.rules.path_mm && task.reach_mm < task.rules.path_mm))
    return json::error_at(node, "\"start_mm\" or \"reach_mm\" is not below the path's length; less was expected");
  return read_scene_template(task);
}

const StudyTable<Task>& task_table() {
  using T = Task;
  static const auto table = [] {
    StudyTable<T> t;
    t.bind(schema::identifier("name", "Its name, in the tables.").required(), &T::name);
    t.bind(
        schema::word("kind", {"advection", "tracing"},
                     "`advection`: follow the flow, of which a short piece is seen at the cursor; `tracing`: follow a path that is seen.")
            .required(),
        &T::kind);
    t.bind(integer("dimensions", "", "2: all is measured in the picture plane.", 2, 3).required(), &T::dimensions);
    t.bind(schema::word("target", {"circle", "plane", "end"},
                        "Where a trial ends: a circle about the start or a level plane, which the path crosses at its end, or its end.")
               .by_default("`end`; advection: 2D `circle`, 3D `plane`"),
           &T::target);
    t.bind(schema::text("field", "The field of the scene that the path follows.").required(), &T::field);
    bind_object(t, "stimulus", stimulus_table(), &T::rules, "How start and path are chosen.");
    bind_object(t, "limits", limits_table(), &T::limits, "Times and errors.");
    t.bind(number("start_mm", "mm", "The clock starts when the cursor leaves this ball about the start; 2D: this circle.").positive(),
           &T::start_mm);
    t.bind(number("reach_mm", "mm", "Tracing: so near, the end is reached.").positive(), &T::reach_mm);
    t.bind(number("indicator_mm", "mm", "Advection: length of the local indicator.").positive(), &T::indicator_mm);
    t.hand(schema::object("scene", {}, "A scene (scene.md) without a chain, in which strings stand for values of the trial.").required(),
           [](const None&, const json::Node& object, T& task) -> Outcome {
             const json::Node* scene = object.find("scene");
             if (scene == nullptr) return json::error_at(object, "key \"scene\" is missing; a scene was expected");
             task.scene = *scene;
             return Done{};
           });
    t.check(check_task);
    return t;
  }();
  return table;
}

/// "chain": one for all tasks, or an object with one for each.
Outcome read_chains(const json::Node& object, const std::vector<Task>& tasks, Condition& condition) {
  const json::Node* chain = object.find("chain");
  if (chain == nullptr) return json::error_at(object, "key \"chain\" is missing; the links that are felt were expected, [] for none");
  std::vector<std::string_view> names;
  for (const Task& task : tasks) names.push_back(task.name);
  if (chain->kind == json::Kind::object) CATENA_CHECK(json::only_keys(*chain, names));
  for (const Task& task : tasks) {
    const json::Node* one = chain->kind == json::Kind::object ? chain->find(task.name) : chain;
    if (one == nullptr) return json::error_at(*chain, "\"chain\" has none for the task " + in_quotes(task.name) + "; one was expected");
    if (one->kind != json::Kind::array) return json::error_at(*one, "the chain is no array; an array of links was expected");
    CATENA_CHECK(check_values(*one));
    condition.chains.push_back(*one);
  }
  return Done{};
}

schema::Keys condition_keys() {
  return {schema::identifier("name", "Its name, in the tables.").required(),
          schema::any_of("chain", {schema::object("", {}, ""), schema::texts("", "")},
                         "The links that are felt (scene.md, `chain`): an array for all tasks, or an object with one for each.")
              .required()};
}

const StudyTable<OperatorModel>& operator_table() {
  using T = OperatorModel;
  static const auto table =
      StudyTable<T>()
          .bind(number("speed_mm_per_s", "mm/s", "How fast the hand reaches, in the median.").positive(), &T::speed_mm_per_s)
          .bind(number("speed_spread_subject", "", "Standard deviation over subjects of the speed's logarithm.").within(0, 2),
                &T::speed_spread_subject)
          .bind(number("speed_spread_trial", "", "The same over a subject's trials.").within(0, 2), &T::speed_spread_trial)
          .bind(number("motor_noise", "", "Standard deviation of the hand's velocity, as a share of its speed.").within(0, 2),
                &T::motor_noise)
          .bind(number("motor_noise_s", "s", "Its correlation time.").positive(), &T::motor_noise_s)
          .bind(number("lateral_noise_mm", "mm", "Standard deviation of where things are seen in the picture plane, each way.")
                    .not_negative(),
                &T::lateral_noise_mm)
          .bind(number("depth_noise_mm", "mm", "The same along the view, in 3D tasks.").not_negative(), &T::depth_noise_mm)
          .bind(number("depth_bias_mm", "mm", "Standard deviation over subjects of a constant error along the view.").not_negative(),
                &T::depth_bias_mm)
          .bind(number("seeing_noise_s", "s", "Correlation time of the noises of seeing.").positive(), &T::seeing_noise_s)
          .bind(number("tremor_mm", "mm", "Root mean square of the tremor, each axis.").not_negative(), &T::tremor_mm)
          .bind(number("tremor_lo_hz", "Hz", "Its lowest frequency.").positive(), &T::tremor_lo_hz)
          .bind(number("tremor_hi_hz", "Hz", "Its highest frequency.").positive(), &T::tremor_hi_hz)
          .bind(number("delay_s", "s", "From what is seen to what the hand does.").within(0, 1), &T::delay_s)
          .bind(number("correction_per_s", "1/s", "How fast a deviation that is seen is taken back.").not_negative(), &T::correction_per_s)
          .bind(number("stiffness_n_per_mm", "N/mm", "Of the hand about where it wants to be.").positive(), &T::stiffness_n_per_mm)
          .bind(number("damping_ns_per_m", "N s/m", "Of the same.").not_negative(), &T::damping_ns_per_m)
          .bind(number("yield_n", "N", "The hand gives way to a greater force.").positive(), &T::yield_n)
          .check([](const None&, const json::Node& node, T& model) -> Outcome {
            if (model.tremor_lo_hz <= model.tremor_hi_hz) return Done{};
            return json::error_at(json::member_or(node, "tremor_lo_hz"),
                                  "\"tremor_lo_hz\" is above \"tremor_hi_hz\"; at most that was expected");
          });
  return table;
}

schema::Keys question_keys() {
  return {schema::identifier("name", "Its name, in the table of answers.").required(),
          schema::text("question", "What is asked.").required(), schema::texts("answers", "What can be answered.").by_default("any text")};
}

Outcome read_question(const json::Node& node, Question& question) {
  CATENA_CHECK(json::only_keys(node, schema::names_of(question_keys())));
  CATENA_CHECK(schema::read_value(question_keys()[0], node, question.name));
  CATENA_CHECK(schema::read_value(question_keys()[1], node, question.question));
  const json::Node* answers = node.find("answers");
  if (answers == nullptr) return Done{};
  if (answers->kind != json::Kind::array || answers->items.size() < 2)
    return json::error_at(*answers, "\"answers\" is no list of two or more; strings to choose from were expected");
  for (const json::Node& answer : answers->items) {
    CATENA_TRY(std::string text, json::as_string(answer, "answers"));
    question.answers.push_back(std::move(text));
  }
  return Done{};
}

/// Objects of an array, each with a name of its own.
template <class T, class Read>
Outcome read_items(const json::Node& root, const char* key, std::size_t least, std::vector<T>& out, Read&& read) {
  const json::Node* list = root.find(key);
  if (list == nullptr && least == 0) return Done{};
  if (list == nullptr || list->kind != json::Kind::array || list->items.size() < least)
    return json::error_at(json::member_or(root, key),
                          in_quotes(key) + " has fewer than " + std::to_string(least) + " items; an array of objects was expected");
  std::set<std::string> names;
  for (const json::Node& item : list->items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item, out.emplace_back()));
    if (!names.insert(out.back().name).second)
      return json::error_at(*item.find("name"),
                            "there are two of the name " + in_quotes(out.back().name) + "; different names were expected");
  }
  return Done{};
}

const StudyTable<Study>& study_table() {
  using T = Study;
  static const auto table = [] {
    StudyTable<T> t;
    t.bind(schema::text("name", "Its name, for titles.").required(), &T::name);
    t.bind(integer("seed", "", "Of everything that is drawn by chance.", 0, 1'000'000'000), &T::seed);
    t.bind(integer("subjects", "", "How many subjects the design is made for.", 1, 9999), &T::subjects);
    t.bind(integer("trials", "", "Stimuli of a task: so many trials in every condition.", 1, 1000), &T::trials);
    t.bind(integer("training", "", "Trials before them, of every task in every condition; they are not analysed.", 0, 100), &T::training);
    t.hand(schema::file("instructions", "A text with the pages of instructions, relative to this file.").by_default("none"),
           [](const None&, const json::Node& root, T& study) -> Outcome {
             CATENA_TRY(study.instructions, json::get_string(root, "instructions", {}));
             if (study.instructions.empty() || std::filesystem::path(study.instructions).is_absolute()) return Done{};
             study.instructions = (std::filesystem::path(study.path).parent_path() / study.instructions).string();
             return Done{};
           });
    return t;
  }();
  return table;
}

}  // namespace

std::vector<schema::Component> study_components() {
  using Shape = schema::Component::Shape;
  return {{"study", "What concerns all of it, at the top of the file.", Shape::object, study_table().keys()},
          {"tasks", "What is seen and asked.", Shape::list, task_table().keys()},
          {"conditions", "What is felt. The first is the one that the others are compared with.", Shape::list, condition_keys()},
          {"operator", "The model of a subject for `study simulate`.", Shape::object, operator_table().keys()},
          {"questionnaire", "What is asked at the end of a session.", Shape::list, question_keys()}};
}

Result<Study> parse_study(std::string_view text, const std::string& path) {
  Study study;
  study.path = path;
  study.text = std::string(text);
  CATENA_TRY(study.document, json::parse(text, path));
  const json::Node& root = study.document;
  CATENA_CHECK(json::expect_object(root, "the study"));
  std::vector<std::string_view> keys = schema::names_of(study_table().keys());
  for (const char* key : {"$schema", "tasks", "conditions", "operator", "questionnaire", "compare", "findings"}) keys.push_back(key);
  CATENA_CHECK(json::only_keys(root, keys));
  CATENA_CHECK(study_table().read_known(kNone, root, study));
  CATENA_CHECK(
      read_items(root, "tasks", 1, study.tasks, [](const json::Node& node, Task& task) { return task_table().read(kNone, node, task); }));
  const auto read_condition = [&](const json::Node& node, Condition& condition) -> Outcome {
    CATENA_CHECK(json::only_keys(node, schema::names_of(condition_keys())));
    CATENA_CHECK(schema::read_value(condition_keys()[0], node, condition.name));
    return read_chains(node, study.tasks, condition);
  };
  CATENA_CHECK(read_items(root, "conditions", 1, study.conditions, read_condition));
  if (const json::Node* model = root.find("operator")) {
    CATENA_CHECK(json::expect_object(*model, "operator"));
    CATENA_CHECK(operator_table().read(kNone, *model, study.model));
  }
  CATENA_CHECK(read_items(root, "questionnaire", 0, study.questions, read_question));
  return study;
}

Result<Study> read_study(const std::string& path) {
  CATENA_TRY(const std::string text, read_text(path, "a study file (JSON)", kMaxJsonBytes));
  return parse_study(text, path);
}

}  // namespace catena::study
