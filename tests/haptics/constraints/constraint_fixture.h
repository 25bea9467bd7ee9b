// SPDX-License-Identifier: MIT
/// Helpers of the constraint tests: fields by name, a constraint from JSON text, a link driven tick by tick.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics::tests {

using ConstraintPtr = std::shared_ptr<const Constraint>;

inline field::ScalarFieldPtr analytic_field(const std::string& name, double scale = 1) {
  auto made = field::make_analytic(name, {.scale = scale, .part = {}});
  CATENA_ASSERT(static_cast<bool>(made));
  return made->scalar;
}

inline field::ScalarFieldPtr sampled_field(const std::string& name, int resolution, double box = 2) {
  return field::sample_on_grid(*analytic_field(name), resolution, -box, box);
}

/// A grid from a function of the world position.
template <class F>
std::shared_ptr<const field::ScalarGrid> sample_scalar_grid(const field::Mapping& mapping, const field::Index3& size, const F& f,
                                                            const std::vector<std::uint8_t>& valid = {}) {
  std::vector<float> values;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) values.push_back(static_cast<float>(f(mapping.world_from_index(Vec3(x, y, z)))));
  return field::make_scalar_grid("made", mapping, size, values, valid);
}

/// Looks a name up for a BuildContext; the error has the line of the name.
template <class T>
auto finder(const std::map<std::string, T>& named, const std::string& kind) {
  return [&named, kind](const json::Node& where, const std::string& name) -> Result<T> {
    const auto it = named.find(name);
    if (it == named.end()) return json::error_at(where, "no " + kind + " " + name);
    return it->second;
  };
}

struct Fields {
  std::map<std::string, field::AnyField> named;
  std::map<std::string, mesh::MeshPtr> meshes;
  std::map<std::string, curves::CurveSetPtr> curves;
  std::map<std::string, curves::PointSetPtr> points;
  double proxy_tolerance = BuildContext().proxy_tolerance;
  mutable flow::CurvePtr last_curve{};  ///< the last curve traced for a link

  BuildContext context() const {
    BuildContext c;
    c.proxy_tolerance = proxy_tolerance;
    c.field = finder(named, "field");
    c.mesh = finder(meshes, "mesh");
    c.points = finder(points, "points");
    c.curves = finder(curves, "curves");
    c.curve = [this](const json::Node& where, const std::string&, const flow::Flow& flow, const Vec3& seed) -> Result<flow::CurvePtr> {
      auto curve = flow::trace(flow, seed);
      if (!curve) return json::error_at(where, curve.error().message);
      return last_curve = *curve;
    };
    c.pathline = [this](const json::Node& where, const std::string& name, const PathlineSpec& spec) -> Result<flow::CurvePtr> {
      auto curve = flow::trace({named.at(name).vector.get(), false, 0}, spec.seed);  // the path in a steady field
      if (!curve) return json::error_at(where, curve.error().message);
      return last_curve = *curve;
    };
    return c;
  }
};

inline Fields scalars(std::initializer_list<std::pair<const std::string, field::ScalarFieldPtr>> named) {
  Fields fields;
  for (const auto& [name, scalar] : named) fields.named[name].scalar = scalar;
  return fields;
}

/// Shortest text that reads back to the same number or vector.
inline std::string to_json(double v) { return fmt::format("{}", v); }
inline std::string to_json(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

inline Result<ConstraintPtr> try_build(const std::string& text, const Fields& fields = {}) {
  auto node = json::parse(text, "scene.json");
  if (!node) return node.error();
  return build_constraint(*node, fields.context());
}

inline ConstraintPtr build(const std::string& text, const Fields& fields = {}) {
  auto made = try_build(text, fields);
  if (!made) {
    ADD_FAILURE() << made.error().message << "\n" << text;
    return nullptr;
  }
  return *made;
}

/// The link is refused, with a message of one line that has the place and these parts.
inline void expect_refused(const std::string& text, int line, std::initializer_list<const char*> parts, const Fields& fields = {}) {
  const auto made = try_build(text, fields);
  ASSERT_FALSE(made) << text;
  const std::string& message = made.error().message;
  EXPECT_TRUE(message.starts_with(fmt::format("scene.json:{}:", line))) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

inline ConstraintPtr isosurface(field::ScalarFieldPtr f, double level, const std::string& more = "") {
  return build(R"({"name": "a", "type": "isosurface", "field": "f", "level": )" + to_json(level) + more + "}",
               scalars({{"f", std::move(f)}}));
}

/// The closest point of the segment a..b in extended precision.
inline Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& x) {
  long double up = 0, down = 0;
  for (int i = 0; i < 3; ++i) {
    const long double d = static_cast<long double>(b[i]) - a[i];
    up += (static_cast<long double>(x[i]) - a[i]) * d;
    down += d * d;
  }
  const long double t = std::clamp(up / down, 0.0L, 1.0L);
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = static_cast<double>(a[i] + t * (static_cast<long double>(b[i]) - a[i]));
  return p;
}

/// Error of a proxy relative to the closest point on a level, by the field's own samples.
struct SurfaceCheck {
  double off_level, tangential;  ///< distance from the level and tangential residual, as fractions of L
};

inline SurfaceCheck check_on_surface(const field::ScalarField& f, double level, const Vec3& probe, const Vec3& proxy) {
  field::Cursor cursor;
  const auto s = f.sample(proxy, cursor);
  const Vec3 n = direction(s.gradient), e = probe - proxy;
  return {std::fabs(s.value - level) / norm(s.gradient) / f.domain_length(), norm(e - n * dot(n, e)) / f.domain_length()};
}

/// A grid of the cube -2..2 from a function of the world position, with `nodes` nodes per axis.
template <class F>
std::shared_ptr<const field::ScalarGrid> cube_grid(int nodes, const F& f, const std::vector<std::uint8_t>& valid = {}) {
  return sample_scalar_grid(field::Mapping::from_linear(Mat3(4.0 / (nodes - 1)), Vec3(-2.0)), {nodes, nodes, nodes}, f, valid);
}

/// One link, driven as in the tick.
struct Rig {
  explicit Rig(ConstraintPtr c) : constraint(std::move(c)) {}
  const LinkState& tick(const Vec3& probe) {
    state.begin_tick();
    if (!state.started) {
      state.switched_on = state.started = true;
      constraint->start(probe, state, scratch);
    }
    constraint->advance(probe, state, scratch);
    return state;
  }
  /// Holds the probe still for up to `more` ticks until the proxy has arrived. True if that took more than one tick.
  bool arrive(const Vec3& probe, int more = 3) {
    if (tick(probe).status != LinkStatus::budget) return false;
    for (int k = 0; k < more && state.status == LinkStatus::budget; ++k) tick(probe);
    return true;
  }
  ConstraintPtr constraint;
  LinkState state;
  LinkScratch scratch;
};

constexpr LinkStatus kOk = LinkStatus::ok, kFree = LinkStatus::free, kReleased = LinkStatus::released;

/// A probe, and what is expected after its tick: the status, the proxy bit for bit.
struct Step {
  Vec3 probe;
  std::optional<LinkStatus> status{};
  Vec3 proxy = Vec3(std::nan(""));  ///< NaN: any
};
inline void expect_steps(Rig& rig, std::span<const Step> steps) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    rig.tick(steps[i].probe);
    EXPECT_EQ(rig.state.status, steps[i].status.value_or(rig.state.status)) << "step " << i;
    EXPECT_TRUE(!is_finite(steps[i].proxy) || bitwise_equal(rig.state.proxy, steps[i].proxy)) << "step " << i;
  }
}
inline void expect_steps(Rig& rig, std::initializer_list<Step> steps) { expect_steps(rig, std::span(steps.begin(), steps.size())); }
template <class Steps = std::initializer_list<Step>>
void expect_steps(const std::string& text, const Steps& steps) {
  Rig rig(build(text));
  expect_steps(rig, steps);
}

/// Along `path(0)`, ..., `path(count)` no step of the proxy is longer than `factor` times the probe's plus `slack`.
template <class Path>
void expect_no_jumps(Rig& rig, int count, const Path& path, double factor, double slack = 0) {
  Vec3 last = rig.tick(path(0)).proxy;
  for (int i = 1; i <= count; ++i) {
    const Vec3 proxy = rig.tick(path(i)).proxy;
    ASSERT_LE(norm(proxy - last), norm(path(i) - path(i - 1)) * factor + slack) << i;
    last = proxy;
  }
}

inline void expect_primitive(Rig& rig, const Vec3& at, Primitive::Kind kind, const Vec3& origin, const Vec3& axis = Vec3(0.0)) {
  Primitive primitive;
  ASSERT_TRUE(rig.constraint->primitive(at, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, kind);
  EXPECT_TRUE(bitwise_equal(primitive.origin, origin));
  EXPECT_EQ(primitive.axis, axis);
}

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  Vec3 box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 unit() {
    while (true) {
      const Vec3 v = box(1);
      if (dot(v, v) < 1 && dot(v, v) > 1e-4) return direction(v);
    }
  }
};

/// Quantiles of a sample.
struct Quantiles {
  std::vector<int> values;
  void add(int v) { values.push_back(v); }
  int at_quantile(double part) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
};

/// Errors of many proxies on a level, as fractions of L.
struct SurfaceTally {
  int runs = 0, bad = 0;
  double worst_off = 0, worst_tangential = 0;
  Quantiles evaluations;
  void add(const LinkState& state, bool is_bad, double off, double tangential) {
    ++runs;
    bad += is_bad;
    worst_off = std::max(worst_off, off);
    worst_tangential = std::max(worst_tangential, tangential);
    evaluations.add(state.evaluations);
    EXPECT_LE(state.evaluations, kMaxEvaluations);
    EXPECT_LE(state.work(), kMaxWork);
  }
  std::string text() {
    return fmt::format("{} of {} bad; off level {:.2g} L, tangential {:.2g} L; evaluations p50 {} p99 {} max {}", bad, runs, worst_off,
                       worst_tangential, evaluations.at_quantile(0.5), evaluations.at_quantile(0.99), evaluations.at_quantile(1));
  }
};

/// A hand that wanders at `speed` units a tick within a ball; `turn`: its change of velocity.
struct Wanderer {
  Random random;
  double speed, turn, radius;
  Vec3 probe, velocity = random.unit() * speed;
  const Vec3& step() {
    velocity = direction(velocity + random.unit() * turn) * speed;
    if (norm(probe + velocity) > radius) velocity = -velocity;
    return probe += velocity;
  }
};

}  // namespace catena::haptics::tests
