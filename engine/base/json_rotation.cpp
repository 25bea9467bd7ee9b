#include "engine/base/json.h"
#include "engine/base/text.h"

namespace catena::json {

Result<Mat3> as_rotation(const Node& node, std::string_view what) {
  const std::string expected = "three orthonormal rows of three numbers, or {\"axis\": [x, y, z], \"angle_deg\": a}, were expected";
  if (node.kind == Kind::object) {
    CATENA_CHECK(only_keys(node, {"axis", "angle_deg"}));
    CATENA_TRY(const Vec3 axis, require_vec3(node, "axis"));
    if (norm(axis) == 0) return error_at(*node.find("axis"), "\"axis\" is zero; a vector other than [0, 0, 0] was expected");
    CATENA_TRY(const double angle_deg, require_number(node, "angle_deg"));
    // Rodrigues: R e = e cos a + (u x e) sin a + u (u . e)(1 - cos a)
    const Vec3 u = direction(axis);
    const double angle = angle_deg * (3.14159265358979323846 / 180.0), c = std::cos(angle), s = std::sin(angle);
    Mat3 rotation(1.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 e(0.0);
      e[i] = 1;
      rotation[i] = e * c + cross(u, e) * s + u * (u[i] * (1 - c));
    }
    return rotation;
  }
  const bool flat = node.kind == Kind::array && node.items.size() == 9;
  if (node.kind != Kind::array || (!flat && node.items.size() != 3))
    return error_at(node, in_quotes(what) + " has the wrong shape; " + expected);
  Mat3 rotation(1.0);
  for (int row = 0; row < 3; ++row) {
    Vec3 values(0.0);
    if (flat) {
      for (int i = 0; i < 3; ++i) {
        CATENA_TRY(values[i], as_number(node.items[static_cast<std::size_t>(3 * row + i)], what));
      }
    } else {
      CATENA_TRY(values, as_vec3(node.items[static_cast<std::size_t>(row)], what));
    }
    for (int column = 0; column < 3; ++column) rotation[column][row] = values[column];
  }
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::fabs(dot(rotation[i], rotation[j]) - (i == j ? 1.0 : 0.0)));
  if (!(worst <= 1e-6) || dot(cross(rotation[0], rotation[1]), rotation[2]) < 0)
    return error_at(node, in_quotes(what) + " is no rotation; " + expected);
  return rotation;
}

}  // namespace catena::json
