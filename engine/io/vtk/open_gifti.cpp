// SPDX-License-Identifier: MIT
// Opens GIFTI surfaces with the GIFTI library: points and triangles, millimeters, patient space (right, anterior, superior). Shape and
// function files without points belong to a surface in another file, and are refused.
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

extern "C" {
#include <gifti_io.h>
}

#include <memory>

#include "engine/base/text.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

struct FreeImage {
  void operator()(gifti_image* image) const { gifti_free_image(image); }
};

constexpr int kPoints = NIFTI_INTENT_POINTSET, kTriangles = NIFTI_INTENT_TRIANGLE;

constexpr int kColumns = 3;

bool is_table(const giiDataArray& array) {
  return array.num_dim == 2 && array.dims[0] > 0 && array.dims[1] == kColumns && array.data != nullptr;
}

/// Returns the index of a number of a row in the array's data.
std::size_t place_of(const giiDataArray& array, int row, int column) {
  const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
  return array.ind_ord == GIFTI_IND_ORD_COL_MAJOR ? c * static_cast<std::size_t>(array.dims[0]) + r : kColumns * r + c;
}

double coordinate(const giiDataArray& points, int row, int axis) {
  const std::size_t at = place_of(points, row, axis);
  return points.datatype == NIFTI_TYPE_FLOAT64 ? static_cast<const double*>(points.data)[at]
                                               : static_cast<double>(static_cast<const float*>(points.data)[at]);
}

}  // namespace

Result<ImportedData> open_gifti(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{source.display_name + ": " + what}; };
  gifti_set_verb(0);
  const std::unique_ptr<gifti_image, FreeImage> image(gifti_read_image(source.path.c_str(), 1));
  if (!image) return failed("cannot be read: not a GIFTI file, or a damaged one");
  const giiDataArray *points = nullptr, *triangles = nullptr;
  ImportedData opened;
  vtkNew<vtkPolyData> poly;
  for (int i = 0; i < image->numDA; ++i) {
    const giiDataArray* array = image->darray[i];
    if (array == nullptr) continue;
    const bool is_real = array->datatype == NIFTI_TYPE_FLOAT32 || array->datatype == NIFTI_TYPE_FLOAT64;
    if (array->intent == kPoints && points == nullptr && is_real && is_table(*array)) points = array;
    if (array->intent == kTriangles && triangles == nullptr && array->datatype == NIFTI_TYPE_INT32 && is_table(*array)) triangles = array;
  }
  if (points == nullptr) return failed("contains no points; a GIFTI surface was expected, not values for a surface in another file");
  if (triangles == nullptr) return failed("contains points without triangles");
  vtkNew<vtkPoints> places;
  if (points->datatype == NIFTI_TYPE_FLOAT64) places->SetDataTypeToDouble();
  const int count = points->dims[0];
  places->SetNumberOfPoints(count);
  for (int i = 0; i < count; ++i) places->SetPoint(i, coordinate(*points, i, 0), coordinate(*points, i, 1), coordinate(*points, i, 2));
  poly->SetPoints(places);
  vtkNew<vtkCellArray> cells;
  const auto* ids = static_cast<const int*>(triangles->data);
  for (int i = 0; i < triangles->dims[0]; ++i) {
    vtkIdType corner[3];
    for (int c = 0; c < kColumns; ++c) {
      corner[c] = ids[place_of(*triangles, i, c)];
      if (corner[c] < 0 || corner[c] >= count)
        return failed(fmt::format("triangle {} refers to point {}, but there are {} points", i, corner[c], count));
    }
    cells->InsertNextCell(3, corner);
  }
  poly->SetPolys(cells);
  opened.blocks.push_back({poly.GetPointer(), {}});
  opened.is_patient_space = true;
  opened.unit_length = "mm";
  return opened;
}

}  // namespace catena::vtk
