/// Private to this room: the closed forms as plain functions. The scale is applied by the field around them.
#pragma once
#include <limits>
#include <span>
#include <string_view>

#include "engine/base/vec.h"

namespace catena::field {

struct ScalarFormula {
  std::string_view name;
  double (*value)(const Vec3& p, Vec3& gradient);
  double min, max;  ///< over all space
};

struct VectorFormula {
  std::string_view name;
  Vec3 (*value)(const Vec3& p);
};

std::span<const ScalarFormula> scalar_formulas();
std::span<const VectorFormula> vector_formulas();

/// The left ventricle: see analytic_left_ventricle.cpp.
double ventricle_density(const Vec3& p, Vec3& gradient);
double ventricle_transmural(const Vec3& p, Vec3& gradient);
/// False (and zero) away from the wall.
bool ventricle_fibre(const Vec3& p, Vec3& fibre);

}  // namespace catena::field
