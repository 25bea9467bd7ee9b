// SPDX-License-Identifier: MIT
/// Values of the scene's fields at a point: every loaded field, by name, with its unit. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

/// The value of one field.
struct FieldSample {
  std::string name, unit;
  bool is_inside = false;  ///< The point is within domain and mask; outside there is no value.
  double value = 0;        ///< For a vector field the magnitude.
  std::optional<Vec3> vector{};
  std::string label{};  ///< For a label map the name of the label, "Precentral_L (1)".
};

/// A row of the value table: position, name of the object there, and field values.
struct PointSamples {
  std::optional<Vec3> world{};
  std::string object{};
  std::vector<FieldSample> samples{};
};

/// Returns the values of all loaded fields, in the order of the scene.
std::vector<FieldSample> sample_fields(const scene::Scene& scene, const Vec3& world);

/// Returns "0.43", "Precentral_L (1)" or "outside"; for a vector its magnitude, followed by the components in parentheses if `components`.
std::string format_sample(const FieldSample& value, bool components = false);
/// Returns "1.2, 3.4, 5.6 mm".
std::string format_point(const Vec3& world, const std::string& unit_length);
/// Returns "1.2, 3.4, 5.6 mm   density 0.43   isosurface density"; empty without a position.
std::string format_point_samples(const PointSamples& samples, const std::string& unit_length);

}  // namespace catena::app
