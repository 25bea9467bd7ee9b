// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/workload.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/haptics/probe_playback.h"
#include "engine/geometry/flow/curve.h"
#include "engine/scene/prepare.h"
#include "haptics/build/build_program.h"
#include "haptics/device/device_settings.h"

namespace catena::app::tuning {

namespace {

constexpr double kSpeed_m_per_s = 0.15;
constexpr double kReach_m = 0.1;  // reach of a device whose scene states no workspace
constexpr double kTau = 2 * std::numbers::pi;

/// Offset of a tremor and a slow drift next to the path, within `reach`.
Vec3 beside(double t, double reach) {
  return reach * Vec3(std::sin(kTau * 1.3 * t), std::sin(kTau * 1.7 * t + 1), std::cos(kTau * 1.1 * t));
}

/// First point at which a straight path from outside the domain to its center crosses the level, and the gradient there.
std::optional<std::pair<Vec3, Vec3>> first_crossing(const field::ScalarField& s, double level) {
  const Bounds box = s.world_bounds();
  field::Cursor cursor;
  for (int way = 0; way < 6; ++way) {
    Vec3 from = box.center();
    from[way / 2] = way % 2 ? box.hi[way / 2] : box.lo[way / 2];
    double last = 0;
    for (int k = 1; k < 512; ++k) {
      const Vec3 p = from + (k / 512.0) * (box.center() - from);
      const field::ScalarSample here = s.sample(p, cursor);
      if (!here.inside) continue;
      const double now = here.value - level;
      if (((last < 0 && now >= 0) || (last > 0 && now <= 0)) && max_abs(here.gradient) > 0) return std::pair{p, here.gradient};
      last = now;
    }
  }
  return std::nullopt;
}

}  // namespace

double probe_speed(const scene::Scene& scene) { return kSpeed_m_per_s / scene.workspace.meters_per_unit; }

field::AnyField find_link_field(scene::Scene& scene, const json::Node& link) {
  const json::Node* name = link.find("field");
  if (name == nullptr || name->kind != json::Kind::string) return {};
  auto field = scene::resolve_field(scene, name->string, *name);
  return field ? std::move(*field) : field::AnyField{};
}

std::optional<ProbeMotion> motion_along_streamline(scene::Scene& scene, const NamedLink& link, double seconds) {
  const json::Node* kind = link.node.find("kind");
  const auto seed = json::get_optional_vec3(link.node, "seed");
  if (!seed || !*seed) return std::nullopt;
  const field::VectorFieldPtr field = find_link_field(scene, link.node).vector;
  if (!field) return std::nullopt;
  const double length = field->domain_length(), speed = probe_speed(scene);
  const bool line = kind != nullptr && kind->string == "line";
  const auto traced = flow::trace({field.get(), line, 0}, **seed, {.length = std::min(0.5 * speed * seconds, length)});
  if (!traced) return std::nullopt;
  const flow::CurvePtr curve = *traced;
  const double lo = curve->knots().front().s, span = curve->knots().back().s - lo;
  const double reach = std::min(0.005 / scene.workspace.meters_per_unit, 0.01 * length);
  if (!(span > 0)) return std::nullopt;
  ProbeMotion motion;
  motion.seconds = seconds;
  motion.position_at = [=](double t) {
    // from the seed to one end and back to the other
    const double u = std::fmod(speed * t - lo, 2 * span);
    return curve->position(lo + (u <= span ? u : 2 * span - u)) + beside(t, reach);
  };
  motion.description = "along the streamline of \"" + link.name + "\" at 0.15 m/s, up to 5 mm away from the streamline";
  return motion;
}

std::optional<ProbeMotion> motion_through_surface(scene::Scene& scene, const NamedLink& link, double seconds) {
  const json::Node *level = link.node.find("level"), *side = link.node.find("free");
  if (level == nullptr || level->kind != json::Kind::number) return std::nullopt;
  const field::ScalarFieldPtr field = find_link_field(scene, link.node).scalar;
  if (!field) return std::nullopt;
  const field::ScalarField& s = *field;
  const auto met = first_crossing(s, level->number);
  if (!met) return std::nullopt;
  // n points to the free side
  const Vec3 p = met->first, n = (side != nullptr && side->string == "below" ? -1.0 : 1.0) * direction(met->second);
  const Vec3 a = direction(cross(n, std::fabs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0))), b = cross(n, a);
  const json::Node* release = link.node.find("release");
  double deep = std::min(0.01 / scene.workspace.meters_per_unit, 0.03 * s.domain_length());
  if (release != nullptr && release->kind == json::Kind::number) deep = std::min(deep, 0.5 * release->number);
  const double wide = std::min(0.02 / scene.workspace.meters_per_unit, 0.05 * s.domain_length());
  ProbeMotion motion;
  motion.seconds = seconds;
  motion.position_at = [=](double t) {
    return p + deep * std::cos(kTau * 1.5 * t) * n + wide * (std::sin(kTau * 0.5 * t) * a + std::sin(kTau * 0.37 * t) * b);
  };
  motion.description =
      "through the surface of \"" + link.name + "\" and back, three times in two seconds, and at the same time along the surface";
  return motion;
}

const Effort& select_effort(std::string_view name) {
  static constexpr Effort kQuick{"quick", 1.5, 8, 1, 256, 192, 110}, kDefault{"default", 6, 30, 2, 400, 300, 500},
      kThorough{"thorough", 20, 120, 4, 640, 480, 1100};
  return name == kQuick.name ? kQuick : name == kThorough.name ? kThorough : kDefault;
}

Effort reduce_if_late(const Effort& full, double elapsed_s, double done) {
  constexpr double kMinimum = 0.05;
  const double left_s = full.total_s - elapsed_s, wanted_s = full.total_s * (1 - done);
  const double share = left_s >= wanted_s ? 1 : std::fmax(kMinimum, left_s / wanted_s);
  Effort effort = full;
  effort.haptics_s *= share;
  effort.rendering_s *= share;
  return effort;
}

std::vector<haptics::ProbeSample> ProbeMotion::samples(double rate_hz) const {
  std::vector<haptics::ProbeSample> all;
  const auto count = static_cast<std::size_t>(seconds * rate_hz);
  all.reserve(count + 1);
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    all.push_back({t, position_at(t), buttons_at ? buttons_at(t) : 0});
  }
  return all;
}

std::vector<NamedLink> find_links(const scene::Scene& scene, const std::string& type) {
  std::vector<NamedLink> all;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (link.type == type) all.push_back({link.name, link.node});
  });
  return all;
}

Result<ProbeMotion> make_probe_motion(scene::Scene& scene, const std::string& probe_csv, double seconds) {
  ProbeMotion motion;
  if (!probe_csv.empty()) {
    CATENA_TRY(const ProbePath path, read_probe_samples(probe_csv));
    const double begin = path.front().t_s;
    motion.seconds = std::min(path.back().t_s - begin, 4 * seconds);
    const auto before = [path, begin](double t) {
      const auto after = std::upper_bound(path.begin(), path.end(), begin + t, [](double at, const auto& row) { return at < row.t_s; });
      return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - path.begin() - 1));
    };
    motion.buttons_at = [path, before](double t) { return path[before(t)].buttons; };
    motion.position_at = [path, begin, before](double t) {
      const std::size_t k = before(t);
      if (k + 1 >= path.size()) return path.back().position;
      const double f = std::max(0.0, (begin + t - path[k].t_s) / (path[k + 1].t_s - path[k].t_s));
      return path[k].position + f * (path[k + 1].position - path[k].position);
    };
    motion.description = "along the path given by --probe";
    return motion;
  }
  for (const NamedLink& link : find_links(scene, "streamline"))
    if (auto found = motion_along_streamline(scene, link, seconds)) return *found;
  for (const NamedLink& link : find_links(scene, "isosurface"))
    if (auto found = motion_through_surface(scene, link, seconds)) return *found;
  const Vec3 first = initial_probe_position(scene, scene::scene_bounds(scene));
  const double radius = 0.02 / scene.workspace.meters_per_unit;
  motion.position_at = [=](double t) { return first + beside(0.5 * t, radius); };
  motion.description = "on a loop of 4 cm about the first position of the probe";
  motion.seconds = seconds;
  return motion;
}

Outcome add_haptics(Workload& subject, const std::string& probe_csv) {
  if (subject.scene.entities.count<scene::Link>() == 0) {
    subject.skipped.emplace_back("Haptics: the scene has no chain.");
    return Done{};
  }
  if (subject.scene.device) {
    CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*subject.scene.device, subject.scene.path));
    subject.rate_hz = settings.rate_hz;
  }
  fit_workspace(subject.scene, scene::scene_bounds(subject.scene), kReach_m);
  CATENA_TRY(subject.program, haptics::build_program(subject.scene));
  CATENA_TRY(subject.motion, make_probe_motion(subject.scene, probe_csv, subject.effort.motion_s));
  return Done{};
}

}  // namespace catena::app::tuning
