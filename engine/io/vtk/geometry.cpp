// SPDX-License-Identifier: MIT
#include "engine/io/vtk/geometry.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellTypes.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/vec.h"
#include "engine/io/vtk/validity_mask.h"

namespace catena::vtk {
namespace {

struct Gathered {
  std::vector<double> points;
  std::vector<std::uint32_t> triangles, lines, loose;
  std::vector<std::uint64_t> ends;
  std::vector<float> values;

  double bytes() const {
    return 8.0 * static_cast<double>(points.size() + ends.size()) +
           4.0 * static_cast<double>(triangles.size() + lines.size() + loose.size() + values.size());
  }
};

void add(vtkPolyData& poly, const std::string& value_name, Gathered& all) {
  const auto base = static_cast<std::uint32_t>(all.points.size() / 3);
  std::vector<bool> used_points(static_cast<std::size_t>(poly.GetNumberOfPoints()), false);
  for (vtkIdType i = 0; i < poly.GetNumberOfPoints(); ++i) {
    double p[3];
    poly.GetPoint(i, p);
    all.points.insert(all.points.end(), p, p + 3);
  }
  vtkIdType n = 0;
  const vtkIdType* ids = nullptr;
  const auto number = [&](vtkIdType i) {
    used_points[static_cast<std::size_t>(i)] = true;
    return base + static_cast<std::uint32_t>(i);
  };
  for (vtkCellArray* cells = poly.GetPolys(); cells->GetNextCell(n, ids);)
    if (n == 3)
      for (int c = 0; c < 3; ++c) all.triangles.push_back(number(ids[c]));
  for (vtkCellArray* cells = poly.GetLines(); cells->GetNextCell(n, ids);) {
    if (n < 2) continue;
    for (vtkIdType c = 0; c < n; ++c) all.lines.push_back(number(ids[c]));
    all.ends.push_back(all.lines.size());
  }
  for (vtkIdType i = 0; i < poly.GetNumberOfPoints(); ++i)
    if (!used_points[static_cast<std::size_t>(i)]) all.loose.push_back(base + static_cast<std::uint32_t>(i));
  vtkDataArray* values = value_name.empty() ? nullptr : poly.GetPointData()->GetArray(value_name.c_str());
  for (vtkIdType i = 0; !value_name.empty() && i < poly.GetNumberOfPoints(); ++i)
    all.values.push_back(values != nullptr ? static_cast<float>(values->GetComponent(i, 0)) : std::numeric_limits<float>::quiet_NaN());
}

/// Returns the data as vtkPolyData: polygons and strips as triangles, other cells unchanged.
vtkSmartPointer<vtkPolyData> poly_of(vtkDataSet* data) {
  vtkSmartPointer<vtkPolyData> poly = vtkPolyData::SafeDownCast(data);
  if (poly == nullptr) {
    vtkNew<vtkDataSetSurfaceFilter> outside;
    outside->SetInputData(data);
    outside->Update();
    poly = outside->GetOutput();
  }
  if (poly->GetNumberOfPolys() + poly->GetNumberOfStrips() == 0) return poly;
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(poly);
  triangles->PassLinesOn();
  triangles->PassVertsOn();
  triangles->Update();
  return triangles->GetOutput();
}

template <class T>
void write_buffer(const std::vector<T>& numbers, sandbox::ResponseFile& out, field::BufferRange& piece) {
  if (numbers.empty()) return;
  field::NanoMemory memory = out.allocate(numbers.size() * sizeof(T), piece);
  std::memcpy(memory.data(), numbers.data(), numbers.size() * sizeof(T));
}

/// Returns the name of the single-component array to color by: the active scalars, otherwise the first.
std::string value_of(const ImportedData& opened) {
  for (const Block& block : opened.blocks) {
    vtkPointData* arrays = block.data->GetPointData();
    if (arrays->GetScalars() != nullptr && arrays->GetScalars()->GetNumberOfComponents() == 1 && arrays->GetScalars()->GetName() != nullptr)
      return arrays->GetScalars()->GetName();
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
      if (arrays->GetArray(i) != nullptr && arrays->GetArray(i)->GetNumberOfComponents() == 1 && arrays->GetArrayName(i) != nullptr)
        return arrays->GetArrayName(i);
  }
  return {};
}

}  // namespace

field::PrimitiveKinds find_primitive_kinds(const ImportedData& opened) {
  field::PrimitiveKinds shapes;
  for (const Block& block : opened.blocks) {
    if (auto* poly = vtkPolyData::SafeDownCast(block.data)) {
      shapes.triangles = shapes.triangles || poly->GetNumberOfPolys() + poly->GetNumberOfStrips() > 0;
      shapes.lines = shapes.lines || poly->GetNumberOfLines() > 0;
    } else if (auto* cells = vtkUnstructuredGrid::SafeDownCast(block.data)) {
      vtkNew<vtkCellTypes> types;
      vtkNew<vtkGenericCell> cell;
      cells->GetCellTypes(types);
      for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i) {
        cell->SetCellType(types->GetCellType(i));
        shapes.triangles = shapes.triangles || cell->GetCellDimension() >= 2;
        shapes.lines = shapes.lines || cell->GetCellDimension() == 1;
      }
    } else {
      shapes.triangles = true;
    }
  }
  return shapes;
}

Outcome write_geometry(const ImportedData& opened, std::uint64_t memory_bytes, sandbox::ResponseFile& out, field::ReadResponse& reply) {
  Gathered all;
  reply.geometry.value_name = value_of(opened);
  const std::vector<ValidityMask> masks = make_validity_masks(opened, {});
  for (std::size_t b = 0; b < opened.blocks.size(); ++b) {
    const vtkSmartPointer<vtkPolyData> poly = poly_of(extract_valid_cells(opened.blocks[b].data, masks[b]));
    constexpr double kMaxPoints = 4e9;
    if (static_cast<double>(all.points.size() / 3) + static_cast<double>(poly->GetNumberOfPoints()) > kMaxPoints)
      return Error{"has more than 4e9 points"};
    add(*poly, reply.geometry.value_name, all);
  }
  CATENA_CHECK(check_memory_available("the geometry", all.bytes(), memory_bytes));
  write_buffer(all.points, out, reply.geometry.points);
  write_buffer(all.triangles, out, reply.geometry.triangles);
  write_buffer(all.lines, out, reply.geometry.lines);
  write_buffer(all.ends, out, reply.geometry.line_ends);
  write_buffer(all.loose, out, reply.geometry.loose_points);
  write_buffer(all.values, out, reply.geometry.values);
  return Done{};
}

}  // namespace catena::vtk
