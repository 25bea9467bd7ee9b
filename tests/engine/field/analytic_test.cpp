// SPDX-License-Identifier: MIT
#include "engine/field/analytic/analytic.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::analytic_test {

using test::Random;

Result<AnyField> made(std::string_view name, double scale = 1, std::string part = {}, const Vec3& direction = Vec3(1, 0, 0)) {
  return make_analytic(name, {.scale = scale, .direction = direction, .part = std::move(part)});
}
VectorFieldPtr vector(std::string_view name, double scale = 1) { return made(name, scale).value().vector; }
ScalarFieldPtr scalar(std::string_view name, double scale = 1, std::string part = {}) {
  return made(name, scale, std::move(part)).value().scalar;
}
Vec3 at(const VectorFieldPtr& f, const Vec3& p) {
  Cursor c;
  return f->sample(p, c).value;
}
double at(const ScalarFieldPtr& f, const Vec3& p) {
  Cursor c;
  return f->sample(p, c).value;
}

/// The divergence by central differences.
double divergence(const VectorFieldPtr& f, const Vec3& p) {
  constexpr double h = 1e-5;
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (at(f, p + test::along(a, h))[a] - at(f, p - test::along(a, h))[a]) / (2 * h);
  return sum;
}

void expect_gradient(const ScalarFieldPtr& f, const Vec3& p, double tolerance) {
  constexpr double h = 1e-6;
  Cursor c;
  const ScalarSample s = f->sample(p, c);
  EXPECT_TRUE(s.inside);
  for (int a = 0; a < 3; ++a) {
    const double difference = (at(f, p + test::along(a, h)) - at(f, p - test::along(a, h))) / (2 * h);
    EXPECT_NEAR(s.gradient[a], difference, tolerance * std::max(1.0, norm(s.gradient)))
        << f->name() << " at " << p.x << " " << p.y << " " << p.z;
  }
}

TEST(AnalyticScalars, GradientsEqualDifferences) {
  for (const char* name : {"sphere", "plane", "torus", "constant", "linear", "gaussian", "marschner-lobb", "tanh"})
    for (const double scale : {1.0, -2.5}) {
      Random random(1);
      for (int trial = 0; trial < 200; ++trial) expect_gradient(scalar(name, scale), random.in_box(Vec3(-2.0), Vec3(2.0)), 1e-5);
    }
  // The steep part of the wall.
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) expect_gradient(scalar("tanh"), random.in_box(Vec3(-2, -2, -0.1), Vec3(2, 2, 0.1)), 1e-6);
  for (const char* part : {"density", "transmural"})
    for (int trial = 0; trial < 500; ++trial)
      expect_gradient(scalar("left-ventricle", 1, part), random.in_box(Vec3(-2.0), Vec3(2.0)), 2e-4);
}

TEST(AnalyticScalars, HaveKnownValues) {
  EXPECT_EQ(at(scalar("sphere"), Vec3(3, 4, 0)), 5);
  EXPECT_EQ(at(scalar("sphere", 2), Vec3(3, 4, 0)), 10);
  EXPECT_EQ(at(scalar("plane"), Vec3(3, 4, -0.25)), -0.25);
  EXPECT_EQ(at(scalar("linear"), Vec3(1, 2, 3)), 6);
  EXPECT_EQ(at(scalar("constant", 0.75), Vec3(1, 2, 3)), 0.75);
  EXPECT_NEAR(at(scalar("torus"), Vec3(0, 1.25, 0)), 0.25, 1e-15);
  EXPECT_EQ(at(scalar("gaussian"), Vec3(0.0)), 1);
  EXPECT_NEAR(at(scalar("gaussian"), Vec3(0.5, 0, 0)), std::exp(-0.5), 1e-15);
  EXPECT_NEAR(at(scalar("tanh"), Vec3(0, 0, 0.05)), std::tanh(1.0), 1e-15);
  Cursor c;
  const ScalarSample centre = scalar("sphere")->sample(Vec3(0.0), c);
  EXPECT_TRUE(centre.inside);
  EXPECT_EQ(centre.gradient, Vec3(0.0));
}

TEST(AnalyticScalars, RangesAreValidAndFollowTheScale) {
  Random random(3);
  for (const char* name : {"sphere", "plane", "torus", "constant", "linear", "gaussian", "marschner-lobb", "tanh", "left-ventricle"})
    for (const double scale : {1.0, -3.0}) {
      const auto f = scalar(name, scale);
      EXPECT_LE(f->min_value(), f->max_value());
      for (int trial = 0; trial < 300; ++trial) {
        const double v = at(f, random.in_box(Vec3(-3.0), Vec3(3.0)));
        EXPECT_GE(v, f->min_value() - 1e-12);
        EXPECT_LE(v, f->max_value() + 1e-12);
      }
    }
  EXPECT_EQ(scalar("sphere")->min_value(), 0);
  EXPECT_TRUE(std::isinf(scalar("sphere")->max_value()));
  EXPECT_EQ(scalar("sphere", -1)->max_value(), 0);
  EXPECT_EQ(scalar("left-ventricle", 1, "transmural")->min_value(), at(scalar("left-ventricle", 1, "transmural"), Vec3(0.0)));
}

TEST(AnalyticVectors, HaveKnownValues) {
  const Vec3 p(0.3, -0.4, 0.7);
  EXPECT_EQ(at(vector("circle"), p), Vec3(0.4, 0.3, 0));
  EXPECT_EQ(at(vector("circle", 2), p), Vec3(0.8, 0.6, 0));
  EXPECT_EQ(at(vector("saddle"), p), Vec3(0.3, 0.4, 0));
  EXPECT_EQ(at(vector("node"), p), p);
  EXPECT_EQ(at(vector("helix"), p), Vec3(0.8, 0.6, 0.5));
  EXPECT_EQ(at(vector("rankine"), p), Vec3(0.4, 0.3, 0));
  EXPECT_NEAR(norm(at(vector("rankine"), Vec3(0, 2, 1)) - Vec3(-0.5, 0, 0)), 0, 1e-15);
  EXPECT_NEAR(norm(at(vector("lamb-oseen"), Vec3(2, 0, 1)) - Vec3(0, (1 - std::exp(-4.0)) / 2, 0)), 0, 1e-15);
  EXPECT_EQ(at(vector("lamb-oseen"), Vec3(0.0)), Vec3(0.0));
  EXPECT_EQ(at(vector("hill"), Vec3(0.0)), Vec3(0, 0, 1.5));
  EXPECT_NEAR(norm(at(vector("hill"), Vec3(0, 0, 1))), 0, 1e-15);
  EXPECT_NEAR(norm(at(vector("hill"), Vec3(1e6, 0, 0)) - Vec3(0, 0, -1)), 0, 1e-12);
  EXPECT_NEAR(norm(at(vector("abc"), Vec3(0.0)) - Vec3(1, std::sqrt(3.0), std::sqrt(2.0))), 0, 1e-15);
  EXPECT_EQ(at(made("uniform", 3, {}, Vec3(0, 0, -2)).value().vector, Vec3(5, 6, 7)), Vec3(0, 0, -3));
}

TEST(AnalyticVectors, FlowsAreDivergenceFree) {
  Random random(4);
  for (const char* name : {"circle", "saddle", "helix", "rankine", "lamb-oseen", "hill", "abc"})
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 p = random.in_box(Vec3(-2.0), Vec3(2.0));
      if (std::fabs(norm(p) - 1) < 1e-3 || std::fabs(norm(Vec3(p.x, p.y, 0)) - 1) < 1e-3) continue;
      EXPECT_NEAR(divergence(vector(name), p), 0, 1e-8) << name;
    }
  EXPECT_NEAR(divergence(vector("node"), Vec3(0.1)), 3, 1e-8);
}

TEST(AnalyticVectors, HillIsContinuousAcrossItsSphere) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 n = direction(random.in_box(Vec3(-1.0), Vec3(1.0)));
    EXPECT_NEAR(norm(at(vector("hill"), n * (1 - 1e-9)) - at(vector("hill"), n * (1 + 1e-9))), 0, 1e-7);
    EXPECT_NEAR(dot(at(vector("hill"), n), n), 0, 1e-12);  // the sphere is a stream surface
  }
}

TEST(AnalyticVectors, AreCoherentAsLineFields) {
  Cursor c;
  const LineSample line = vector("circle")->sample_line(Vec3(2, 0, 0), c);
  EXPECT_EQ(line.axis, Vec3(-0.0, 1, 0));
  EXPECT_EQ(line.speed, 2);
  EXPECT_EQ(line.coherence, 1);
  EXPECT_EQ(vector("circle")->sample_line(Vec3(0.0), c).coherence, 0);
}

TEST(Analytic, ReportsWhyAPositionIsOutside) {
  Cursor c;
  const AnyField fibre = made("left-ventricle", 1, "fibre").value();
  EXPECT_EQ(fibre.vector->status_outside(Vec3(1.9, 1.9, 1.9), c), SampleStatus::masked);
  EXPECT_EQ(fibre.vector->status_outside(Vec3(std::nan("")), c), SampleStatus::not_finite);
  EXPECT_EQ(vector("circle")->status_outside(Vec3(50.0), c), SampleStatus::ok) << "a formula has no box";
}

TEST(Analytic, ExtremePositionsGiveFiniteValues) {
  Cursor c;
  for (const auto name : analytic_names()) {
    const AnyField f = make_analytic(name).value();
    for (const double v : {0.0, 1e-320, 1e10, 1e154, 1e300, -1e308, std::numeric_limits<double>::infinity(), std::nan("")})
      for (const Vec3& p : {Vec3(v), Vec3(v, 0, 0), Vec3(0, 0, v), Vec3(v, -v, 1)}) {
        if (f.scalar) {
          const ScalarSample s = f.scalar->sample(p, c);
          EXPECT_TRUE(std::isfinite(s.value) && is_finite(s.gradient)) << name << " " << v;
          EXPECT_TRUE(is_finite(p) || !s.inside);
        } else {
          const VectorSample s = f.vector->sample(p, c);
          EXPECT_TRUE(is_finite(s.value)) << name << " " << v;
          EXPECT_TRUE(is_finite(p) || !s.inside);
        }
      }
  }
}

TEST(Analytic, NamesDomainsAndErrors) {
  EXPECT_EQ(analytic_names().size(), 19u);
  EXPECT_TRUE(is_analytic("lamb-oseen"));
  EXPECT_FALSE(is_analytic("Circle"));
  for (const auto name : analytic_names()) EXPECT_DOUBLE_EQ(make_analytic(name).value().get()->domain_length(), 4);
  EXPECT_EQ(analytic_parts("left-ventricle").size(), 3u);
  EXPECT_EQ(analytic_parts("circle"), std::vector<std::string_view>{"circle"});
  EXPECT_FALSE(make_analytic("spere"));
  EXPECT_FALSE(made("sphere", 0));
  EXPECT_FALSE(made("sphere", std::nan("")));
  EXPECT_FALSE(made("uniform", 1, {}, Vec3(0.0)));
  EXPECT_FALSE(made("left-ventricle", 1, "apex"));
  EXPECT_FALSE(made("sphere", 1, "fibre"));
}

TEST(LeftVentricle, FibresRotateWithDepthInTheWall) {
  const auto fibre = made("left-ventricle", 1, "fibre").value().vector;
  const auto depth = scalar("left-ventricle", 1, "transmural"), density = scalar("left-ventricle");
  Random random(6);
  Cursor c;
  int tried = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec3 p = random.in_box(Vec3(-2.0), Vec3(2.0));
    const ScalarSample t = depth->sample(p, c);
    const VectorSample f = fibre->sample(p, c);
    const double d = at(density, p);
    EXPECT_EQ(f.inside, d > 0);
    if (!f.inside) {
      EXPECT_EQ(f.value, Vec3(0.0));
      continue;
    }
    ++tried;
    const bool wall = t.value >= 0 && t.value <= 1 && p.z <= 0.8;
    EXPECT_TRUE(!wall || d == 1);
    // The direction has unit length, is tangent to the wall, and has the helix angle.
    const Vec3 around = direction(Vec3(-p.y, p.x, 0));
    Vec3 along = direction(cross(t.gradient, around));
    if (along.z < 0) along = -along;
    EXPECT_NEAR(norm(f.value), 1, 1e-12);
    EXPECT_NEAR(dot(f.value, direction(t.gradient)), 0, 1e-12);
    const double angle = std::atan2(dot(f.value, along), dot(f.value, around)) * 180 / std::numbers::pi;
    EXPECT_NEAR(angle, 60 - 120 * t.value, 1e-9);
  }
  EXPECT_GT(tried, 100);
}

std::shared_ptr<const VectorField> vortices(int seed, int dimensions, const Vec3& center = Vec3(0.0)) {
  AnalyticParameters parameters;
  parameters.seed = seed;
  parameters.dimensions = dimensions;
  parameters.center = center;
  return make_analytic("vortices", parameters).value().vector;
}

Vec3 at(const VectorField& field, const Vec3& p) {
  Cursor cursor;
  return field.sample(p, cursor).value;
}

TEST(Vortices, AreDivergenceFree) {
  catena::Random random(3);
  constexpr double h = 1e-4;
  for (const int dimensions : {2, 3})
    for (int seed = 0; seed < 20; ++seed) {
      const auto field = vortices(seed, dimensions);
      double largest = 0;
      for (int k = 0; k < 50; ++k) {
        const Vec3 p(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
        double divergence = 0;
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 d(0.0);
          d[axis] = h;
          const Vec3 slope = (at(*field, p + d) - at(*field, p - d)) / (2 * h);
          divergence += slope[axis];
          largest = std::max(largest, norm(slope));
        }
        ASSERT_NEAR(divergence, 0, 1e-5);
      }
      EXPECT_GT(largest, 0.5) << "the slopes are not small";
    }
}

TEST(Vortices, TwoDimensionalVorticesArePlanar) {
  const auto field = vortices(4, 2);
  for (const double z : {-1.0, 0.0, 3.0}) {
    EXPECT_EQ(at(*field, Vec3(0.3, -0.7, z)), at(*field, Vec3(0.3, -0.7, 0)));
    EXPECT_EQ(at(*field, Vec3(0.3, -0.7, z)).z, 0);
  }
}

TEST(Vortices, DependOnTheSeedAndTheCenter) {
  const Vec3 p(0.25, 0.5, -0.125), center(1, -2, 0.5);
  EXPECT_NE(at(*vortices(1, 3), p), at(*vortices(2, 3), p));
  EXPECT_EQ(at(*vortices(1, 3, center), p + center), at(*vortices(1, 3), p));
  EXPECT_EQ(vortices(1, 3, center)->world_bounds().center(), center);
  AnalyticParameters parameters;
  parameters.dimensions = 4;
  EXPECT_FALSE(make_analytic("vortices", parameters));
}

TEST(Vortices, AreBitIdenticalOnEveryMachine) {
  Fnv1a hash;
  for (const int dimensions : {2, 3})
    for (int seed = 0; seed < 10; ++seed)
      for (int k = 0; k < 10; ++k) {
        const Vec3 v = at(*vortices(seed, dimensions), Vec3(0.3 * k - 1.5, 0.1 * k, 1 - 0.2 * k));
        hash.add(v.x), hash.add(v.y), hash.add(v.z);
      }
  EXPECT_EQ(hash.value, 0xbcc56d44ae66cd55u) << std::hex << hash.value;
}

}  // namespace catena::field::analytic_test
