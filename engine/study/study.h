// SPDX-License-Identifier: MIT
/// A study: the experiment of the paper's section 7, described by one JSON file (docs/reference/study.md), so that another experiment needs
/// no code. Every task is done in every condition on the same stimuli. Tasks differ in the visible objects and in the subject's
/// task, conditions in the haptic links.
///
/// Lengths whose names end in _mm are millimeters of the device; scenes have world units: mm = 1000 * meters_per_unit * world units. Errors
/// are one line, "FILE:LINE: what; what was expected". A Study is immutable after it is read and can be used on any thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/json.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/schema/key.h"

namespace catena::study {

/// Kind of task. Advection: the subject follows the flow, whose path is not visible. Tracing: the subject follows a visible path to its
/// end.
enum class TaskKind { advection, tracing };
/// "advection" or "tracing".
CATENA_EXPORT const char* to_string(TaskKind kind);

/// Event that ends a trial: crossing the circle about the start through the path's end, crossing the horizontal plane through the path's
/// end, or reaching the path's end.
enum class Target { circle, plane, end };

/// Rules by which a trial's start and path are found in its field; stimulus.h describes them.
struct StimulusRules {
  double path_mm = 100;            ///< Length of the path of every trial
  double clearance_mm = 4;         ///< Minimum distance of the start from every global line
  int context_streamlines = 12;    ///< Number of global lines
  double context_length_mm = 150;  ///< Maximum length of a global line, in each direction
  double parallel = 0.8;           ///< 3D: minimum fraction of the path's length that remains after projection onto the image plane
  double crossing_deg = 30;        ///< Advection: minimum angle between the path and its target
  double turn_deg = 0;             ///< Minimum turn of the path's tangent from the start to the middle or to the end (the larger counts)
  double min_curvature_radius_mm = 3;  ///< Minimum radius of curvature of the path
  int candidates = 64;                 ///< Number of starts tried in a field before the next field
  double region = 0.5;                 ///< Fraction of the field's box, about its center, that contains the starts; (0, 1]
};

/// Time limits of a task's trials, and which trials the analysis rejects.
struct Limits {
  double announced_limit_s = 10;                    ///< Time limit that the instructions state; not enforced
  double timeout_s = 30;                            ///< Time after the start of the clock at which a trial ends (trial_scorer.h)
  double reject_error_mm = 30, reject_time_s = 10;  ///< `study analyse` rejects trials with a greater error or time
};

/// One task of the experiment.
struct Task {
  std::string name;                   ///< Name in the tables
  TaskKind kind = TaskKind::tracing;  ///< Task of the subject
  int dimensions = 2;                 ///< 2: everything is measured in the image plane; or 3
  Target target = Target::end;        ///< Event that ends a trial
  StimulusRules rules;                ///< Rules for start and path
  Limits limits;                      ///< Time limits and rejection
  double start_radius_mm = 4;         ///< The clock starts when the cursor leaves this ball (2D: circle) about the start
  double target_radius_mm = 4;        ///< Tracing: distance from the path's end at which it counts as reached
  double indicator_mm = 20;           ///< Advection: length of the local indicator that the human model sees
  std::string field;                  ///< Name of the vector field in `scene_template` that the path follows
  json::Node scene_template;          ///< Template of a trial's scene (trial_scene.h)
  json::Node where;                   ///< Source location in the study file, for messages

  // Values read from the scene template.
  double meters_per_unit = 1;           ///< Device meters per world unit
  Vec3 camera_position{0.0};            ///< World units
  Vec3 view_direction{0.0, 0.0, -1.0};  ///< Unit vector into the image: the depth direction
  Vec3 image_plane_point{0.0};          ///< A point of the image plane: the camera's target; 2D tasks lie in this plane
  bool orthographic = false;            ///< The camera has no perspective

  /// Converts device millimeters to world units.
  double world_from_mm(double mm) const { return 1e-3 * mm / meters_per_unit; }
  /// Converts world units to device millimeters.
  double mm_from_world(double world_length) const { return 1e3 * meters_per_unit * world_length; }
};

/// A haptic condition of the experiment.
struct Condition {
  std::string name;                ///< Name in the tables
  std::vector<json::Node> chains;  ///< One chain per task, in the order of the tasks: JSON arrays of links
};

/// Parameters of the human model (human_model.h). The model replaces no people: its results describe the model only.
struct HumanModelParameters {
  double speed_mm_per_s = 55;                                     ///< Median speed of the hand
  double speed_spread_subject = 0.36, speed_spread_trial = 0.27;  ///< Standard deviations of the logarithm of the speed; together 0.45
  double motor_noise = 0.25;                                      ///< Standard deviation of the velocity, relative to the speed
  double motor_noise_s = 0.1;                                     ///< Correlation time of the motor noise
  double lateral_noise_mm = 1.2;                 ///< Standard deviation of perceived positions, on each axis of the image plane
  double depth_noise_mm = 8;                     ///< Standard deviation of perceived positions along the view direction; 3D tasks
  double depth_bias_mm = 5;                      ///< Standard deviation over subjects of a constant depth error; 3D tasks
  double seeing_noise_s = 0.5;                   ///< Correlation time of the lateral and the depth noise
  double tremor_mm = 0.3;                        ///< Root mean square of the tremor on each axis
  double tremor_lo_hz = 8, tremor_hi_hz = 10.6;  ///< Lowest and highest frequency of the tremor
  double delay_s = 0.2;                          ///< Delay between perception and movement
  double correction_per_s = 2.5;                 ///< Gain that corrects a perceived deviation from the path
  double stiffness_n_per_mm = 0.5;               ///< Stiffness of the hand's grip about its target position
  double damping_ns_per_m = 15;                  ///< Damping of the hand's grip about its target position, N s/m
  double yield_n = 3;                            ///< Force beyond which the hand yields: its target then follows the cursor
};

inline constexpr std::size_t kMaxAnswers = 9;  ///< Maximum number of choices of a question; one number key each

/// A question of the questionnaire after the session.
struct Question {
  std::string name, question;        ///< Identifier in the table of answers; the text shown to the subject
  std::vector<std::string> answers;  ///< The choices; empty: any text can be typed
};

/// A complete study. Immutable after it is read.
struct Study {
  std::string path, text;  ///< The file's path, and its text verbatim
  json::Node document;     ///< The whole file as parsed; read_analysis_plan() reads "compare" and "findings" from it
  std::string name;        ///< Name for titles
  int seed = 1;            ///< Seed of all random choices
  int subjects = 20;       ///< Number of subjects that the design is made for
  int trials = 10;         ///< Number of stimuli of a task; each is done in every condition
  int training = 1;  ///< Number of training stimuli of a task, each done in every condition before the trials; excluded from the analysis
  std::vector<Task> tasks;            ///< In the order of the file
  std::vector<Condition> conditions;  ///< The first is the baseline
  HumanModelParameters human_model;   ///< Parameters for `study simulate`
  std::string instructions;           ///< Path of the instructions, a text file, resolved against the study file's folder; empty: none
  std::vector<Question> questions;    ///< The questionnaire after the session
};

/// Reads and checks a study file. Error: the first mistake, with the file's name and line.
CATENA_EXPORT Result<Study> read_study(const std::string& path);
/// Parses and checks a study file's text. `path` is the file name in messages and the base of relative paths.
CATENA_EXPORT Result<Study> parse_study(std::string_view text, const std::string& path);

/// The keys of the study file, for its schema and docs/reference/study.md.
CATENA_EXPORT std::vector<schema::Section> study_components();

}  // namespace catena::study
