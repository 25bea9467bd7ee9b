// SPDX-License-Identifier: MIT
/// Methods of a streamline link: every integrator, the embedded ones at several tolerances, and the precomputed curve.
///   error  maximum distance of the proxy from the reference line, along the whole motion, by L
///   floor  discretization error: the lines through the same seed on the grid at 2 h and 4 h, extrapolated; a formula has none
#include "engine/app/tuning/measure/haptics/streamline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/format_number.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "haptics/constraints/streamline/online_streamline.h"
#include "haptics/constraints/streamline/selected_streamline.h"

namespace catena::app::tuning {
namespace {

constexpr double kReferenceTolerance = 1e-13;  // L

/// Maximum distance of one line from another, over the arc lengths lo..hi, by L.
double apart(const flow::Curve& line, const flow::NearestOnCurve& other, double lo, double hi, double length) {
  double maximum = 0;
  constexpr int kPointCount = 400;
  for (int k = 0; k <= kPointCount; ++k)
    maximum = std::max(maximum, other.find_exact(line.position(lo + (hi - lo) * k / kPointCount)).distance2);
  return std::sqrt(maximum) / length;
}

struct Line : StreamlineSource {
  std::string name;
  flow::TraceOptions options;
  flow::CurvePtr truth;
  double lo = 0, hi = 0;  ///< range of arc lengths that the probe reaches
  ProbeMotion motion;
};

/// Maximum error of the precomputed line over its full length in a link, since the proxy may be on any pass of it. By L.
double anywhere(const Line& line) {
  const auto traced = flow::trace(line.flow, line.seed), truth = flow::trace(line.flow, line.seed, converged_trace_options(0));
  if (!traced || !truth) return kNotMeasured;
  const double lo = std::max((*truth)->knots().front().s, (*traced)->knots().front().s),
               hi = std::min((*truth)->knots().back().s, (*traced)->knots().back().s);
  return apart(**traced, flow::NearestOnCurve(*truth), lo, hi, line.field->domain_length());
}

void add_floor(const Line& line, Curve& curve) {
  if (!line.field->is_grid()) {
    curve.discretization_error_method = "The field is a formula without discretization error.";
    return;
  }
  const auto levels = make_resolution_levels(*line.field->grid());
  if (!levels) {
    curve.discretization_error_method = "The discretization error is not known: the grid is too small or too large to be subsampled.";
    return;
  }
  double off[2];
  const flow::NearestOnCurve nearest(line.truth);
  for (int level = 1; level < 3; ++level) {
    const auto coarse = flow::trace({levels->grids[level].get(), line.flow.is_line_field, line.flow.min_speed}, line.seed, line.options);
    if (!coarse) {
      curve.discretization_error_method = "The discretization error is not known: with every " + std::string(level == 1 ? "2nd" : "4th") +
                                          " voxel there is no streamline through the seed.";
      return;
    }
    // limited to the range of both lines
    const double lo = std::max(line.lo, (*coarse)->knots().front().s), hi = std::min(line.hi, (*coarse)->knots().back().s);
    off[level - 1] = apart(**coarse, nearest, lo, hi, line.field->domain_length());
  }
  const ExtrapolatedError e = extrapolate_from_differences(off[0], off[1]);
  curve.discretization_error = e.error;
  if (!e.is_converged) curve.discretization_error_name += ", at least";
  curve.discretization_error_method =
      fmt::format("from the streamlines through the same seed on every 2nd voxel (difference {}) and every 4th ({}); {}",
                  format_number(off[0]), format_number(off[1]), describe_order(e));
}

Result<Line> make_line(Workload& subject, const NamedLink& link) {
  CATENA_TRY(StreamlineSource stated, resolve_link_streamline(subject.scene, link));
  Line line{std::move(stated), link.name, {}, {}, 0, 0, {}};
  const auto motion = motion_along_streamline(subject.scene, link, subject.effort.motion_s);
  if (!motion) return Error{"there is no streamline through the seed of link \"" + link.name + "\""};
  line.motion = *motion;
  // somewhat longer than the probe path
  const double length = std::min(0.6 * probe_speed(subject.scene) * subject.effort.motion_s, 1.2 * line.field->domain_length());
  line.options = converged_trace_options(length + 0.02 * line.field->domain_length());
  CATENA_TRY(line.truth, flow::trace(line.flow, line.seed, line.options));
  line.lo = line.truth->knots().front().s;
  line.hi = line.truth->knots().back().s;
  return line;
}

}  // namespace

Result<StreamlineSource> resolve_link_streamline(scene::Scene& scene, const NamedLink& link) {
  StreamlineSource line;
  line.field = find_link_field(scene, link.node).vector;
  if (!line.field) return Error{"link \"" + link.name + "\" has no vector field"};
  const json::Node* kind = link.node.find("kind");
  CATENA_TRY(const double min_speed, json::get_number(link.node, "min_speed", 0));
  line.flow = {line.field.get(), kind != nullptr && kind->string == "line", min_speed};
  CATENA_TRY(const auto seed, json::get_optional_vec3(link.node, "seed"));
  if (!seed) return Error{"link \"" + link.name + "\" has no seed: the streamline is known only during the interaction"};
  line.seed = *seed;
  return line;
}

flow::TraceOptions converged_trace_options(double length) {
  return {.length = length, .tolerance = kReferenceTolerance, .hermite_tolerance = kReferenceTolerance};
}

std::string StreamlineSetting::config_text(const NamedLink& link) const {
  std::string text, replaced;
  for (const auto& [key, value] : keys) text += (text.empty() ? "\"" : ", \"") + key + "\": " + value;
  const auto replaces = [&](const char* key) {
    if (link.node.find(key) != nullptr) replaced += fmt::format("{}`\"{}\"`", replaced.empty() ? "" : " and ", key);
  };
  if (is_selected) {
    replaces("method");
    replaces("tolerance");
  } else if (const json::Node* follow = link.node.find("follow"); follow != nullptr && follow->string == "selected") {
    replaces("follow");
  }
  return replaced.empty() ? text : fmt::format("`{}` in place of {} in the link \"{}\"", text, replaced, link.name);
}

std::vector<StreamlineSetting> streamline_settings(const json::Node& link) {
  using flow::Method;
  std::vector<StreamlineSetting> all{{"selected", "selected (traced once)", {{"follow", "\"selected\""}}, true}};
  const auto word_of = [](Method method) { return std::string(flow::to_string(method)); };
  for (const Method method : {Method::linear, Method::euler, Method::rk2, Method::rk3, Method::rk4}) {
    const std::string word = word_of(method);
    all.push_back({word, word, {{"method", "\"" + word + "\""}}, false, method});
  }
  std::vector<std::pair<double, std::string>> tolerances;
  for (int digits = 3; digits <= 13; digits += 2) tolerances.emplace_back(std::pow(10.0, -digits), fmt::format("1e-{}", digits));
  // the setting that the link itself states, if it differs
  if (const json::Node* own = link.find("tolerance");
      own != nullptr && own->kind == json::Kind::number && own->number > 0 && own->number < 1) {
    const auto near = [&](const auto& t) { return std::fabs(t.first - own->number) <= 1e-9 * own->number; };
    if (std::none_of(tolerances.begin(), tolerances.end(), near))
      tolerances.emplace_back(own->number, with_short_exponent(to_text(own->number)));
  }
  for (const Method method : {Method::rkf34, Method::dp54})
    for (const auto& [tolerance, text] : tolerances) {
      const std::string word = word_of(method);
      all.push_back({word + ", tolerance " + text, word, {{"method", "\"" + word + "\""}, {"tolerance", text}}, false, method, tolerance});
    }
  return all;
}

Result<Curve> measure_streamline_link(Workload& subject, const NamedLink& link) {
  CATENA_TRY(const Line line, make_line(subject, link));
  const double length = line.field->domain_length();
  const flow::NearestOnCurve nearest(line.truth);
  Curve curve;
  curve.id = streamline_curve_id(line.name);
  curve.title = "Method of the streamline link \"" + line.name + "\"";
  curve.description = fmt::format(
      "The probe moves {} ({:g} Hz unless a rate is stated); each setting follows the streamline alone, from the seed. A fixed step is "
      "as long as the probe's motion in a tick, so that its error depends on the tick rate. Other tick rates are shown for comparison, but "
      "only settings at the rate of the scene are chosen. The traced curve needs no fetches in a tick, and is not in the plot against "
      "fetches.",
      line.motion.description, subject.rate_hz);
  curve.error_name = "maximum distance from the streamline / L";
  curve.work_name = "field fetches per ms of motion";
  curve.time_name = "ns of processor time per ms of motion";
  curve.extra_columns = {"before the first tick, ms", "ticks not OK, %", "maximum distance anywhere on the streamline / L"};

  // the reference line, and a less accurate one
  flow::TraceOptions coarser = line.options;
  coarser.tolerance *= 100;
  coarser.hermite_tolerance *= 100;
  CATENA_TRY(const flow::CurvePtr check, flow::trace(line.flow, line.seed, coarser));
  curve.reference_error = apart(*check, nearest, line.lo, line.hi, length);
  curve.reference = fmt::format(
      "the streamline traced with a tolerance of 1e-13 L; it differs from the one of 1e-11 L by {} L, so that smaller errors cannot be "
      "resolved",
      format_number(curve.reference_error));
  add_floor(line, curve);

  std::vector<haptics::HapticProgram> programs;
  std::vector<double> rates;
  const auto add = [&](Point point, std::shared_ptr<const haptics::Constraint> constraint, double rate_hz) {
    programs.push_back(isolate_link(*subject.program, line.name, std::move(constraint)));
    rates.push_back(rate_hz);
    point.extra_values.resize(2, 0);
    point.extra_values.push_back(programs.size() == 1 ? anywhere(line) : kNotMeasured);
    point.is_selectable = rate_hz == subject.rate_hz;  // the tick rate is chosen separately (tick_rate.cpp)
    curve.points.push_back(std::move(point));
  };
  const std::int64_t start = now_ns();
  flow::TraceOptions usual;
  usual.length = line.options.length;
  CATENA_TRY(flow::CurvePtr selected, flow::trace(line.flow, line.seed, usual));
  const std::vector<StreamlineSetting> settings = streamline_settings(link.node);
  Point cached{settings[0].label, settings[0].config_text(link), settings[0].series};
  cached.extra_values = {ms_since(start)};
  add(std::move(cached), haptics::make_selected_streamline(std::move(selected)), subject.rate_hz);
  const auto online = [&](flow::Method method, double tolerance) {
    return haptics::make_online_streamline({line.field, line.flow.is_line_field, line.flow.min_speed, method, tolerance, line.seed});
  };
  for (const StreamlineSetting& setting : settings) {
    if (setting.is_selected) continue;
    // a fixed step is as long as the probe's path in a tick: it depends on the tick rate
    const bool fixed = !setting.tolerance;
    for (const double times : fixed ? std::vector{0.25, 1.0, 4.0} : std::vector{1.0}) {
      const std::string rate = fmt::format("{:g}", times * subject.rate_hz);
      add({times == 1 ? setting.label : setting.label + ", " + rate + " Hz",
           setting.config_text(link) + (times == 1 ? "" : "; --rate " + rate), setting.series},
          online(*setting.method, setting.tolerance.value_or(1e-9)), times * subject.rate_hz);
    }
  }
  const json::Node *method = link.node.find("method"), *follow = link.node.find("follow");
  if (method == nullptr && (follow == nullptr || follow->string == "selected")) curve.current = 0;
  if (method != nullptr || curve.current < 0) {
    const std::string word = method != nullptr ? method->string : "rkf34";
    CATENA_TRY(const double tolerance, json::get_number(link.node, "tolerance", 1e-9));
    for (const StreamlineSetting& s : settings) {
      const bool own = !s.is_selected && flow::to_string(*s.method) == word;
      if (!own || (s.tolerance && !(std::fabs(*s.tolerance - tolerance) <= 1e-9 * tolerance))) continue;
      for (std::size_t i = 0; i < curve.points.size(); ++i)
        if (curve.points[i].setting == s.label) curve.current = static_cast<int>(i);
    }
  }

  std::vector<std::vector<haptics::ProbeSample>> paths;
  for (const double rate : rates) paths.push_back(line.motion.samples(rate));
  std::vector<TimedRun> repeats;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    Point& p = curve.points[i];
    double far2 = 0, fetches = 0, bad = 0;
    run_ticks(programs[i], paths[i], [&](const HapticState& out) {
      const LinkReport& report = out.links[0];
      far2 = std::max(far2, nearest.find_exact(report.proxy).distance2);
      fetches += report.evaluations;
      bad += report.status != LinkStatus::ok;
    });
    const double ticks_a_ms = 1e-3 * rates[i];
    p.error = std::sqrt(far2) / length;
    p.work = ticks_a_ms * fetches / static_cast<double>(paths[i].size());
    p.extra_values[1] = 100 * bad / static_cast<double>(paths[i].size());
    const TimedRun ticks = make_tick_run(programs[i], paths[i]);
    repeats.push_back([ticks, ticks_a_ms]() -> Result<double> {
      CATENA_TRY(const double ns, ticks());
      return ns * ticks_a_ms;
    });
  }
  CATENA_CHECK(time_points(curve, repeats, subject.effort.haptics_s));
  return curve;
}

Result<std::vector<Curve>> measure_streamline(Workload& subject) {
  return measure_links(subject, "streamline", "Method of a streamline link", measure_streamline_link);
}

}  // namespace catena::app::tuning
