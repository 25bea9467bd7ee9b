/// These functions say what the fields of the scene are at a place: every field that is loaded, by its name, with its unit. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

struct FieldSample {
  std::string name, unit;
  bool is_inside = false;  ///< within the domain and the mask; outside there is no value
  double value = 0;        ///< of a vector: its length
  std::optional<Vec3> vector{};
  std::string label{};  ///< of a label map: what the value stands for, "Precentral_L (1)"
};

/// A place of the table: where, of which thing, and what is there.
struct PointSamples {
  std::optional<Vec3> world{};
  std::string object{};
  std::vector<FieldSample> samples{};
};

/// In the order of the scene.
std::vector<FieldSample> sample_fields(const scene::Scene& scene, const Vec3& world);

/// "0.43", "Precentral_L (1)", "outside"; a vector's length with its components in brackets where `components`.
std::string format_sample(const FieldSample& value, bool components = false);
/// "1.2, 3.4, 5.6 mm"
std::string format_point(const Vec3& world, const std::string& unit_length);
/// "1.2, 3.4, 5.6 mm   density 0.43   isosurface density"
std::string format_point_samples(const PointSamples& place, const std::string& unit_length);

}  // namespace catena::app
