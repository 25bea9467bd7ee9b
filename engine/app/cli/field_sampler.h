/// Every field of a scene at places of the world: the columns of a table, or values by point.
#pragma once
#include <string>
#include <vector>

#include "engine/app/cli/mesh_writer.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace catena::app {

class FieldSampler {
 public:
  /// Loads all of the scene's fields, as the hand feels them.
  static Result<FieldSampler> load(scene::Scene& scene);

  /// ",NAME" of a scalar, ",NAME_x,NAME_y,NAME_z" of a vector, in the scene's order.
  std::string csv_header() const;
  /// A cell a column; empty where the field has no value. NumberArray read back exactly.
  void append_csv_cells(std::string& line, const Vec3& world);
  /// The same at many points.
  std::vector<PointValues> sample_points(const std::vector<Vec3>& points);
  std::size_t column_count() const;

 private:
  struct NamedField {
    std::string name;
    field::AnyField field;
    field::Cursor cursor{};
    /// Its numbers at a place; false: outside.
    bool sample(const Vec3& world, double (&numbers)[3]);
    int components() const { return field.scalar ? 1 : 3; }
  };
  std::vector<NamedField> fields_;
};

}  // namespace catena::app
