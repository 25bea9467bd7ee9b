// SPDX-License-Identifier: MIT
/// Fields given by a formula, with exact gradients: closed forms against which every algorithm is tested, and demonstration data.
/// Vector fields: circle saddle node rankine lamb-oseen hill abc helix uniform vortices.
/// Scalar fields: sphere plane torus constant linear gaussian marschner-lobb tanh.
/// left-ventricle has the parts density, transmural (scalar fields) and fibre (vector field, a line field).
#pragma once
#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/field/field.h"

namespace catena::field {

/// Parameters of a formula. World units.
struct AnalyticParameters {
  double scale = 1;               ///< factor applied to the values
  Vec3 direction{1.0, 0.0, 0.0};  ///< `uniform`: the vector
  std::string part;               ///< `left-ventricle`: density (default), transmural or fibre
  Vec3 center{0.0};               ///< world position of the formula's origin; its box moves with it
  int seed = 1;                   ///< `vortices`: seed of the random numbers
  int dimensions = 3;             ///< `vortices`: 2 or 3
  bool operator==(const AnalyticParameters&) const = default;
};

/// Returns all names, in the order of the list above. Any thread.
CATENA_EXPORT std::vector<std::string_view> analytic_names();
/// Returns true when make_analytic() accepts the name.
CATENA_EXPORT bool is_analytic(std::string_view name);
/// Returns the names of the grids that `generate` writes for a formula: the name itself, or its parts.
CATENA_EXPORT std::vector<std::string_view> analytic_parts(std::string_view name);
/// Makes a field that evaluates the formula exactly; it may be sampled from any thread. Error: an unknown name, or an invalid parameter for
/// this formula.
CATENA_EXPORT Result<AnyField> make_analytic(std::string_view name, const AnalyticParameters& parameters = {});

/// Scalar formula as a plain function, without the scale, which the field applies. This and all below is private to this module.
struct ScalarFormula {
  std::string_view name;  ///< name as in analytic_names()
  /// Returns the value at p and sets its gradient.
  double (*value)(const Vec3& p, Vec3& gradient);
  double min, max;  ///< range of the values over all space
};

/// Vector formula as a plain function, without the scale.
struct VectorFormula {
  std::string_view name;  ///< name as in analytic_names()
  /// Returns the vector at p, world axes.
  Vec3 (*value)(const Vec3& p);
};

/// Returns the scalar formulas.
CATENA_EXPORT std::span<const ScalarFormula> scalar_formulas();
/// Returns the vector formulas without parameters.
CATENA_EXPORT std::span<const VectorFormula> vector_formulas();

/// Sum of random vortices in a uniform flow; free of divergence (analytic_vortices.cpp).
class CATENA_EXPORT Vortices {
 public:
  /// Draws the vortices from the seed: the same seed gives the same ones. `dimensions`: 2 or 3.
  Vortices(int seed, int dimensions);
  /// Returns the flow at p (world units), world axes. Any thread.
  Vec3 value(const Vec3& p) const noexcept;

 private:
  static constexpr int kCount = 14;
  /// One vortex: center, angular velocity, and 1 / radius^2.
  struct Vortex {
    Vec3 center{0.0}, rate{0.0};
    double inverse_radius2 = 1;
  };
  std::array<Vortex, kCount> vortices_;
  Vec3 stream_{0.0};
  bool is_2d_;
};

/// Density of the left ventricle: 1 in the wall, falling to 0 around it. Formulas: analytic_formulas.cpp.
CATENA_EXPORT double ventricle_density(const Vec3& p, Vec3& gradient);
/// Transmural depth in the left ventricle: 0 at the inner surface of the wall, 1 at the outer one, linear beyond them. `gradient` is per
/// world unit.
CATENA_EXPORT double ventricle_transmural(const Vec3& p, Vec3& gradient);
/// Direction of the muscle fiber in the wall of the left ventricle, unit length. Returns false and sets zero outside of the support of the
/// density and on the long axis.
CATENA_EXPORT bool ventricle_fiber(const Vec3& p, Vec3& fibre);

}  // namespace catena::field
