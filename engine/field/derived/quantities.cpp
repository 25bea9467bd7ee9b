// SPDX-License-Identifier: MIT
#include "engine/field/derived/quantities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/base/text.h"

namespace catena::field {
namespace {

constexpr QuantityInfo kQuantities[] = {
    {Quantity::magnitude, "magnitude", true, true, false, 0, 1, 0},
    {Quantity::gradient, "gradient", true, false, true, 1, 1, -1},
    {Quantity::divergence, "divergence", false, true, false, 1, 1, -1},
    {Quantity::vorticity, "vorticity", false, true, true, 1, 1, -1},
    {Quantity::helicity, "helicity", false, true, false, 1, 2, -1},
    {Quantity::strain_rate, "strain_rate", false, true, false, 1, 1, -1},
    {Quantity::q_criterion, "q_criterion", false, true, false, 1, 2, -2},
    {Quantity::lambda2, "lambda2", false, true, false, 1, 2, -2},
    {Quantity::swirling_strength, "swirling_strength", false, true, false, 1, 1, -1},
    {Quantity::laplacian, "laplacian", true, true, true, 2, 1, -2},
    {Quantity::max_curvature, "max_curvature", true, false, false, 2, 0, -1},
    {Quantity::min_curvature, "min_curvature", true, false, false, 2, 0, -1},
    {Quantity::mean_curvature, "mean_curvature", true, false, false, 2, 0, -1},
    {Quantity::gaussian_curvature, "gaussian_curvature", true, false, false, 2, 0, -2},
};

constexpr double kNoCurvature = std::numeric_limits<double>::quiet_NaN();

double largest_entry(const Mat3& m) {
  double largest = 0;
  for (int j = 0; j < 3; ++j) largest = std::max(largest, max_abs(m[j]));
  return largest;
}

double trace_of_square(const Mat3& m) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += m[i][j] * m[j][i];
  return sum;
}

/// Returns the middle eigenvalue of a symmetric matrix, by the trigonometric solution of its characteristic polynomial.
double middle_eigenvalue(const Mat3& m) {
  const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
  Mat3 rest = m;
  for (int i = 0; i < 3; ++i) rest[i][i] -= mean;
  const double spread = std::sqrt(trace_of_square(rest) / 6);
  if (!(spread > 0)) return mean;
  const double half = std::clamp(determinant((1 / spread) * rest) / 2, -1.0, 1.0);
  // eigenvalues: mean + 2 spread cos(angle + 2 k pi / 3), angle in [0, pi / 3]; k = 2 gives the middle one
  const double angle = std::acos(half) / 3;
  return mean + 2 * spread * std::cos(angle - 2 * std::numbers::pi / 3);
}

double lambda2(const Mat3& jacobian) {
  const Mat3 square = jacobian * jacobian;
  return middle_eigenvalue(0.5 * (square + transpose(square)));
}

/// Returns the imaginary part of the complex eigenvalues of a matrix of entries of about 1, by Cardano's formula; 0: all are real.
double imaginary_part(const Mat3& m) {
  const double trace = m[0][0] + m[1][1] + m[2][2], minors = 0.5 * (trace * trace - trace_of_square(m));
  // x^3 - trace x^2 + minors x - det = 0 becomes y^3 + p y + q = 0
  const double p = minors - trace * trace / 3, q = -2 * trace * trace * trace / 27 + trace * minors / 3 - determinant(m);
  const double discriminant = q * q / 4 + p * p * p / 27;
  if (!(discriminant > 0)) return 0;
  const double u = std::cbrt(-q / 2 - std::copysign(std::sqrt(discriminant), q)), v = u != 0 ? -p / (3 * u) : 0;
  return 0.5 * std::numbers::sqrt3 * std::fabs(u - v);
}

Vec3 curl(const Mat3& j) { return {j[1][2] - j[2][1], j[2][0] - j[0][2], j[0][1] - j[1][0]}; }

/// Sum and sum of squares of the two principal curvatures; NaN without a gradient.
struct Curvatures {
  double sum = kNoCurvature, squares = kNoCurvature;
};

Curvatures curvatures(const Vec3& gradient, const Mat3& hessian) {
  const double size = norm(gradient);
  if (!(size > 0)) return {};
  const Vec3 n = (1 / size) * gradient;
  Mat3 projected = hessian;  // P H P
  const Vec3 hn = hessian * n;
  const double nhn = dot(n, hn);
  double sum = 0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) projected[j][i] += nhn * n[i] * n[j] - n[i] * hn[j] - hn[i] * n[j];
  for (int i = 0; i < 3; ++i) sum += projected[i][i];
  return {sum / size, trace_of_square(projected) / size / size};
}

double curvature(Quantity quantity, const ScalarJet& jet) {
  const Curvatures k = curvatures(jet.gradient, jet.hessian);
  const double difference = std::sqrt(std::max(0.0, 2 * k.squares - k.sum * k.sum));
  if (quantity == Quantity::mean_curvature) return 0.5 * k.sum;
  if (quantity == Quantity::gaussian_curvature) return 0.5 * (k.sum * k.sum - k.squares);
  return 0.5 * (quantity == Quantity::max_curvature ? k.sum + difference : k.sum - difference);
}

}  // namespace

std::span<const QuantityInfo> quantities() { return kQuantities; }

const QuantityInfo& info_of(Quantity quantity) { return kQuantities[static_cast<std::size_t>(quantity)]; }

Result<Quantity> find_quantity(std::string_view name) {
  std::vector<std::string_view> names;
  for (const QuantityInfo& info : kQuantities) {
    if (info.name == name) return info.quantity;
    names.push_back(info.name);
  }
  return Error{in_quotes(name) + " is not known; one of " + join_words(names) + " was expected" + suggestion(name, names)};
}

Vec3 evaluate(Quantity quantity, const ScalarJet& jet) noexcept {
  switch (quantity) {
    case Quantity::magnitude:
      return {std::fabs(jet.value), 0, 0};
    case Quantity::gradient:
      return jet.gradient;
    case Quantity::laplacian:
      return {jet.hessian[0][0] + jet.hessian[1][1] + jet.hessian[2][2], 0, 0};
    default:
      return {curvature(quantity, jet), 0, 0};
  }
}

Vec3 evaluate(Quantity quantity, const VectorJet& jet) noexcept {
  const Mat3& j = jet.jacobian;
  switch (quantity) {
    case Quantity::magnitude:
      return {norm(jet.value), 0, 0};
    case Quantity::divergence:
      return {j[0][0] + j[1][1] + j[2][2], 0, 0};
    case Quantity::vorticity:
      return curl(j);
    case Quantity::helicity:
      return {dot(jet.value, curl(j)), 0, 0};
    case Quantity::strain_rate: {
      double sum = 0;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) sum += 0.5 * (j[a][b] + j[b][a]) * (j[a][b] + j[b][a]);
      return {std::sqrt(sum), 0, 0};
    }
    case Quantity::q_criterion:
      return {-0.5 * trace_of_square(j), 0, 0};
    case Quantity::laplacian:
      return jet.laplacian;
    default:
      break;
  }
  // scaled, so that neither squares nor cubes overflow
  const double scale = largest_entry(j);
  if (!(scale > 0)) return {scale, 0, 0};
  const Mat3 scaled = (1 / scale) * j;
  if (quantity == Quantity::lambda2) return {scale * scale * lambda2(scaled), 0, 0};
  return {scale * imaginary_part(scaled), 0, 0};
}

std::string unit_of(Quantity quantity, const std::string& value_unit, const std::string& length_unit) {
  const QuantityInfo& info = info_of(quantity);
  const auto power = [](const std::string& base, int exponent) {
    if (exponent == 1) return base;
    const bool is_word = base.find_first_of("/^ *") == std::string::npos;
    return (is_word ? base : "(" + base + ")") + "^" + std::to_string(exponent);
  };
  if (info.value_power != 0 && value_unit.empty()) return {};
  if (info.length_power == 0) return power(value_unit, info.value_power);
  if (length_unit.empty()) return {};
  if (info.value_power == 0) return "1/" + power(length_unit, -info.length_power);
  const bool cancels = value_unit.starts_with(length_unit + "/");
  const std::string ratio = cancels ? "1" + value_unit.substr(length_unit.size()) : value_unit + "/" + length_unit;
  if (info.value_power == -info.length_power) {
    if (cancels && info.value_power != 1) return "1/" + power(value_unit.substr(length_unit.size() + 1), info.value_power);
    return power(ratio, info.value_power);
  }
  if (info.value_power == 1) return value_unit + "/" + power(length_unit, -info.length_power);
  return power(value_unit, info.value_power) + "/" + power(length_unit, -info.length_power);
}

}  // namespace catena::field
