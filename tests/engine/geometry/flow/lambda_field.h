// SPDX-License-Identifier: MIT
/// A vector field from a lambda, for tests of the flow: v(p), inside everywhere unless a second lambda is given.
#pragma once
#include <functional>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/flow.h"

namespace catena::test {

class LambdaField final : public field::VectorField {
 public:
  using Value = std::function<Vec3(const Vec3&)>;
  using Inside = std::function<bool(const Vec3&)>;
  explicit LambdaField(Value value, Inside inside = nullptr) : value_(std::move(value)), inside_(std::move(inside)) {
    field::Mapping mapping;
    set_domain("lambda", mapping, field::Box{Vec3(-2.0), Vec3(2.0)});
  }
  field::VectorSample sample(const Vec3& p, field::Cursor&) const noexcept override {
    field::VectorSample sample;
    sample.value = value_(p);
    sample.inside = !inside_ || inside_(p);
    return sample;
  }

 private:
  Value value_;
  Inside inside_;
};

inline field::VectorFieldPtr lambda_field(LambdaField::Value value, LambdaField::Inside inside = nullptr) {
  return std::make_shared<LambdaField>(std::move(value), std::move(inside));
}

inline field::VectorFieldPtr analytic_vector(const std::string& name, double scale = 1) {
  field::AnalyticParameters parameters;
  parameters.scale = scale;
  auto made = field::make_analytic(name, parameters);
  CATENA_ASSERT(made && made->vector);
  return made->vector;
}

/// A grid of a formula with `size` nodes, under a mapping.
inline std::shared_ptr<const field::VectorGrid> sample_vector_grid(const field::Mapping& mapping, const field::Index3& size,
                                                                   const std::function<Vec3(const Vec3&)>& value,
                                                                   const std::vector<std::uint8_t>& valid = {}) {
  std::vector<float> xyz;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) {
        const Vec3 v = value(mapping.world_from_index(Vec3(i, j, k)));
        for (int c = 0; c < 3; ++c) xyz.push_back(static_cast<float>(v[c]));
      }
  return field::make_vector_grid("test", mapping, size, xyz, valid);
}

}  // namespace catena::test
