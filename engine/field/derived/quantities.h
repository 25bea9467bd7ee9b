// SPDX-License-Identifier: MIT
/// Quantities derived from the values and derivatives of a field at one position. J: velocity gradient, J_ij = dv_i / dx_j; S and W its
/// symmetric and antisymmetric part; g, H: gradient and Hessian of a scalar field. World axes and units. Any thread.
///   magnitude          |v|, of a scalar field |s|                gradient            g
///   divergence         tr J                                      vorticity           curl v = (J_32 - J_23, J_13 - J_31, J_21 - J_12)
///   helicity           v . curl v                                strain_rate         sqrt(2 S:S), the shear rate
///   q_criterion        (|W|^2 - |S|^2) / 2 = -tr(J^2) / 2, the second invariant of J where div v = 0 (Hunt, Wray and Moin 1988)
///   lambda2            middle eigenvalue of S^2 + W^2 (Jeong and Hussain 1995)
///   swirling_strength  imaginary part of J's complex eigenvalues, 0 without any (Zhou et al. 1999)
///   laplacian          tr H, of a vector field that of each component
///   max_curvature, min_curvature, mean_curvature, gaussian_curvature   of the level set: eigenvalues k1 >= k2 of P H P / |g| with
///                      P = 1 - g g^T / |g|^2, (k1 + k2) / 2, k1 k2; 1 / r on a ball whose values rise outwards; none where g = 0
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::field {

/// Quantity that depends on a field and its derivatives at one position.
enum class Quantity {
  magnitude,          ///< |v| or |s|
  gradient,           ///< g
  divergence,         ///< tr J
  vorticity,          ///< curl v
  helicity,           ///< v . curl v
  strain_rate,        ///< sqrt(2 S:S)
  q_criterion,        ///< -tr(J^2) / 2
  lambda2,            ///< middle eigenvalue of S^2 + W^2
  swirling_strength,  ///< imaginary part of J's complex eigenvalues
  laplacian,          ///< tr H
  max_curvature,      ///< k1 of the level set
  min_curvature,      ///< k2
  mean_curvature,     ///< (k1 + k2) / 2
  gaussian_curvature  ///< k1 k2
};

/// Properties of a quantity.
struct QuantityInfo {
  Quantity quantity;                          ///< the quantity
  std::string_view name;                      ///< as in scene files
  bool of_scalar = false, of_vector = false;  ///< kinds of fields that have it
  bool is_vector = false;                     ///< the quantity is a vector; `laplacian`: of a scalar field it is not
  int derivatives = 0;                        ///< order of the highest derivative
  int value_power = 1, length_power = 0;      ///< unit: (unit of the values)^value_power (unit of length)^length_power
};

/// Returns the properties of all quantities, in the order of Quantity.
CATENA_EXPORT std::span<const QuantityInfo> quantities();
/// Returns the properties of a quantity.
CATENA_EXPORT const QuantityInfo& info_of(Quantity quantity);

/// Returns the quantity of a name; an Error lists the known ones.
CATENA_EXPORT Result<Quantity> find_quantity(std::string_view name);

/// Value and derivatives of a scalar field.
struct ScalarJet {
  double value = 0;    ///< in the field's unit
  Vec3 gradient{0.0};  ///< per world unit
  Mat3 hessian{0.0};   ///< second derivatives
};
/// Value and derivatives of a vector field.
struct VectorJet {
  Vec3 value{0.0};      ///< components in world axes
  Mat3 jacobian{0.0};   ///< column j is dv / dx_j
  Vec3 laplacian{0.0};  ///< of each component
};

/// Evaluates a quantity of a scalar field; scalar results are the first component.
CATENA_EXPORT Vec3 evaluate(Quantity quantity, const ScalarJet& jet) noexcept;
/// Evaluates a quantity of a vector field; scalar results are the first component.
CATENA_EXPORT Vec3 evaluate(Quantity quantity, const VectorJet& jet) noexcept;

/// Returns the unit of a quantity: "1/s" for the vorticity of "m/s" with lengths in "m"; "m/s/mm" where the lengths do not cancel; empty if
/// one of the units is not known.
CATENA_EXPORT std::string unit_of(Quantity quantity, const std::string& value_unit, const std::string& length_unit);

}  // namespace catena::field
