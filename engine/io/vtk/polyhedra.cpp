// SPDX-License-Identifier: MIT
#include "engine/io/vtk/polyhedra.h"

#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>

namespace catena::vtk {
namespace {

using Ids = std::vector<vtkIdType>;

class Cutter {
 public:
  Cutter(vtkUnstructuredGrid* from, vtkDataArray* values) : from_(from), components_(values->GetNumberOfComponents()) {
    points_->SetDataTypeToDouble();
    points_->DeepCopy(from->GetPoints());
    values_->SetName("values");
    values_->SetNumberOfComponents(components_);
    values_->DeepCopy(values);
    to_->SetPoints(points_);
    to_->Allocate(from->GetNumberOfCells());
  }

  void add(vtkIdType cell) {
    vtkNew<vtkIdList> ids;
    if (from_->GetCellType(cell) != VTK_POLYHEDRON) {
      from_->GetCellPoints(cell, ids);
      to_->InsertNextCell(from_->GetCellType(cell), ids);
      return;
    }
    from_->GetFaceStream(cell, ids);
    if (!cut(ids)) to_->InsertNextCell(VTK_POLYHEDRON, ids);
  }

  CellValues take(std::vector<vtkSmartPointer<vtkDataSet>>& owned) {
    to_->GetPointData()->AddArray(values_);
    owned.push_back(to_.Get());
    return {to_, values_};
  }

 private:
  Vec3 place(vtkIdType i) const {
    double p[3];
    points_->GetPoint(i, p);
    return {p[0], p[1], p[2]};
  }

  vtkIdType centre(const Ids& ids) {
    Vec3 sum(0.0);
    std::vector<double> value(static_cast<std::size_t>(components_), 0.0);
    const double part = 1.0 / static_cast<double>(ids.size());
    for (const vtkIdType i : ids) {
      sum += place(i) * part;
      for (int c = 0; c < components_; ++c) value[static_cast<std::size_t>(c)] += values_->GetComponent(i, c) * part;
    }
    const vtkIdType n = points_->InsertNextPoint(sum.x, sum.y, sum.z);
    values_->InsertTuple(n, value.data());
    return n;
  }

  vtkIdType centre_of_face(const Ids& face) {
    Ids sorted = face;
    std::sort(sorted.begin(), sorted.end());
    const auto [at, is_new] = faces_.try_emplace(sorted, 0);
    if (is_new) at->second = centre(sorted);
    return at->second;
  }

  /// Parses `stream`: the number of faces, then the number of points and the points of each. Empty if the stream is invalid.
  static std::vector<Ids> faces_of(vtkIdList* stream) {
    std::vector<Ids> faces;
    const vtkIdType end = stream->GetNumberOfIds();
    vtkIdType at = 0;
    const vtkIdType count = end > 0 ? stream->GetId(at++) : 0;
    for (vtkIdType f = 0; f < count; ++f) {
      const vtkIdType n = at < end ? stream->GetId(at++) : 0;
      if (n < 3 || n > end - at) return {};
      Ids& face = faces.emplace_back();
      for (vtkIdType i = 0; i < n; ++i) face.push_back(stream->GetId(at++));
    }
    return faces;
  }

  /// Orients all faces the same way, whatever the order in the file: neighbors traverse their common edge in opposite directions. Returns
  /// false if the faces are not a closed surface.
  static bool orient_faces(std::vector<Ids>& faces) {
    struct Side {
      std::size_t face;
      bool forward;  ///< starts at the edge's lower point index
    };
    std::map<std::pair<vtkIdType, vtkIdType>, std::vector<Side>> edges;
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t i = 0; i < faces[f].size(); ++i) {
        const vtkIdType a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
        edges[{std::min(a, b), std::max(a, b)}].push_back({f, a < b});
      }
    // neighbors of each face, and whether both are listed with the same orientation
    std::vector<std::vector<std::pair<std::size_t, bool>>> neighbours(faces.size());
    for (const auto& [edge, sides] : edges) {
      if (sides.size() != 2) return false;
      const bool same_orientation = sides[0].forward != sides[1].forward;
      neighbours[sides[0].face].emplace_back(sides[1].face, same_orientation);
      neighbours[sides[1].face].emplace_back(sides[0].face, same_orientation);
    }
    std::vector<int> orientation(faces.size(), -1);
    std::vector<std::size_t> next{0};
    orientation[0] = 0;
    while (!next.empty()) {
      const std::size_t f = next.back();
      next.pop_back();
      for (const auto& [other, same_orientation] : neighbours[f]) {
        if (orientation[other] >= 0) continue;
        orientation[other] = same_orientation ? orientation[f] : 1 - orientation[f];
        next.push_back(other);
      }
    }
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (orientation[f] == 1) std::reverse(faces[f].begin(), faces[f].end());
    return true;
  }

  bool cut(vtkIdList* stream) {
    Ids all;
    std::vector<Ids> triangles, faces = faces_of(stream);
    if (faces.empty() || !orient_faces(faces)) return false;
    for (const Ids& face : faces) {
      all.insert(all.end(), face.begin(), face.end());
      if (face.size() == 3) {
        triangles.push_back(face);
        continue;
      }
      const vtkIdType middle = centre_of_face(face);
      for (std::size_t i = 0; i < face.size(); ++i) triangles.push_back({face[i], face[(i + 1) % face.size()], middle});
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.size() < 4) return false;
    // all triangles must have the same orientation as seen from the center
    Vec3 eye(0.0);
    for (const vtkIdType i : all) eye += place(i) * (1.0 / static_cast<double>(all.size()));
    int positive = 0, negative = 0;
    std::vector<Ids> solid;
    for (const Ids& t : triangles) {
      const Vec3 a = place(t[0]) - eye, b = place(t[1]) - eye, c = place(t[2]) - eye;
      const double volume = dot(cross(a, b), c), size = norm(a) * norm(b) * norm(c);
      constexpr double kFlat = 1e-12;
      if (std::abs(volume) <= kFlat * size) continue;
      (volume > 0 ? positive : negative) += 1;
      solid.push_back(volume > 0 ? Ids{t[0], t[1], t[2]} : Ids{t[0], t[2], t[1]});
    }
    if (solid.empty() || (positive > 0 && negative > 0)) return false;
    const vtkIdType inner = centre(all);
    for (const Ids& t : solid) {
      const vtkIdType corners[4] = {t[0], t[1], t[2], inner};
      to_->InsertNextCell(VTK_TETRA, 4, corners);
    }
    return true;
  }

  vtkUnstructuredGrid* from_;
  int components_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkDoubleArray> values_;
  vtkNew<vtkUnstructuredGrid> to_;
  std::map<Ids, vtkIdType> faces_;
};

}  // namespace

CellValues tetrahedralize_polyhedra(const CellValues& block, std::vector<vtkSmartPointer<vtkDataSet>>& owned) {
  auto* grid = vtkUnstructuredGrid::SafeDownCast(block.data);
  if (grid == nullptr) return block;
  bool some = false;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells() && !some; ++i) some = grid->GetCellType(i) == VTK_POLYHEDRON;
  if (!some) return block;
  Cutter cutter(grid, block.values);
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) cutter.add(i);
  return cutter.take(owned);
}

}  // namespace catena::vtk
