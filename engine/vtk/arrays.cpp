#include "engine/vtk/arrays.h"

#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace catena::vtk {
namespace {

vtkDataSetAttributes* attributes(vtkDataSet* data, bool of_cells) {
  return of_cells ? static_cast<vtkDataSetAttributes*>(data->GetCellData()) : static_cast<vtkDataSetAttributes*>(data->GetPointData());
}

bool is_bookkeeping(const std::string& name) {
  return name == "valid" || name.starts_with("vtkValid") || name.starts_with("vtkGhost") || name.starts_with("vtkOriginal") ||
         name == "GlobalNodeId" || name == "GlobalCellId" || name == "ObjectId" || name == "BlockId" || name == "vtkBlockColors";
}

template <class Visit>
void each_array(const Opened& opened, const Visit& visit) {
  for (const bool of_cells : {false, true})
    for (std::size_t b = 0; b < opened.blocks.size(); ++b) {
      vtkDataSetAttributes* arrays = attributes(opened.blocks[b].data, of_cells);
      for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = arrays->GetArray(i);
        if (array != nullptr && array->GetNumberOfTuples() > 0) visit(b, of_cells, *array);
      }
    }
}

std::string name_of(vtkDataArray& array) { return array.GetName() != nullptr && *array.GetName() != 0 ? array.GetName() : "data"; }

bool can_be_field(vtkDataArray& array) {
  return array.GetNumberOfComponents() >= 1 && array.GetNumberOfComponents() <= 3 && !is_bookkeeping(name_of(array));
}

template <class T>
bool convert(const T* in, std::size_t count, float* out) {
  bool exact = true;
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<float>(in[i]);
    exact = exact && (static_cast<T>(out[i]) == in[i] || !(in[i] == in[i]));
  }
  return exact;
}

bool convert_tuple(vtkDataArray& array, vtkIdType tuple, int components, float* out) {
  bool exact = true;
  for (int c = 0; c < components; ++c) {
    const double v = array.GetComponent(tuple, c);
    out[c] = static_cast<float>(v);
    exact = exact && (static_cast<double>(out[c]) == v || std::isnan(v));
  }
  return exact;
}

/// Hidden points, and those of which all cells are hidden; 1: to be seen.
std::vector<std::uint8_t> seen_tuples(vtkImageData& image, bool of_cells, const int (&n)[3]) {
  std::vector<std::uint8_t> seen;
  const auto ghosts = [&](vtkUnsignedCharArray* array, unsigned char bits) {
    if (array == nullptr) return;
    seen.resize(static_cast<std::size_t>(array->GetNumberOfTuples()), 1);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if ((array->GetValue(static_cast<vtkIdType>(i)) & bits) != 0) seen[i] = 0;
  };
  if (of_cells) {
    ghosts(image.GetCellGhostArray(), vtkDataSetAttributes::HIDDENCELL);
    return seen;
  }
  ghosts(image.GetPointGhostArray(), vtkDataSetAttributes::HIDDENPOINT);
  vtkUnsignedCharArray* cells = image.GetCellGhostArray();
  if (cells == nullptr) return seen;
  seen.resize(static_cast<std::size_t>(image.GetNumberOfPoints()), 1);
  std::vector<std::uint8_t> touched(seen.size(), 0);
  int m[3];
  for (int a = 0; a < 3; ++a) m[a] = std::max(n[a] - 1, 1);
  for (int k = 0; k < m[2]; ++k)
    for (int j = 0; j < m[1]; ++j)
      for (int i = 0; i < m[0]; ++i) {
        const vtkIdType cell = (static_cast<vtkIdType>(k) * m[1] + j) * m[0] + i;
        if ((cells->GetValue(cell) & vtkDataSetAttributes::HIDDENCELL) != 0) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const int p[3] = {std::min(i + (corner & 1), n[0] - 1), std::min(j + (corner >> 1 & 1), n[1] - 1),
                            std::min(k + (corner >> 2), n[2] - 1)};
          touched[(static_cast<std::size_t>(p[2]) * static_cast<std::size_t>(n[1]) + static_cast<std::size_t>(p[1])) *
                      static_cast<std::size_t>(n[0]) +
                  static_cast<std::size_t>(p[0])] = 1;
        }
      }
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] &= touched[i];
  return seen;
}

}  // namespace

vtkDataArray* Column::in(const Block& block) const {
  vtkDataSetAttributes* arrays = attributes(block.data, of_cells);
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    if (vtkDataArray* one = arrays->GetArray(i); one != nullptr && name_of(*one) == array) return one;
  return nullptr;
}

std::vector<Column> columns_of(const Opened& opened) {
  std::vector<Column> columns;
  each_array(opened, [&](std::size_t b, bool of_cells, vtkDataArray& array) {
    if (!can_be_field(array)) return;
    const std::string name = name_of(array);
    for (Column& column : columns)
      if (column.array == name && column.of_cells == of_cells) {
        if (column.components == array.GetNumberOfComponents() && column.blocks.back() != b) column.blocks.push_back(b);
        return;
      }
    const bool taken = std::any_of(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
    columns.push_back({taken ? name + " (cells)" : name, name, of_cells, array.GetNumberOfComponents(), {b}});
  });
  return columns;
}

std::vector<std::string> others_of(const Opened& opened) {
  std::vector<std::string> words;
  each_array(opened, [&](std::size_t, bool, vtkDataArray& array) {
    if (array.GetNumberOfComponents() <= 3 || is_bookkeeping(name_of(array))) return;
    const std::string word = name_of(array) + " (" + std::to_string(array.GetNumberOfComponents()) + " components)";
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  });
  return words;
}

std::optional<ImageGrid> image_grid(const Opened& opened, const Column& column) {
  if (column.blocks.size() != 1) return std::nullopt;
  const Block& block = opened.blocks[column.blocks.front()];
  auto* image = vtkImageData::SafeDownCast(block.data);
  if (image == nullptr) return std::nullopt;
  // the axes
  field::Mapping mapping;
  if (block.mapping) {
    mapping = *block.mapping;
  } else {
    int extent[6];
    image->GetExtent(extent);
    const double* spacing = image->GetSpacing();
    Mat3 linear;
    double smallest = 1e300;
    for (int a = 0; a < 3; ++a)
      if (spacing[a] != 0 && extent[2 * a + 1] > extent[2 * a]) smallest = std::min(smallest, std::fabs(spacing[a]));
    for (int a = 0; a < 3; ++a) {
      const double step = extent[2 * a + 1] > extent[2 * a] ? spacing[a] : smallest;
      for (int c = 0; c < 3; ++c) linear[a][c] = image->GetDirectionMatrix()->GetElement(c, a) * step;
    }
    double first[3];
    image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], first);
    mapping = field::Mapping::from_linear(linear, Vec3(first[0], first[1], first[2]));
  }
  ImageGrid grid;
  int n[3];
  image->GetDimensions(n);
  Vec3 shift(0.0);
  for (int a = 0; a < 3; ++a) {
    grid.flat[a] = n[a] == 1 || (column.of_cells && n[a] == 2);
    if (column.of_cells && n[a] > 1) {
      --n[a];
      shift[a] = 0.5;
    }
    if (grid.flat[a]) shift[a] -= 0.5, n[a] = 2;
  }
  grid.size = {n[0], n[1], n[2]};
  grid.mapping = field::Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(shift));
  return grid;
}

Written write_image(const Opened& opened, const Column& column, const ImageGrid& grid, const std::string& mask, float* values,
                    std::uint8_t* valid) {
  const Block& block = opened.blocks[column.blocks.front()];
  auto& image = *vtkImageData::SafeDownCast(block.data);
  vtkDataArray& array = *column.in(block);
  Written written;
  int points[3];
  image.GetDimensions(points);
  const std::vector<std::uint8_t> seen = seen_tuples(image, column.of_cells, points);
  vtkDataArray* said = nullptr;
  if (!mask.empty()) {
    said = attributes(block.data, column.of_cells)->GetArray(mask.c_str());
    if (said == nullptr && mask == "valid") said = attributes(block.data, column.of_cells)->GetArray("vtkValidPointMask");
  }
  const int components = column.components == 1 ? 1 : 3;
  int n[3] = {grid.size.x, grid.size.y, grid.size.z}, own[3];
  for (int a = 0; a < 3; ++a) own[a] = grid.flat[a] ? 1 : n[a];
  // one number a voxel, as it lies: at once
  const bool plain =
      column.components == components && own[0] == n[0] && own[1] == n[1] && own[2] == n[2] && array.HasStandardMemoryLayout();
  if (plain) {
    const std::size_t count = static_cast<std::size_t>(array.GetNumberOfTuples()) * static_cast<std::size_t>(components);
    switch (array.GetDataType()) {
      vtkTemplateMacro(written.exact = convert(static_cast<const VTK_TT*>(array.GetVoidPointer(0)), count, values));
    }
  }
  std::size_t at = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i, ++at) {
        const vtkIdType tuple =
            (static_cast<vtkIdType>(std::min(k, own[2] - 1)) * own[1] + std::min(j, own[1] - 1)) * own[0] + std::min(i, own[0] - 1);
        if (!plain) {
          float* to = values + at * static_cast<std::size_t>(components);
          if (column.components == 2) to[2] = 0;
          written.exact = convert_tuple(array, tuple, column.components, to) && written.exact;
        }
        const bool good =
            (seen.empty() || seen[static_cast<std::size_t>(tuple)] != 0) && (said == nullptr || said->GetComponent(tuple, 0) != 0);
        valid[at] = good ? 1 : 0;
        written.all_valid = written.all_valid && good;
      }
  return written;
}

namespace {

/// Pieces of one mesh as one, so that cells on both sides of a cut share its points.
vtkSmartPointer<vtkDataSet> joined_pieces(const Opened& opened, const Column& column) {
  vtkNew<vtkAppendFilter> join;
  join->MergePointsOn();
  for (const std::size_t b : column.blocks) join->AddInputData(opened.blocks[b].data);
  join->Update();
  return join->GetOutput();
}

}  // namespace

std::vector<CellValues> cells_of(const Opened& opened, const Column& column, std::vector<vtkSmartPointer<vtkDataSet>>& keep) {
  std::vector<CellValues> cells;
  if (column.of_cells && column.blocks.size() > 1) {
    Opened whole;
    whole.blocks.push_back({joined_pieces(opened, column), {}});
    Column one = column;
    one.blocks = {0};
    return cells_of(whole, one, keep);
  }
  for (const std::size_t b : column.blocks) {
    const Block& block = opened.blocks[b];
    vtkDataArray* values = column.in(block);
    vtkSmartPointer<vtkDataSet> data = block.data;
    if (column.of_cells) {
      vtkNew<vtkCellDataToPointData> average;
      average->SetInputData(block.data);
      average->PassCellDataOff();
      average->ProcessAllArraysOff();
      average->AddCellDataArray(column.array.c_str());
      average->Update();
      data = vtkDataSet::SafeDownCast(average->GetOutput());
      values = data != nullptr ? data->GetPointData()->GetArray(column.array.c_str()) : nullptr;
    }
    if (values == nullptr) continue;
    keep.push_back(data);
    cells.push_back({data, values});
  }
  return cells;
}

field::GridStats stats_of(const Opened& opened, const Column& column) {
  field::GridStats stats;
  double lo = 1e300, hi = -1e300;
  Vec3 least(1e300), most(-1e300);
  for (const std::size_t b : column.blocks) {
    vtkDataArray* array = column.in(opened.blocks[b]);
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
      Vec3 v(0.0);
      for (int c = 0; c < column.components; ++c) v[c] = array->GetComponent(i, c);
      ++stats.active_voxels;
      if (!is_finite(v)) {
        ++stats.nan_count;
        continue;
      }
      const double size = column.components == 1 ? v.x : norm(v);
      lo = std::min(lo, size);
      hi = std::max(hi, size);
      for (int c = 0; c < 3; ++c) least[c] = std::min(least[c], v[c]), most[c] = std::max(most[c], v[c]);
    }
  }
  if (lo > hi) return stats;
  stats.min = lo;
  stats.max = hi;
  stats.component_min = least;
  stats.component_max = most;
  return stats;
}

}  // namespace catena::vtk
