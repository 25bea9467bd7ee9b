// SPDX-License-Identifier: MIT
// Acceptance tests of the chain of figure 3(c) of the paper, and of its invariance under the scale of a field and under bad values.
#include <limits>

#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/engine/geometry/flow/advection_reference.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::acceptance::chain_acceptance_test {

using catena::test::analytic_vector;
using catena::test::lambda_field;
using flow::Method;
using haptics::bitwise_equal;
using haptics::tests::Random;
using haptics::tests::Rig;

constexpr double kL = 4, kLimit = 0.05;

using scene::to_json;

/// State of the chain curve -> penetrable surface in the tick of the surface's release.
struct Release {
  double depth = 0;        ///< depth of the curve's proxy below the surface
  double travel = 0;       ///< step of the curve's proxy in that tick
  double off_curve = 0;    ///< maximum distance of the curve's proxy from the closed form over all ticks
  double off_surface = 0;  ///< maximum distance of the surface's proxy from the level while held
  double lag = 0;          ///< maximum distance between the surface's proxy and the closest surface point of the curve's proxy
  bool let_go = false;
  bool early = false;
};

/// Drives the probe along `path(s)` (with offset `aside`) until the surface's release. `on_curve`: distance from the closed form;
/// `foot`: the closest point of the surface; the free side is `height` > 0.
template <class Path, class OnCurve, class Height, class Foot>
Release drive(ChainRig& chain, const Path& path, const OnCurve& on_curve, const Height& height, const Foot& foot, double s, double step,
              const Vec3& aside) {
  Release out;
  Vec3 last(0.0);
  for (int i = 0; i < 20000 && !out.let_go; ++i, s += step) {
    chain.step_to(path(s) + aside);
    const Vec3 curve = chain.proxy(0), surface = chain.proxy(1);
    out.off_curve = std::max(out.off_curve, on_curve(curve));
    out.travel = norm(curve - last);
    last = curve;
    out.let_go = chain.status(1) == LinkStatus::released;
    out.depth = -height(curve);
    if (out.let_go || height(curve) >= 0) {
      EXPECT_TRUE(bitwise_equal(surface, curve));
      continue;
    }
    out.early = out.early || out.depth > kLimit;
    out.off_surface = std::max(out.off_surface, std::fabs(height(surface)));
    out.lag = std::max(out.lag, norm(surface - foot(curve)));
  }
  return out;
}

void expect_release(const Release& r, const std::string& who, double curve_goal) {
  record_result("depth of release, " + who, r.depth);
  record_results("residuals / L: ", {{"curve", r.off_curve / kL}, {"surface", r.off_surface / kL}});
  EXPECT_TRUE(r.let_go) << who;
  EXPECT_FALSE(r.early) << who << ": held deeper than its limit";
  EXPECT_GE(r.depth, kLimit * (1 - 1e-9)) << who;
  EXPECT_LE(r.depth, kLimit + r.travel) << who;
  EXPECT_LE(r.off_curve, curve_goal * kL) << who;
  EXPECT_LE(r.off_surface, 1e-11 * kL) << who;
  EXPECT_LE(r.lag, 1e-6 * kL) << who;
}

/// A scene of a straight streamline through `seed`, and a surface of the field "f".
std::string along(const Vec3& way, const Vec3& seed, const std::string& f, const std::string& more, const std::string& surface) {
  return R"({"fields": {"v": {"analytic": "uniform", "direction": )" + to_json(way) + R"(}, "f": )" + f +
         R"(}, "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": )" + to_json(seed) + more + "}, " + surface + "]}";
}

TEST(StreamlineIntoSurface, AStraightCurveIntoAPlane) {
  for (const std::string surface :
       {R"({"name": "s", "type": "isosurface", "field": "f", "level": 0, "free": "above", "release": 0.05})",
        R"({"name": "s", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "release": 0.05})"})
    for (const char* follow : {"selected", "online"})
      for (const double degrees : {20.0, 30.0, 45.0, 60.0, 75.0, 90.0}) {
        const double a = degrees * M_PI / 180;
        const Vec3 way = direction(Vec3(0.8 * std::cos(a), 0.6 * std::cos(a), -std::sin(a)));
        ChainRig chain(
            make_program(along(way, -0.3 * way, R"({"analytic": "plane"})", std::string(R"(, "follow": ")") + follow + '"', surface)));
        const Release r = drive(
            chain, [&](double s) { return s * way; }, [&](const Vec3& p) { return norm(p - way * dot(p, way)); },
            [](const Vec3& p) { return p.z; }, [](const Vec3& p) { return Vec3(p.x, p.y, 0); }, -0.2, 1e-4, Vec3(0.0));
        const std::string who = std::string(follow) + ", " + to_json(degrees) + " degrees";
        expect_release(r, who, 1e-11);
        EXPECT_NEAR(r.depth, kLimit, 1e-4) << who;
      }
}

TEST(StreamlineIntoSurface, AStraightCurveIntoASphereAndATorus) {
  struct Body {
    const char* name;
    double level;
    double (*height)(const Vec3&);
    Vec3 (*foot)(const Vec3&);
  };
  const Body bodies[] = {
      {"sphere", 1, [](const Vec3& p) { return norm(p) - 1; }, [](const Vec3& p) { return direction(p); }},
      {"torus", 0.4, [](const Vec3& p) { return norm(p - direction(Vec3(p.x, p.y, 0))) - 0.4; },
       [](const Vec3& p) {
         const Vec3 ring = direction(Vec3(p.x, p.y, 0));
         return ring + 0.4 * direction(p - ring);
       }},
  };
  for (const Body& body : bodies)
    for (const double degrees : {20.0, 45.0, 90.0}) {
      if (body.level < 1 && degrees < 30) continue;  // such a chord of the tube is shallower than the limit
      // enters the body at (1, 0, 0) (the torus at (1.4, 0, 0)), at the angle to its tangent plane
      const double a = degrees * M_PI / 180, x0 = body.level == 1 ? 1 : 1.4;
      const Vec3 way(-std::sin(a), 0.6 * std::cos(a), 0.8 * std::cos(a)), hit(x0, 0, 0), seed = hit - 0.5 * way;
      ChainRig chain(make_program(along(way, seed, std::string(R"({"analytic": ")") + body.name + "\"}", "",
                                        R"({"name": "s", "type": "isosurface", "field": "f", "level": )" + to_json(body.level) +
                                            R"(, "free": "above", "release": 0.05})")));
      const Release r = drive(
          chain, [&](double s) { return hit + s * way; }, [&](const Vec3& p) { return norm(p - hit - way * dot(p - hit, way)); },
          body.height, body.foot, -0.3, 1e-4, Vec3(0.0));
      expect_release(r, std::string(body.name) + ", " + to_json(degrees) + " degrees", 1e-11);
    }
}

TEST(StreamlineIntoSurface, ACurvedLineIntoAPlane) {
  // a circle of radius 0.8 tilted about x, which crosses z = 0 at the tilt angle
  for (const double degrees : {20.0, 35.0, 50.0, 70.0, 90.0}) {
    const double a = degrees * M_PI / 180;
    const Vec3 e1(1, 0, 0), e2(0, std::cos(a), std::sin(a)), axis = cross(e1, e2);
    const auto field = lambda_field([=](const Vec3& p) { return dot(p, e1) * e2 - dot(p, e2) * e1; });
    const auto on = [&](double s) { return 0.8 * (std::cos(s / 0.8) * e1 + std::sin(s / 0.8) * e2); };
    const auto off = [&](const Vec3& p) {
      const double u = dot(p, e1), v = dot(p, e2), w = dot(p, axis);
      return norm(Vec3(std::sqrt(u * u + v * v) - 0.8, w, 0));
    };
    for (const char* follow : {"selected", "online"}) {
      ChainRig chain(
          make_program({streamline(field, on(0.5), std::string(R"(, "follow": ")") + follow + '"'),
                        haptics::tests::isosurface(haptics::tests::analytic_field("plane"), 0, R"(, "free": "above", "release": 0.05)")}));
      const Release r = drive(
          chain, on, off, [](const Vec3& p) { return p.z; }, [](const Vec3& p) { return Vec3(p.x, p.y, 0); }, 0.5, -1e-4, 0.03 * axis);
      // a selected curve is a cached curve: error 1e-11 L between the knots
      expect_release(r, std::string("curved, ") + follow + ", " + to_json(degrees) + " degrees", 1.1e-11);
    }
  }
}

constexpr double kScales[] = {1e-300, 1e-200, 1e-100, 1e-30, 1e-10, 3.0, 1e10, 1e30, 1e100, 1e200, 1e300};

TEST(FieldScaleAndBadValues, StreamlineProxiesAreInvariantUnderScalingOfTheField) {
  for (const char* name : {"circle", "hill", "abc", "helix", "saddle"}) {
    double worst = 0, tangent = 0;
    for (const char* follow : {"selected", "online"})
      for (const double scale : kScales) {
        const auto chain_at = [&](double factor) {
          return ChainRig(
              make_program({streamline(analytic_vector(name, factor), {0.5, 0.2, 0.1}, std::string(R"(, "follow": ")") + follow + '"')}));
        };
        ChainRig one = chain_at(1), other = chain_at(scale);
        Random random(11);
        Vec3 probe(0.5, 0.2, 0.1);
        for (int i = 0; i < 300; ++i) {
          probe += 0.004 * random.unit();
          one.step_to(probe);
          other.step_to(probe);
          ASSERT_EQ(one.status(), other.status()) << name << " x " << scale << " tick " << i;
          worst = std::max(worst, norm(one.proxy() - other.proxy()));
        }
        field::Cursor cursor;
        const auto u = direction(analytic_vector(name, scale)->sample(probe, cursor).value);
        tangent = std::max(tangent, norm(u - direction(analytic_vector(name)->sample(probe, cursor).value)));
      }
    expect_at_most(std::string(name) + ": proxies apart, scales 1e-300 ... 1e300", worst, 1e-9);
    EXPECT_LE(tangent, 1e-14) << name;
  }
}

TEST(FieldScaleAndBadValues, SurfaceProxiesAreInvariantUnderScalingOfTheField) {
  for (const auto& [name, level] :
       {std::pair{"sphere", 1.0}, std::pair{"torus", 0.4}, std::pair{"gaussian", 0.5}, std::pair{"tanh", 0.3}}) {
    double worst = 0;
    for (const double scale : kScales) {
      Rig one(haptics::tests::isosurface(haptics::tests::analytic_field(name), level));
      Rig other(haptics::tests::isosurface(haptics::tests::analytic_field(name, scale), scale * level));
      Random random(12);
      Vec3 probe(0.9, 0.2, 0.1);
      for (int i = 0; i < 400; ++i) {
        probe = i % 40 ? probe + 0.004 * random.unit() : random.box(1.5);
        one.tick(probe);
        other.tick(probe);
        ASSERT_EQ(one.state.status, other.state.status) << name << " x " << scale << " tick " << i;
        worst = std::max(worst, norm(one.state.proxy - other.state.proxy));
      }
    }
    expect_at_most(std::string(name) + ": proxies apart, scales 1e-300 ... 1e300", worst, 1e-9);
  }
}

/// A field with the value `bad` in a half-space.
field::VectorFieldPtr half_bad(double bad) {
  return lambda_field([bad](const Vec3& p) { return p.x > 0.5 ? Vec3(bad, bad, bad) : Vec3(1, 0.2 * p.y, -0.1); });
}

TEST(FieldScaleAndBadValues, InvalidValuesNeverReachTheOutput) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double far[] = {0.0, -0.0, 0.4, 0.5, 0.51, 3.0, -5.0, 5e-324, 1e-310, 1e9, -1e160, 1e300, 1.7e308, inf, -inf, nan};
  for (const double bad : {0.0, -0.0, inf, -inf, nan, 5e-324, -1e-310, 1e308, -1.7e308})
    for (const char* method : {"", R"(, "method": "linear")", R"(, "method": "euler")", R"(, "method": "rk2")", R"(, "method": "rk3")",
                               R"(, "method": "rk4")", R"(, "method": "rkf34")", R"(, "method": "dp54")", R"(, "kind": "line")"}) {
      ChainRig chain(make_program(
          {streamline(half_bad(bad), {0, 0, 0}, method),
           haptics::tests::build(R"({"name": "p", "type": "plane", "point": [0, 0, 0], "normal": [1, 1, 0], "free": "above"})")}));
      Random random(13);
      for (int i = 0; i < 2000; ++i) {
        const auto any = [&] { return i % 3 ? random.uniform(-2, 2) : far[static_cast<std::size_t>(random.uniform(0, 16))]; };
        const Vec3 probe(any(), any(), any());
        chain.step_to(probe);
        ASSERT_TRUE(is_finite(chain.proxy(0)) && is_finite(chain.proxy(1))) << bad << method << " tick " << i;
        ASSERT_TRUE(is_finite(chain.out.force_n)) << bad << method << " tick " << i;
        ASSERT_TRUE(std::isfinite(chain.out.links[0].residual));
        ASSERT_EQ(chain.status(0) == LinkStatus::bad_probe, !is_finite(probe));
      }
    }
}

TEST(FieldScaleAndBadValues, BackwardEqualsTheReversedFieldBitForBit) {
  // Eq. 4, on formulas and on a grid
  struct Pair {
    std::string name;
    field::VectorFieldPtr forward, reversed;
  };
  std::vector<Pair> pairs;
  for (const char* name : {"circle", "saddle", "hill", "abc", "helix", "rankine", "lamb-oseen", "node"})
    for (const double scale : {1.0, 1e-300, 1e300}) pairs.push_back({name, analytic_vector(name, scale), analytic_vector(name, -scale)});
  pairs.push_back(
      {"grid", field::sample_on_grid(*analytic_vector("abc"), 24, -2, 2), field::sample_on_grid(*analytic_vector("abc", -1), 24, -2, 2)});
  Random random(14);
  int runs = 0;
  for (const Pair& pair : pairs)
    for (const Method method : {Method::linear, Method::euler, Method::rk2, Method::rk3, Method::rk4, Method::rkf34, Method::dp54})
      for (int i = 0; i < 200; ++i) {
        const Vec3 p = random.box(1.9);
        field::Cursor cursor;
        const double speed = norm(pair.forward->sample(p, cursor).value);
        if (!(speed > 0)) continue;
        const double dt = random.uniform(-0.7, 0.7) / speed;
        if (!std::isfinite(dt)) continue;
        field::Cursor a, b;
        const flow::Advected one = flow::advect({pair.forward.get()}, p, -dt, method, 1e-8, a);
        const flow::Advected two = flow::advect({pair.reversed.get()}, p, dt, method, 1e-8, b);
        ASSERT_TRUE(bitwise_equal(one.displacement, two.displacement)) << pair.name << " " << flow::to_string(method);
        ASSERT_EQ(one.evaluations, two.evaluations);
        ASSERT_TRUE(is_finite(one.displacement));
        ++runs;
      }
  record_result("pairs compared", runs);
  EXPECT_GT(runs, 30000);
}

}  // namespace catena::acceptance::chain_acceptance_test
