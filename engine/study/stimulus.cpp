// SPDX-License-Identifier: MIT
#include "engine/study/stimulus.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/random.h"
#include "engine/base/text.h"
#include "engine/geometry/flow/curve.h"
#include "engine/scene/scene.h"
#include "engine/study/trial_scene.h"

namespace catena::study {
namespace {

constexpr int kFields = 200;       ///< maximum number of fields that are searched for a start
constexpr int kStarts = 20000;     ///< maximum number of starts tried in all fields together
constexpr double kMaxBoxes = 100;  ///< maximum length of paths and lines, in diagonals of the field's box
constexpr int kLineChoices = 6;    ///< a context streamline is seeded at the candidate, of this many, that is farthest from the other lines
constexpr int kLinePlaces = 60;    ///< maximum number of random points drawn for the candidates: the field may have no value at some
constexpr double kPathTolerance = 1e-9;  ///< of the final path, as a fraction of L
constexpr double kLineTolerance = 1e-6;  ///< of lines and of trial paths, as a fraction of L
constexpr double kHidingRadiusMm = 1.5;  ///< a context streamline occludes points of the path within this distance in the image
constexpr double kFlat = 1e-6;           ///< maximum distance of a 2D path from the image plane, as a fraction of its length
constexpr int kStride = 8;               ///< every kStride-th point of the path is tested for occlusion

/// Returns the seed for the next field; below 2^30.
int next_seed(int seed) { return static_cast<int>(mix_bits(static_cast<std::uint64_t>(seed)) >> 34); }

double sine(double degrees) { return std::sin(degrees * std::numbers::pi / 180); }

double distance_to(const std::vector<std::vector<Vec3>>& lines, const Vec3& p) {
  double min_distance2 = std::numeric_limits<double>::infinity();
  for (const auto& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec3 segment = line[i] - line[i - 1];
      const double length2 = dot(segment, segment), u = length2 > 0 ? std::clamp(dot(p - line[i - 1], segment) / length2, 0.0, 1.0) : 0;
      const Vec3 offset = p - line[i - 1] - u * segment;
      min_distance2 = std::min(min_distance2, dot(offset, offset));
    }
  return std::sqrt(min_distance2);
}

/// Reasons why a start is rejected, in the order of the tests.
enum class Fault { leaves, turn, bend, flat, parallel, crossing, line };
constexpr int kFaults = 7;
constexpr const char* kFaultWords[kFaults] = {"have no path of this length within the field",
                                              "turn too little",
                                              "bend too sharply",
                                              "leave the image plane",
                                              "are too parallel to the viewing direction",
                                              "meet the target at too small an angle, or too early",
                                              "are too close to a global line"};
using Faults = std::array<int, kFaults>;

std::string describe_faults(const Faults& fault_counts) {
  std::string text;
  for (int i = 0; i < kFaults; ++i)
    if (const int n = fault_counts[static_cast<std::size_t>(i)]; n > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, kFaultWords[i]);
  return text;
}

/// Random choice of start and context streamlines in one field.
class Draw {
 public:
  Draw(const Task& task, const field::VectorField& field, int seed)
      : task_(task),
        rules_(task.rules),
        field_(field),
        box_(field.world_bounds()),
        random_(mix_bits(static_cast<std::uint64_t>(seed))),
        line_random_(~mix_bits(static_cast<std::uint64_t>(seed))) {
    stimulus_.seed = seed;
    stimulus_.length = task.world_from_mm(rules_.path_mm);
    stimulus_.context_length = task.world_from_mm(rules_.context_length_mm);
  }

  /// Returns the candidate with the least occlusion, or nullopt; `fault_counts` counts the reasons for rejection.
  std::optional<Stimulus> stimulus(Faults& fault_counts) {
    std::optional<Stimulus> best;
    for (int k = 0; k < rules_.candidates; ++k) {
      const Vec3 start = place(rules_.region, random_);
      if (const auto fault = fault_of(start)) {
        ++fault_counts[static_cast<std::size_t>(*fault)];
        continue;
      }
      stimulus_.occluded_share = task_.dimensions == 3 ? occluded_share() : 0;
      if (!best || stimulus_.occluded_share < best->occluded_share) best = stimulus_;
      if (best->occluded_share == 0) break;
    }
    return best;
  }

 private:
  Vec3 place(double share, Random& random) const {
    const Vec3 middle = box_.center();
    Vec3 p(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double half = 0.5 * share * (box_.hi[axis] - box_.lo[axis]);
      p[axis] = random.between(middle[axis] - half, middle[axis] + half);
    }
    return task_.dimensions == 3 ? p : p - task_.view_direction * dot(p - task_.image_plane_point, task_.view_direction);
  }

  flow::CurvePtr traced(const Vec3& seed, double length, double tolerance) const {
    flow::TraceOptions options;
    options.length = length;
    options.tolerance = tolerance;
    options.hermite_tolerance = tolerance;
    auto curve = flow::trace({.field = &field_}, seed, options);
    return curve ? *curve : nullptr;
  }

  std::optional<Fault> fault_of(const Vec3& start) {
    if (!trace_path(start, kLineTolerance)) return Fault::leaves;
    if (const auto fault = fault_of_path()) return fault;
    if (stimulus_.context_points.empty()) draw_lines();
    if (distance_to(lines_, start) < task_.world_from_mm(rules_.clearance_mm)) return Fault::line;
    // the selected path is traced with the final tolerance
    if (!trace_path(start, kPathTolerance)) return Fault::leaves;
    return fault_of_path();
  }

  bool has_flow(const Vec3& p) {
    const field::VectorSample sample = field_.sample(p, cursor_);
    return sample.inside && norm(sample.value) > 0;
  }

  void draw_lines() {
    const double step = task_.world_from_mm(2);
    for (int k = 0; k < rules_.context_streamlines; ++k) {
      std::optional<Vec3> seed;
      double max_distance = -1;
      for (int choice = 0, attempts = 0; choice < kLineChoices && attempts < kLinePlaces; ++attempts) {
        const Vec3 p = place(1, line_random_);
        if (!has_flow(p)) continue;
        ++choice;
        const double distance = distance_to(lines_, p);
        if (distance > max_distance) max_distance = distance, seed = p;
      }
      const flow::CurvePtr curve = seed ? traced(*seed, stimulus_.context_length, kLineTolerance) : nullptr;
      if (!curve) continue;
      const double s0 = curve->knots().front().s, s1 = curve->knots().back().s;
      const int pieces = std::max(1, static_cast<int>(std::ceil((s1 - s0) / step)));
      std::vector<Vec3>& line = lines_.emplace_back();
      for (int i = 0; i <= pieces; ++i) line.push_back(curve->position(s0 + (s1 - s0) * i / pieces));
      stimulus_.context_points.push_back(*seed);
    }
  }

  /// Traces the path downstream from the start; returns false if it is too short, closed or outside of the box.
  bool trace_path(const Vec3& start, double tolerance) {
    const double length = stimulus_.length;
    const flow::CurvePtr curve = traced(start, 1.001 * length, tolerance);
    if (!curve || curve->is_closed() || curve->knots().back().s < length) return false;
    stimulus_.path.clear();
    for (int i = 0; i < kPathPoints; ++i) {
      const Vec3 p = curve->position(length * i / (kPathPoints - 1));
      for (int axis = 0; axis < 3; ++axis)
        if (!(p[axis] >= box_.lo[axis] && p[axis] <= box_.hi[axis])) return false;
      stimulus_.path.push_back(p);
    }
    stimulus_.start = stimulus_.path.front();
    stimulus_.middle = stimulus_.path[(kPathPoints - 1) / 2];
    stimulus_.end = stimulus_.path.back();
    stimulus_.radius = norm(stimulus_.end - stimulus_.start);
    return true;
  }

  Vec3 tangent(std::size_t i) const {
    const std::vector<Vec3>& path = stimulus_.path;
    return direction(path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]);
  }

  std::optional<Fault> fault_of_path() const {
    const std::vector<Vec3>& path = stimulus_.path;
    const std::size_t last = path.size() - 1;
    const double min_cosine = std::cos(rules_.turn_deg * std::numbers::pi / 180);
    if (rules_.turn_deg > 0 && std::min(dot(tangent(0), tangent(last)), dot(tangent(0), tangent(last / 2))) > min_cosine)
      return Fault::turn;
    for (std::size_t i = 1; i < last; ++i) {
      // a corner of angle a between segments of length h has the curvature a / h
      const Vec3 incoming = path[i] - path[i - 1], outgoing = path[i + 1] - path[i];
      if (norm(direction(outgoing) - direction(incoming)) * task_.world_from_mm(rules_.min_curvature_radius_mm) > norm(incoming))
        return Fault::bend;
    }
    if (task_.dimensions == 2) {
      for (const Vec3& p : path)
        if (std::fabs(dot(p - task_.image_plane_point, task_.view_direction)) > kFlat * stimulus_.length) return Fault::flat;
    } else {
      double projected_length = 0;
      for (std::size_t i = 1; i < path.size(); ++i) {
        const Vec3 segment = path[i] - path[i - 1];
        projected_length += norm(segment - task_.view_direction * dot(segment, task_.view_direction));
      }
      if (projected_length < rules_.parallel * stimulus_.length) return Fault::parallel;
    }
    bool meets_target = true;
    if (task_.target == Target::circle)
      meets_target = first_crosses([&](const Vec3& p) { return norm(p - stimulus_.start); }, stimulus_.radius) &&
                     dot(tangent(last), direction(stimulus_.end - stimulus_.start)) >= sine(rules_.crossing_deg);
    if (task_.target == Target::plane)
      meets_target = first_crosses([&](const Vec3& p) { return -p.z; }, -stimulus_.end.z) && -tangent(last).z >= sine(rules_.crossing_deg);
    return meets_target ? std::nullopt : std::optional(Fault::crossing);
  }

  template <class Measure>
  bool first_crosses(Measure&& measure, double at_end) const {
    for (std::size_t i = 0; i + 1 < stimulus_.path.size(); ++i)
      if (measure(stimulus_.path[i]) >= at_end) return false;
    return true;
  }

  double occluded_share() const {
    const double radius = task_.world_from_mm(kHidingRadiusMm);
    int occluded = 0, tested = 0;
    for (std::size_t i = 0; i < stimulus_.path.size(); i += kStride) {
      const Vec3& p = stimulus_.path[i];
      const Vec3 ray = task_.orthographic ? task_.view_direction : direction(p - task_.camera_position);
      const double depth = dot(p - task_.camera_position, ray) - 2 * radius;
      ++tested;
      occluded += std::ranges::any_of(lines_, [&](const std::vector<Vec3>& line) {
        return std::ranges::any_of(line, [&](const Vec3& q) {
          const Vec3 offset = q - p;
          const double along = dot(offset, ray);
          return dot(q - task_.camera_position, ray) < depth && dot(offset, offset) - along * along < radius * radius;
        });
      });
    }
    return static_cast<double>(occluded) / tested;
  }

  const Task& task_;
  const StimulusRules& rules_;
  const field::VectorField& field_;
  Bounds box_;
  Random random_, line_random_;
  field::Cursor cursor_;
  std::vector<std::vector<Vec3>> lines_;
  Stimulus stimulus_;
};

/// Checks the lengths: one that is much longer than the field's box is an error in the units, and tracing it would not end.
Outcome check_lengths(const Task& task, const Bounds& box) {
  const double diagonal = norm(box.hi - box.lo);
  for (const auto& [key, mm] : {std::pair{"path_mm", task.rules.path_mm}, {"context_length_mm", task.rules.context_length_mm}})
    if (const double length = task.world_from_mm(mm); !(length <= kMaxBoxes * diagonal))
      return json::error_at(
          json::member_or_parent(task.where, "stimulus"),
          fmt::format("task {}: \"{}\" is {:.3g} world units, {:.3g} times the diagonal of the field's box; at most {:g} times "
                      "was expected (metres_per_unit is {:g})",
                      in_quotes(task.name), key, length, length / diagonal, kMaxBoxes, task.meters_per_unit));
  return Done{};
}

}  // namespace

Result<field::AnyField> StimulusGenerator::load_field(int task, int seed) {
  const Task& of = study_.tasks[static_cast<std::size_t>(task)];
  std::string text = make_field_scene(study_, of, seed);
  CachedField& cached = field_cache_[static_cast<std::size_t>(task)];
  if (cached.text != text) {
    CATENA_TRY(scene::Scene scene, scene::parse_scene(text, study_.path));
    CATENA_TRY(cached.field, scene::resolve_field(scene, of.field, of.where));
    cached.text = std::move(text);
  }
  if (!cached.field.vector)
    return json::error_at(json::member_or_parent(of.where, "field"),
                          "field " + in_quotes(of.field) + " is a scalar field; a vector field was expected");
  return cached.field;
}

Result<Stimulus> StimulusGenerator::generate(int task, int seed) {
  const Task& of = study_.tasks[static_cast<std::size_t>(task)];
  const int fields = std::clamp(kStarts / of.rules.candidates, 2, kFields);
  Faults fault_counts{};
  for (int k = 0, at = seed; k < fields; ++k, at = next_seed(at)) {
    CATENA_TRY(const field::AnyField field, load_field(task, at));
    CATENA_CHECK(check_lengths(of, field.vector->world_bounds()));
    if (auto found = Draw(of, *field.vector, at).stimulus(fault_counts)) return *found;
  }
  return json::error_at(json::member_or_parent(of.where, "stimulus"),
                        fmt::format("task {}: no start meets the rules: of {} random starts {}; less strict rules were expected",
                                    in_quotes(of.name), fields * of.rules.candidates, describe_faults(fault_counts)));
}

}  // namespace catena::study
