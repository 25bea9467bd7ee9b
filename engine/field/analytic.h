/// Fields by formula, with exact gradients: the closed forms that every algorithm is tested against, and demo data.
/// Names: circle saddle node rankine lamb-oseen hill abc helix uniform (vectors);
///        sphere plane torus constant linear gaussian marschner-lobb tanh (scalars);
///        left-ventricle with the parts density, transmural (scalars) and fibre (vector, a line field).
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

struct AnalyticParameters {
  double scale = 1;               ///< multiplies values
  Vec3 direction{1.0, 0.0, 0.0};  ///< `uniform`
  std::string part;               ///< `left-ventricle`: density (default), transmural or fibre
  bool operator==(const AnalyticParameters&) const = default;
};

std::vector<std::string_view> analytic_names();
bool is_analytic(std::string_view name);
/// The grids that `generate` writes for this name: the name itself, or the parts.
std::vector<std::string_view> analytic_parts(std::string_view name);
Result<AnyField> make_analytic(std::string_view name, const AnalyticParameters& parameters = {});

}  // namespace catena::field
