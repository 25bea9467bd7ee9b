/// A study: the experiment of the paper's section 7, described by one JSON file (docs/study.md) so that another is made without code.
/// Its tasks are done in every condition on the same stimuli; tasks differ in what is seen and asked, conditions in what is felt.
///
/// Lengths of the file that end in _mm are millimetres of the hand; scenes have world units, mm = 1000 * meters_per_unit of them.
/// Errors are one line, FILE:LINE: what; what was expected. Read once, then asked on any thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/schema/key.h"

namespace catena::study {

/// Advection: where does the flow lead? The path is not shown. Tracing: a path that is shown is followed to its end.
enum class TaskKind { advection, tracing };
/// "advection" or "tracing".
const char* to_string(TaskKind kind);

/// What ends a trial: the circle about the start that the path first crosses at its end, the ground plane through the end, or the end.
enum class Target { circle, plane, end };

/// How the places of a trial are found in its field; stimulus.h has the rules.
struct StimulusRules {
  double path_mm = 100;                ///< length of every correct path
  double clearance_mm = 4;             ///< the start is at least this far from every global streamline
  int context_streamlines = 12;        ///< global streamlines
  double context_length_mm = 150;      ///< the longest that one is, each way
  double parallel = 0.8;               ///< of a 3D path at least this share of its length is seen in the picture plane
  double crossing_deg = 30;            ///< advection: the path meets its target at no flatter angle
  double turn_deg = 0;                 ///< the path's tangent turns at least this much between its ends or its middle
  double min_curvature_radius_mm = 3;  ///< the path bends with no smaller radius
  int candidates = 64;                 ///< starts tried in a field, before the next field is
  double region = 0.5;                 ///< share of the field's box, about its middle, in which starts lie
};

/// How long a trial of a task may take, and which trials the analysis leaves out.
struct Limits {
  double announced_limit_s = 10;                    ///< what the subject is told that a trial may take; not enforced
  double timeout_s = 30;                            ///< a trial ends so long after its clock has started (judge.h)
  double reject_error_mm = 30, reject_time_s = 10;  ///< analyse leaves out trials with a greater error or time
};

/// One task of the experiment.
struct Task {
  std::string name;                   ///< in the tables
  TaskKind kind = TaskKind::tracing;  ///< what is asked
  int dimensions = 2;                 ///< 2: all is measured in the picture plane; 3
  Target target = Target::end;        ///< what ends a trial
  StimulusRules rules;                ///< how its places are found
  Limits limits;                      ///< how long a trial may take
  double start_radius_mm = 4;         ///< the clock starts when the cursor leaves this ball (2D: circle) about the start
  double target_radius_mm = 4;        ///< tracing: so near, the end is reached
  double indicator_mm = 20;           ///< advection: length of the local indicator, as the operator model sees it
  std::string field;                  ///< of `scene`: the one that the path follows
  json::Node scene_template;          ///< the template of a trial's scene (trial_scene.h)
  json::Node where;                   ///< its place in the file, for messages

  // of the scene
  double meters_per_unit = 1;           ///< metres of hand a world unit
  Vec3 camera_position{0.0};            ///< world
  Vec3 view_direction{0.0, 0.0, -1.0};  ///< unit, into the picture: the depth
  Vec3 image_plane_point{0.0};          ///< a place of the picture plane: what the camera looks at; 2D tasks lie in that plane
  bool orthographic = false;            ///< the camera has no perspective

  /// World units of so many millimetres of the hand.
  double world_from_mm(double mm) const { return 1e-3 * mm / meters_per_unit; }
  /// Millimetres of the hand of a length in the world.
  double mm_from_world(double world_length) const { return 1e3 * meters_per_unit * world_length; }
};

/// What is felt.
struct Condition {
  std::string name;                ///< in the tables
  std::vector<json::Node> chains;  ///< a task's, in the order of the tasks
};

/// A model of a subject (operator.h). It stands in for nobody: what it gives tells about the model.
struct HumanModelParameters {
  double speed_mm_per_s = 55;                                     ///< how fast the hand reaches, in the median
  double speed_spread_subject = 0.36, speed_spread_trial = 0.27;  ///< of the speed's logarithm; together 0.45
  double motor_noise = 0.25;                                      ///< standard deviation of the velocity, times the speed
  double motor_noise_s = 0.1;                                     ///< how long it lasts: correlation time
  double lateral_noise_mm = 1.2;                                  ///< of what is seen, in the picture plane, each way
  double depth_noise_mm = 8;                                      ///< and along the view
  double depth_bias_mm = 5;                                       ///< standard deviation over subjects of a constant one
  double seeing_noise_s = 0.5;                                    ///< correlation time of both noises
  double tremor_mm = 0.3;                                         ///< root mean square, each axis
  double tremor_lo_hz = 8, tremor_hi_hz = 10.6;                   ///< the tremor's lowest and highest frequency
  double delay_s = 0.2;                                           ///< from what is seen to what the hand does
  double correction_per_s = 2.5;                                  ///< how fast a deviation that is seen is taken back
  double stiffness_n_per_mm = 0.5;                                ///< of the hand about where it wants to be
  double damping_ns_per_m = 15;                                   ///< of the hand about where it wants to be, N s/m
  double yield_n = 3;                                             ///< the hand gives way to a greater force
};

inline constexpr std::size_t kMaxAnswers = 9;  ///< to choose from, a key each

/// A question after the session.
struct Question {
  std::string name, question;        ///< the column of the table; what is asked
  std::vector<std::string> answers;  ///< to choose from; empty: any text
};

/// A whole study. Immutable once read.
struct Study {
  std::string path, text;             ///< as it was read, verbatim
  json::Node document;                ///< all of it; "compare" and "findings" are read by what analyses
  std::string name;                   ///< for titles
  int seed = 1;                       ///< of everything that is drawn by chance
  int subjects = 20;                  ///< that the design was made for
  int trials = 10;                    ///< of every task in every condition: so many stimuli
  int training = 1;                   ///< before them, of every task in every condition; not analysed
  std::vector<Task> tasks;            ///< in the order of the file
  std::vector<Condition> conditions;  ///< the first is the baseline
  HumanModelParameters human_model;   ///< the model of a subject, for `study simulate`
  std::string instructions;           ///< a text file, its path as the program opens it; empty: none
  std::vector<Question> questions;    ///< after the session
};

/// Reads and checks a file. An error is one line with the file's name and line.
Result<Study> read_study(const std::string& path);
/// The same of a text; `path` is what messages call it, and where relative names begin.
Result<Study> parse_study(std::string_view text, const std::string& path);

/// The keys of the file, for its schema and docs/study.md.
std::vector<schema::Section> study_components();

}  // namespace catena::study
