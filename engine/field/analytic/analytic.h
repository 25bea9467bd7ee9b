/// Fields by formula, with exact gradients: the closed forms that every algorithm is tested against, and demo data.
/// Names: circle saddle node rankine lamb-oseen hill abc helix uniform vortices (vectors);
///        sphere plane torus constant linear gaussian marschner-lobb tanh (scalars);
///        left-ventricle with the parts density, transmural (scalars) and fibre (vector, a line field).
#pragma once
#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/field/field.h"

namespace catena::field {

/// What a formula may be told. World units.
struct AnalyticParameters {
  double scale = 1;               ///< multiplies values
  Vec3 direction{1.0, 0.0, 0.0};  ///< `uniform`
  std::string part;               ///< `left-ventricle`: density (default), transmural or fibre
  Vec3 center{0.0};               ///< world place of the formula's origin; its box goes with it
  int seed = 1;                   ///< `vortices`
  int dimensions = 3;             ///< `vortices`: 2 or 3
  bool operator==(const AnalyticParameters&) const = default;
};

/// All names, in the order of the list above. Any thread.
std::vector<std::string_view> analytic_names();
/// Whether make_analytic() knows the name.
bool is_analytic(std::string_view name);
/// The grids that `generate` writes for this name: the name itself, or the parts.
std::vector<std::string_view> analytic_parts(std::string_view name);
/// The formula as a field: sampled exactly, any thread. An error for an unknown name, or a parameter that makes no sense for it.
Result<AnyField> make_analytic(std::string_view name, const AnalyticParameters& parameters = {});

/// Private to this room: the closed forms as plain functions. The scale is applied by the field around them.
struct ScalarFormula {
  std::string_view name;  ///< as in analytic_names()
  /// The value at p, and its gradient by p.
  double (*value)(const Vec3& p, Vec3& gradient);
  double min, max;  ///< over all space
};

/// A vector formula as a plain function.
struct VectorFormula {
  std::string_view name;  ///< as in analytic_names()
  /// The vector at p, world axes.
  Vec3 (*value)(const Vec3& p);
};

/// The scalar formulas.
std::span<const ScalarFormula> scalar_formulas();
/// The vector formulas that need no parameter.
std::span<const VectorFormula> vector_formulas();

/// Rotations drawn by a seed, in a uniform stream (analytic_vortices.cpp).
class Vortices {
 public:
  /// Draws the rotations: the same seed gives the same ones. `dimensions` 2 or 3.
  Vortices(int seed, int dimensions);
  /// The flow at p, world axes; p in world units.
  Vec3 value(const Vec3& p) const noexcept;

 private:
  static constexpr int kCount = 14;
  struct Vortex {
    Vec3 center{0.0}, rate{0.0};
    double inverse_radius2 = 1;
  };
  std::array<Vortex, kCount> vortices_;
  Vec3 stream_{0.0};
  bool is_2d_;
};

/// The left ventricle: see analytic_formulas.cpp.
double ventricle_density(const Vec3& p, Vec3& gradient);
/// 0 at the wall's inner surface, 1 at its outer one, and on beyond; `gradient` by world units.
double ventricle_transmural(const Vec3& p, Vec3& gradient);
/// False (and zero) away from the wall.
bool ventricle_fiber(const Vec3& p, Vec3& fibre);

}  // namespace catena::field
