// SPDX-License-Identifier: MIT
#include "engine/field/derived/derived_formula.h"

#include <functional>
#include <limits>
#include <utility>

namespace catena::field {
namespace {

constexpr double kStep = 1e-3;  // world units

/// Returns the derivative along an axis of f(position), by differences of sixth order.
template <class F>
auto derivative(const F& f, const Vec3& at, int axis) {
  const auto difference = [&](int k) {
    Vec3 high = at, low = at;
    high[axis] += k * kStep;
    low[axis] -= k * kStep;
    return (f(high) - f(low)) * (1 / (high[axis] - low[axis]));
  };
  return difference(1) * 1.5 - difference(2) * 0.6 + difference(3) * 0.1;
}

ScalarJet jet_at(const ScalarField& field, int derivatives, const Vec3& at) noexcept {
  Cursor cursor;
  const ScalarSample sample = field.sample(at, cursor);
  ScalarJet jet{sample.value, sample.gradient};
  if (derivatives < 2) return jet;
  for (int j = 0; j < 3; ++j) jet.hessian[j] = derivative([&](const Vec3& p) { return field.sample(p, cursor).gradient; }, at, j);
  jet.hessian = 0.5 * (jet.hessian + transpose(jet.hessian));
  return jet;
}

VectorJet jet_at(const VectorField& field, int derivatives, const Vec3& at) noexcept {
  Cursor cursor;
  VectorJet jet;
  const auto value = [&](const Vec3& p) { return field.sample(p, cursor).value; };
  jet.value = value(at);
  for (int j = 0; j < 3 && derivatives == 1; ++j) jet.jacobian[j] = derivative(value, at, j);
  for (int j = 0; j < 3 && derivatives == 2; ++j)
    jet.laplacian = jet.laplacian + derivative([&](const Vec3& p) { return derivative(value, p, j); }, at, j);
  return jet;
}

using Evaluate = std::function<Vec3(const Vec3& world)>;

class ScalarOfFormula final : public ScalarField {
 public:
  ScalarOfFormula(const AnyField& of, Evaluate evaluate, const std::string& name) : of_(of), evaluate_(std::move(evaluate)) {
    set_domain(name, of.get()->mapping(), of.get()->index_box());
  }
  ScalarSample sample(const Vec3& world, Cursor&) const noexcept override {
    if (!is_finite(world)) return {};
    const auto value = [&](const Vec3& p) { return evaluate_(p).x; };
    ScalarSample sample{value(world)};
    for (int a = 0; a < 3; ++a) sample.gradient[a] = derivative(value, world, a);
    if (!std::isfinite(sample.value) || !is_finite(sample.gradient)) return {};
    Cursor cursor;
    sample.inside = of_.scalar ? of_.scalar->sample(world, cursor).inside : of_.vector->sample(world, cursor).inside;
    return sample;
  }
  ScalarSample sample_value(const Vec3& world, Cursor& cursor) const noexcept override {
    if (!is_finite(world)) return {};
    const double value = evaluate_(world).x;
    if (!std::isfinite(value)) return {};
    return {value, Vec3(0.0), of_.scalar ? of_.scalar->sample_value(world, cursor).inside : of_.vector->sample(world, cursor).inside};
  }
  double min_value() const noexcept override { return -std::numeric_limits<double>::infinity(); }
  double max_value() const noexcept override { return std::numeric_limits<double>::infinity(); }

 private:
  AnyField of_;
  Evaluate evaluate_;
};

class VectorOfFormula final : public VectorField {
 public:
  VectorOfFormula(const AnyField& of, Evaluate evaluate, const std::string& name) : of_(of), evaluate_(std::move(evaluate)) {
    set_domain(name, of.get()->mapping(), of.get()->index_box());
  }
  VectorSample sample(const Vec3& world, Cursor&) const noexcept override {
    if (!is_finite(world)) return {};
    const Vec3 value = evaluate_(world);
    if (!is_finite(value)) return {};
    Cursor cursor;
    return {value, of_.scalar ? of_.scalar->sample(world, cursor).inside : of_.vector->sample(world, cursor).inside};
  }

 private:
  AnyField of_;
  Evaluate evaluate_;
};

}  // namespace

Result<AnyField> derive_formula(const AnyField& field, Quantity quantity, bool is_vector, const std::string& name) {
  const int derivatives = info_of(quantity).derivatives;
  Evaluate evaluate_at;
  if (field.scalar)
    evaluate_at = [of = field.scalar, quantity, derivatives](const Vec3& p) { return evaluate(quantity, jet_at(*of, derivatives, p)); };
  else
    evaluate_at = [of = field.vector, quantity, derivatives](const Vec3& p) { return evaluate(quantity, jet_at(*of, derivatives, p)); };
  if (is_vector) return AnyField{nullptr, std::make_shared<VectorOfFormula>(field, std::move(evaluate_at), name)};
  return AnyField{std::make_shared<ScalarOfFormula>(field, std::move(evaluate_at), name), nullptr};
}

Result<AnyField> component_of_formula(const VectorFieldPtr& field, int component, const std::string& name) {
  Evaluate evaluate_at = [field, component](const Vec3& p) {
    Cursor cursor;
    return Vec3(field->sample(p, cursor).value[component]);
  };
  return AnyField{std::make_shared<ScalarOfFormula>(AnyField{nullptr, field}, std::move(evaluate_at), name), nullptr};
}

}  // namespace catena::field
