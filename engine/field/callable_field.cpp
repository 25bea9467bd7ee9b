// SPDX-License-Identifier: MIT
#include "engine/field/callable_field.h"

#include <utility>

#include "engine/base/result.h"

namespace catena::field {
namespace {

bool is_box(const Bounds& domain) { return !domain.empty() && is_finite(domain.lo) && is_finite(domain.hi); }

SampleStatus why_not(const Bounds& domain, const Vec3& world) {
  if (!is_finite(world)) return SampleStatus::not_finite;
  return domain.contains(world) ? SampleStatus::not_finite : SampleStatus::outside_box;
}

class ScalarByFunction final : public ScalarField {
 public:
  ScalarByFunction(std::string name, const Bounds& domain, ScalarFunction function, double min_value, double max_value)
      : function_(std::move(function)), domain_(domain), min_value_(min_value), max_value_(max_value) {
    set_domain(std::move(name), Mapping{}, {domain.lo, domain.hi});
  }
  ScalarSample sample(const Vec3& world, Cursor&) const noexcept override {
    if (!is_finite(world)) return {};
    ScalarSample s;
    s.value = function_(world, s.gradient);
    if (!std::isfinite(s.value) || !is_finite(s.gradient)) return {};
    s.inside = domain_.contains(world);
    return s;
  }
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override {
    return sample(world, cursor).inside ? SampleStatus::ok : why_not(domain_, world);
  }
  double min_value() const noexcept override { return min_value_; }
  double max_value() const noexcept override { return max_value_; }

 private:
  ScalarFunction function_;
  Bounds domain_;
  double min_value_, max_value_;
};

class VectorByFunction final : public VectorField {
 public:
  VectorByFunction(std::string name, const Bounds& domain, VectorFunction function) : function_(std::move(function)), domain_(domain) {
    set_domain(std::move(name), Mapping{}, {domain.lo, domain.hi});
  }
  VectorSample sample(const Vec3& world, Cursor&) const noexcept override {
    if (!is_finite(world)) return {};
    const Vec3 value = function_(world);
    if (!is_finite(value)) return {};
    return {value, domain_.contains(world)};
  }
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override {
    return sample(world, cursor).inside ? SampleStatus::ok : why_not(domain_, world);
  }

 private:
  VectorFunction function_;
  Bounds domain_;
};

}  // namespace

ScalarFieldPtr make_callable_field(std::string name, const Bounds& domain, ScalarFunction function, double min_value, double max_value) {
  CATENA_ASSERT(is_box(domain));
  return std::make_shared<ScalarByFunction>(std::move(name), domain, std::move(function), min_value, max_value);
}

VectorFieldPtr make_callable_field(std::string name, const Bounds& domain, VectorFunction function) {
  CATENA_ASSERT(is_box(domain));
  return std::make_shared<VectorByFunction>(std::move(name), domain, std::move(function));
}

}  // namespace catena::field
