// SPDX-License-Identifier: MIT
#include "engine/field/analytic/analytic.h"

#include <fmt/format.h>

namespace catena::field {
namespace {

constexpr std::string_view kVentricle = "left-ventricle", kUniform = "uniform", kVortices = "vortices";
Box box_about(const Vec3& center) { return {center - Vec3(2.0), center + Vec3(2.0)}; }

/// Scalar field of a formula. A point is inside unless the point or the value is not finite.
class ScalarByFormula final : public ScalarField {
 public:
  ScalarByFormula(const ScalarFormula& formula, const AnalyticParameters& p) : formula_(formula), scale_(p.scale), center_(p.center) {
    set_domain(std::string(formula.name), Mapping{}, box_about(p.center));
  }
  ScalarSample sample(const Vec3& world, Cursor&) const noexcept override {
    if (!is_finite(world)) return {};
    ScalarSample s;
    s.value = scale_ * formula_.value(world - center_, s.gradient);
    s.gradient *= scale_;
    s.inside = std::isfinite(s.value) && is_finite(s.gradient);
    return s.inside ? s : ScalarSample{};
  }
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override {
    return sample(world, cursor).inside ? SampleStatus::ok : SampleStatus::not_finite;
  }
  double min_value() const noexcept override { return scale_ * (scale_ > 0 ? formula_.min : formula_.max); }
  double max_value() const noexcept override { return scale_ * (scale_ > 0 ? formula_.max : formula_.min); }

 private:
  ScalarFormula formula_;
  double scale_;
  Vec3 center_;
};

/// Base class of vector formulas: applies the scale, the reference side of a line field, and the check for finite results.
class VectorByFormula : public VectorField {
 public:
  VectorByFormula(std::string_view name, const AnalyticParameters& p) : scale_(p.scale), center_(p.center) {
    set_domain(std::string(name), Mapping{}, box_about(p.center));
  }
  VectorSample sample(const Vec3& world, Cursor&) const noexcept final {
    VectorSample s;
    if (!is_finite(world) || !evaluate(world - center_, s.value)) return {};
    s.value *= scale_;
    if (!is_finite(s.value)) return {};
    s.inside = true;
    return s;
  }
  /// Returns `masked` for a finite point at which the formula has no value.
  SampleStatus status_outside(const Vec3& world, Cursor&) const noexcept final {
    Vec3 value(0.0);
    if (!is_finite(world)) return SampleStatus::not_finite;
    if (!evaluate(world - center_, value)) return SampleStatus::masked;
    return is_finite(scale_ * value) ? SampleStatus::ok : SampleStatus::not_finite;
  }

 private:
  virtual bool evaluate(const Vec3& from_center, Vec3& value) const noexcept = 0;
  double scale_;
  Vec3 center_;
};

class NamedVector final : public VectorByFormula {
 public:
  NamedVector(const VectorFormula& formula, const AnalyticParameters& p) : VectorByFormula(formula.name, p), value_(formula.value) {}

 private:
  bool evaluate(const Vec3& p, Vec3& value) const noexcept override {
    value = value_(p);
    return true;
  }
  Vec3 (*value_)(const Vec3&);
};

class Uniform final : public VectorByFormula {
 public:
  Uniform(const Vec3& unit, const AnalyticParameters& p) : VectorByFormula(kUniform, p), unit_(unit) {}

 private:
  bool evaluate(const Vec3&, Vec3& value) const noexcept override {
    value = unit_;
    return true;
  }
  Vec3 unit_;
};

class VentricleFibre final : public VectorByFormula {
 public:
  explicit VentricleFibre(const AnalyticParameters& p) : VectorByFormula("fibre", p) {}

 private:
  bool evaluate(const Vec3& p, Vec3& value) const noexcept override { return ventricle_fiber(p, value); }
};

class VorticesField final : public VectorByFormula {
 public:
  explicit VorticesField(const AnalyticParameters& p) : VectorByFormula(kVortices, p), vortices_(p.seed, p.dimensions) {}

 private:
  bool evaluate(const Vec3& p, Vec3& value) const noexcept override {
    value = vortices_.value(p);
    return true;
  }
  Vortices vortices_;
};

AnyField scalar(const ScalarFormula& formula, const AnalyticParameters& p) {
  return {std::make_shared<ScalarByFormula>(formula, p), nullptr};
}

Result<AnyField> make_ventricle(const AnalyticParameters& parameters) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::string& part = parameters.part;
  if (part.empty() || part == "density") return scalar({"density", ventricle_density, 0, 1}, parameters);
  if (part == "transmural") return scalar({"transmural", ventricle_transmural, -1.875, inf}, parameters);
  if (part == "fibre") return AnyField{nullptr, std::make_shared<VentricleFibre>(parameters)};
  return Error{fmt::format("field \"left-ventricle\" has no part \"{}\", expected density, transmural or fibre", part)};
}

}  // namespace

std::vector<std::string_view> analytic_names() {
  std::vector<std::string_view> names;
  for (const auto& f : vector_formulas()) names.push_back(f.name);
  names.push_back(kUniform);
  names.push_back(kVortices);
  for (const auto& f : scalar_formulas()) names.push_back(f.name);
  names.push_back(kVentricle);
  return names;
}

bool is_analytic(std::string_view name) {
  const auto names = analytic_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string_view> analytic_parts(std::string_view name) {
  if (name == kVentricle) return {"density", "transmural", "fibre"};
  return {name};
}

Result<AnyField> make_analytic(std::string_view name, const AnalyticParameters& parameters) {
  // parameters
  if (!is_finite(parameters.center))
    return Error{fmt::format("field \"{}\": the centre is not finite, expected three finite numbers", name)};
  if (!std::isfinite(parameters.scale) || parameters.scale == 0)
    return Error{fmt::format("field \"{}\": scale is {}, expected a finite number other than 0", name, parameters.scale)};
  if (name == kVentricle) return make_ventricle(parameters);
  if (!parameters.part.empty())
    return Error{fmt::format("field \"{}\" has no parts, but the part \"{}\" was requested", name, parameters.part)};
  if (name == kUniform) {
    const Vec3 unit = direction(parameters.direction);
    if (unit == Vec3(0.0) || !is_finite(parameters.direction))
      return Error{"field \"uniform\": the direction is zero or not finite, expected a finite vector other than 0"};
    return AnyField{nullptr, std::make_shared<Uniform>(unit, parameters)};
  }
  if (name == kVortices) {
    if (parameters.dimensions != 2 && parameters.dimensions != 3)
      return Error{fmt::format("field \"vortices\": dimensions is {}, expected 2 or 3", parameters.dimensions)};
    return AnyField{nullptr, std::make_shared<VorticesField>(parameters)};
  }
  // formulas
  for (const auto& f : scalar_formulas())
    if (f.name == name) return scalar(f, parameters);
  for (const auto& f : vector_formulas())
    if (f.name == name) return AnyField{nullptr, std::make_shared<NamedVector>(f, parameters)};
  std::string all;
  for (const auto n : analytic_names()) all.append(" ").append(n);
  return Error{fmt::format("there is no analytic field \"{}\", expected one of{}", name, all)};
}

}  // namespace catena::field
