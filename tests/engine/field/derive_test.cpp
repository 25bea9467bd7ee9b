// SPDX-License-Identifier: MIT
/// Derived fields against closed forms: orders of accuracy, oblique and mirrored grids, masks and borders, formulas, expressions.
#include "engine/field/derived/derive.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "engine/field/analytic/analytic.h"
#include "engine/field/derived/node_function.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::derive_test {

using Truth = std::function<Vec3(const Vec3&)>;
constexpr double kPi = std::numbers::pi;

// a flow with all kinds of derivatives, and what is derived from it by hand
Vec3 flow(const Vec3& p) { return {std::sin(p.y) + 0.3 * p.x * p.z, std::cos(p.z) * p.x, std::sin(p.x + p.y)}; }
Mat3 jacobian(const Vec3& p) {
  const double c = std::cos(p.x + p.y);
  return {{0.3 * p.z, std::cos(p.z), c}, {std::cos(p.y), 0, c}, {0.3 * p.x, -std::sin(p.z) * p.x, 0}};
}
Vec3 vorticity(const Vec3& p) {
  const Mat3 j = jacobian(p);
  return {j[1][2] - j[2][1], j[2][0] - j[0][2], j[0][1] - j[1][0]};
}
double q_criterion(const Vec3& p) {
  const Mat3 j = jacobian(p), s = 0.5 * (j + transpose(j)), w = 0.5 * (j - transpose(j));
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += 0.5 * (dot(w[a], w[a]) - dot(s[a], s[a]));
  return sum;
}

/// A grid of a vector function in the unit ball of radius 1.2 around the origin, `n` nodes along an axis.
AnyField grid_of(const Mapping& unit, int n, const Truth& f, const std::vector<std::uint8_t>& valid = {}) {
  Mapping mapping = unit;
  const double h = 2.0 / (n - 1);
  mapping = Mapping::from_linear(h * unit.world_from_index_linear, unit.world_from_index_linear * Vec3(-1.0));
  std::vector<float> xyz;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3 v = f(mapping.world_from_index(Vec3(x, y, z)));
        for (int c = 0; c < 3; ++c) xyz.push_back(float(v[c]));
      }
  return {nullptr, make_vector_grid("v", mapping, {n, n, n}, xyz, valid)};
}

/// Largest error of a derived field at the nodes that are `margin` nodes away from the border.
double largest_error(const AnyField& derived, int n, int margin, const Truth& truth) {
  double largest = 0;
  Cursor cursor;
  const Mapping& mapping = derived.get()->mapping();
  for (int z = margin; z < n - margin; ++z)
    for (int y = margin; y < n - margin; ++y)
      for (int x = margin; x < n - margin; ++x) {
        const Vec3 world = mapping.world_from_index(Vec3(x, y, z)), expected = truth(world);
        Vec3 value(0.0);
        if (derived.scalar)
          value.x = derived.scalar->sample(world, cursor).value;
        else
          value = derived.vector->sample(world, cursor).value;
        largest = std::max(largest, norm(value - expected));
      }
  return largest;
}

TEST(Derive, DifferencesHaveTheirOrderOnAnyGrid) {
  for (const Mapping& mapping : {Mapping{}, Mapping::from_linear(Mat3(0.8, 0.6, 0.0, -0.3, 0.4, 0.2, 0.1, 0.05, 0.9), Vec3(0.0)),
                                 Mapping::from_linear(Mat3(-1, 0, 0, 0, 0, 1, 0, 1, 0), Vec3(0.0))})
    for (const int order : {2, 4}) {
      const auto error = [&](int n, Quantity quantity, const Truth& truth, int margin) {
        return largest_error(test::value_of(derive(grid_of(mapping, n, flow), quantity, order, "d")), n, margin, truth);
      };
      const auto q = [](const Vec3& p) { return Vec3(q_criterion(p), 0, 0); };
      for (const auto& [quantity, truth] : {std::pair<Quantity, Truth>{Quantity::vorticity, vorticity}, {Quantity::q_criterion, q}}) {
        const double coarse = error(9, quantity, truth, 2), fine = error(17, quantity, truth, 4);
        EXPECT_GT(coarse / fine, order == 2 ? 3.4 : 10) << order;
        EXPECT_LT(coarse, order == 2 ? 0.05 : 0.004);
        EXPECT_LT(error(17, quantity, truth, 0), 0.05) << "one-sided at the borders, of second order";
      }
    }
}

TEST(Derive, MasksHaveNoValuesInventedAtThem) {
  constexpr int n = 17;
  std::vector<std::uint8_t> valid;
  const auto is_valid = [](int x, int y, int z) { return norm(Vec3(x, y, z) - Vec3(8.0)) < 6.6; };
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) valid.push_back(is_valid(x, y, z) ? 1 : 0);
  const Mapping mapping = Mapping::from_linear(Mat3(0.9, 0.1, 0, 0, 1, 0.2, 0, 0, 1.1), Vec3(0.0));
  const AnyField masked = grid_of(
      mapping, n,
      [&](const Vec3& p) {
        const Vec3 index = 8.0 * (inverse(mapping.world_from_index_linear) * p) + Vec3(8.0);
        return is_valid(int(std::lround(index.x)), int(std::lround(index.y)), int(std::lround(index.z))) ? flow(p) : Vec3(1e6);
      },
      valid);
  const AnyField derived = test::value_of(derive(masked, Quantity::vorticity, 2, "d"));
  Cursor cursor, other;
  test::Random random(5);
  int inside = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 p = masked.get()->mapping().world_from_index(random.in_box(Vec3(0.0), Vec3(16.0)));
    const VectorSample sample = derived.vector->sample(p, cursor);
    EXPECT_EQ(sample.inside, masked.vector->sample(p, other).inside);
    if (!sample.inside) continue;
    ++inside;
    EXPECT_LT(norm(sample.value - vorticity(p)), 0.1);  // interpolation and one-sided differences; 1e6 beside the mask
  }
  EXPECT_GT(inside, 500);
}

TEST(Derive, QuantitiesOfKnownFlows) {
  // solid rotation of angular velocity 1 about z; pure shear; expansion
  const auto value = [](const Truth& f, Quantity quantity) {
    const AnyField derived = test::value_of(derive(grid_of({}, 5, f), quantity, 2, "d"));
    Cursor cursor;
    return derived.scalar ? derived.scalar->sample(Vec3(0.2), cursor).value : derived.vector->sample(Vec3(0.2), cursor).value.z;
  };
  const Truth rotation = [](const Vec3&p) { return Vec3(-p.y, p.x, 0.5); }, shear = [](const Vec3&p) { return Vec3(p.y, 0, 0); },
              expansion = [](const Vec3&p) { return p; };
  EXPECT_NEAR(value(rotation, Quantity::vorticity), 2, 1e-6);
  EXPECT_NEAR(value(rotation, Quantity::helicity), 1, 1e-6);
  EXPECT_NEAR(value(rotation, Quantity::q_criterion), 1, 1e-6);
  EXPECT_NEAR(value(rotation, Quantity::lambda2), -1, 1e-6);
  EXPECT_NEAR(value(rotation, Quantity::swirling_strength), 1, 1e-6);
  EXPECT_NEAR(value(rotation, Quantity::strain_rate), 0, 1e-6);
  EXPECT_NEAR(value(shear, Quantity::strain_rate), 1, 1e-6);
  EXPECT_NEAR(value(shear, Quantity::swirling_strength), 0, 1e-6);
  EXPECT_NEAR(value(shear, Quantity::q_criterion), 0, 1e-6);
  EXPECT_NEAR(value(expansion, Quantity::divergence), 3, 1e-6);
  EXPECT_EQ(unit_of(Quantity::vorticity, "m/s", "m"), "1/s");
  EXPECT_EQ(unit_of(Quantity::vorticity, "m/s", "mm"), "m/s/mm");
  EXPECT_EQ(unit_of(Quantity::q_criterion, "m/s", "m"), "1/s^2");
  EXPECT_EQ(unit_of(Quantity::gradient, "K", "mm"), "K/mm");
  EXPECT_EQ(unit_of(Quantity::mean_curvature, "K", "mm"), "1/mm");
  EXPECT_EQ(unit_of(Quantity::gradient, "", "mm"), "");
}

TEST(Derive, CurvaturesOfTorusAndBall) {
  const AnyField torus = test::value_of(make_analytic("torus")), ball = test::value_of(make_analytic("sphere"));
  const auto at = [](const AnyField& field, Quantity quantity, const Vec3& p) {
    Cursor cursor;
    return test::value_of(derive(field, quantity, 2, "d")).scalar->sample(p, cursor).value;
  };
  // level 0.4 of the distance to the circle of radius 1: at its outside the curvatures are 1 / 0.4 and 1 / 1.4
  EXPECT_NEAR(at(torus, Quantity::max_curvature, {1.4, 0, 0}), 1 / 0.4, 1e-9);
  EXPECT_NEAR(at(torus, Quantity::min_curvature, {1.4, 0, 0}), 1 / 1.4, 1e-9);
  EXPECT_NEAR(at(torus, Quantity::min_curvature, {0.6, 0, 0}), -1 / 0.6, 1e-9);
  EXPECT_NEAR(at(torus, Quantity::gaussian_curvature, {1.4, 0, 0}), 1 / 0.4 / 1.4, 1e-9);
  EXPECT_NEAR(at(ball, Quantity::mean_curvature, {0.5, 0.5, 0.5}), 1 / std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(at(ball, Quantity::laplacian, {0.5, 0.5, 0.5}), 2 / std::sqrt(0.75), 1e-9);
  const auto sampled = try_sample_on_grid(ball, 65, -1, 1);
  Cursor cursor;
  EXPECT_NEAR(test::value_of(derive(*sampled, Quantity::mean_curvature, 2, "d")).scalar->sample(Vec3(0.5), cursor).value,
              1 / std::sqrt(0.75), 3e-3);
}

TEST(Derive, FormulasAreExact) {
  // an ABC flow is its own vorticity (Beltrami)
  const AnyField abc = test::value_of(make_analytic("abc")), curl = test::value_of(derive(abc, Quantity::vorticity, 2, "d"));
  const AnyField divergence = test::value_of(derive(abc, Quantity::divergence, 2, "d"));
  const AnyField component = test::value_of(derive_component(abc, 1, "y"));
  test::Random random(3);
  for (int k = 0; k < 200; ++k) {
    Cursor cursor;
    const Vec3 p = random.in_box(Vec3(-2.0), Vec3(2.0)), v = abc.vector->sample(p, cursor).value;
    EXPECT_LT(norm(curl.vector->sample(p, cursor).value - v), 1e-11);
    EXPECT_LT(std::fabs(divergence.scalar->sample(p, cursor).value), 1e-11);
    EXPECT_EQ(component.scalar->sample(p, cursor).value, v.y);
    EXPECT_NEAR(component.scalar->sample(p, cursor).gradient.x, std::sqrt(2.0) * std::cos(p.x), 1e-10);
  }
}

TEST(Derive, SmoothingIsAGaussianAndRespectsMasks) {
  // a Gaussian of variance a smoothed by one of variance b has variance a + b
  constexpr int n = 41;
  const auto gaussian = [](double r2, double variance) { return std::pow(variance, -1.5) * std::exp(-0.5 * r2 / variance); };
  const auto values = test::values_of(
      {n, n, n}, [&](int x, int y, int z) { return gaussian(dot(Vec3(x - 20, y - 20, z - 20), Vec3(x - 20, y - 20, z - 20)), 6); });
  const Mapping mapping = Mapping::from_linear(Mat3(0.5), Vec3(0.0));
  const AnyField smoothed = test::value_of(smooth({make_scalar_grid("g", mapping, {n, n, n}, values), nullptr}, 1, "s"));
  Cursor cursor;
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(smoothed.scalar->sample(0.5 * Vec3(20 + k, 20, 21), cursor).value, gaussian(k * k + 1, 6 + 4), 2e-4 * gaussian(0, 10));
  // the mean of what is valid, however wild the rest is
  std::vector<float> wild(1000, 7.0f);
  std::vector<std::uint8_t> valid(1000, 1);
  for (std::size_t i = 0; i < 1000; i += 10) wild[i] = 1e20f, valid[i] = 0;
  const AnyField even = test::value_of(smooth({make_scalar_grid("g", {}, {10, 10, 10}, wild, valid), nullptr}, 2, "s"));
  EXPECT_NEAR(even.scalar->sample(Vec3(5.0), cursor).value, 7, 1e-5);
  EXPECT_TRUE(test::fails(smooth(smoothed, 1000, "s"), "a standard deviation of 1000 is 2e+03 voxels; at most 64 voxels were expected"));
}

TEST(Derive, ExpressionsAreEvaluatedAtNodes) {
  const AnyField v = grid_of({}, 9, flow), abc = test::value_of(make_analytic("abc"));
  const std::vector<NodeVariable> variables{{"u", v, 0}, {"w", abc, 2}};
  const auto made = test::value_of(evaluate_expressions({"sqrt(u*u) + w * (x > 0 ? y : t)"}, variables, 3, {v}, "e"));
  EXPECT_LT(largest_error(made, 9, 0,
                          [&](const Vec3& p) {
                            Cursor cursor;
                            return Vec3(std::fabs(flow(p).x) + abc.vector->sample(p, cursor).value.z * (p.x > 0 ? p.y : 3), 0, 0);
                          }),
            1e-5);
  const auto vector = test::value_of(evaluate_expressions({"y", "-x", "1/x"}, {}, 0, {{}, 5, {-1, 1}}, "e"));
  EXPECT_EQ(vector.notes, std::vector<std::string>{"25 of 125 nodes have no finite value; they are left out"});
  Cursor cursor;
  EXPECT_EQ(vector.vector->sample({0.5, 0.25, 0}, cursor).value, Vec3(0.25, -0.5, 2));
  EXPECT_FALSE(vector.vector->sample({0.25, 0, 0}, cursor).inside);
  const auto fault = [](const std::string& text) {
    const ExpressionFault found = check_expression(text, {"u"});
    return found.message.empty() ? std::string() : std::to_string(found.column) + " " + found.message;
  };
  EXPECT_EQ(fault("u + max(1, x, y)"), "");
  EXPECT_EQ(fault("u <= 1 && x != 2 ? 1 : 0"), "");
  EXPECT_EQ(fault("u = 1"), "3 an assignment; an expression was expected");
  EXPECT_EQ(fault("(1, 2)"), "3 a list of values; one expression was expected");
  EXPECT_EQ(fault("1 + speed"), "5 \"speed\" is not known; one of x, y, z, t, u or a function was expected");
  for (const std::string& wrong :
       {std::string(), std::string("1 +"), std::string("sin(1, 2)"), std::string(5000, '1'), std::string("\"a\""),
        std::string(300, '(') + "1" + std::string(300, ')'), std::string("1\n"), std::string("u u")})
    EXPECT_NE(fault(wrong), "") << wrong;
}

TEST(Derive, ExpressionsOfAnyTextAreRefusedOrEvaluated) {
  const std::vector<std::string> words{"u",    "x",     "(", ")",     ",",    "+",  "-",  "*",  "/",  "^",  "?", ":",  "sin",
                                       "max(", "sqrt(", "1", "1e308", ".",    "e",  "=",  "==", "<",  "&&", "!", "\"", " ",
                                       "_pi",  "0x",    "$", "avg(",  "rint", "u_", "\\", "#",  "1e", "t",  "%"};
  test::Random random(11);
  int usable = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string text;
    for (int n = int(random.uniform(0, 12)); n >= 0; --n) text += words[std::size_t(random.uniform(0, double(words.size()) - 1e-9))];
    const ExpressionFault fault = check_expression(text, {"u"});
    if (fault.message.empty()) {
      ++usable;
      Nodes nodes{{}, 2, {-1, 1}};
      const auto made = evaluate_expressions({text}, {{"u", test::value_of(make_analytic("plane")), 0}}, 0, nodes, "e");
      EXPECT_TRUE(made || made.error().message.find("finite") != std::string::npos) << text;
    } else {
      EXPECT_TRUE(fault.column >= 1 && fault.column <= int(text.size()) + 1) << text;
    }
  }
  EXPECT_GT(usable, 100);
}

}  // namespace catena::field::derive_test
