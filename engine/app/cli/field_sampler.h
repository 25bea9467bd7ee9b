// SPDX-License-Identifier: MIT
/// Samples all fields of a scene at points in the world, for the columns of a table or the point values of a mesh.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/scene/scene.h"

namespace catena::app {

/// One thread: sampling uses cached cursors.
class FieldSampler {
 public:
  /// Loads all fields of the scene, in full resolution as the haptics uses them. Error: a field cannot be loaded.
  static Result<FieldSampler> load(scene::Scene& scene);

  /// Column names in the scene's order: ",NAME" for a scalar field, ",NAME_x,NAME_y,NAME_z" for a vector field.
  std::string csv_header() const;
  /// Appends one cell per column for the point `world`, each after a comma; empty where the field has no value. Numbers read back exactly.
  void append_csv_cells(std::string& line, const Vec3& world);
  /// Samples all fields at the points; NaN where a field has no value.
  std::vector<mesh::PointValues> sample_points(const std::vector<Vec3>& points);
  /// Total number of components of all fields.
  std::size_t column_count() const;

 private:
  struct NamedField {
    std::string name;
    field::AnyField field;
    field::Cursor cursor{};
    /// Samples the field at a point; returns false outside of the field.
    bool sample(const Vec3& world, double (&numbers)[3]);
    int components() const { return field.scalar ? 1 : 3; }
  };
  std::vector<NamedField> fields_;
};

}  // namespace catena::app
