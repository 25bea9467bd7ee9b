// SPDX-License-Identifier: MIT
#include "engine/io/vtk/arrays.h"

#include <vtkCellData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <map>
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
void each_array(const ImportedData& opened, const Visit& visit) {
  for (const bool of_cells : {false, true})
    for (std::size_t b = 0; b < opened.blocks.size(); ++b) {
      vtkDataSetAttributes* arrays = attributes(opened.blocks[b].data, of_cells);
      for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
        vtkDataArray* array = arrays->GetArray(i);
        if (array != nullptr && array->GetNumberOfTuples() > 0) visit(b, of_cells, *array);
      }
    }
}

}  // namespace

std::string name_of(vtkDataArray& array) { return array.GetName() != nullptr && *array.GetName() != 0 ? array.GetName() : "data"; }

namespace {

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

}  // namespace

vtkDataArray* FieldArray::find_in(const Block& block) const {
  vtkDataSetAttributes* arrays = attributes(block.data, is_cell_data);
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    if (vtkDataArray* one = arrays->GetArray(i); one != nullptr && name_of(*one) == array_name) return one;
  return nullptr;
}

std::vector<FieldArray> list_field_arrays(const ImportedData& opened) {
  std::vector<FieldArray> columns;
  each_array(opened, [&](std::size_t b, bool of_cells, vtkDataArray& array) {
    if (!can_be_field(array)) return;
    const std::string name = name_of(array);
    for (FieldArray& column : columns)
      if (column.array_name == name && column.is_cell_data == of_cells) {
        if (column.components == array.GetNumberOfComponents() && column.block_indices.back() != b) column.block_indices.push_back(b);
        return;
      }
    const bool is_taken = std::any_of(columns.begin(), columns.end(), [&](const FieldArray& column) { return column.name == name; });
    columns.push_back({is_taken ? name + " (cells)" : name, name, of_cells, array.GetNumberOfComponents(), {b}});
  });
  return columns;
}

std::vector<std::string> list_unsupported_arrays(const ImportedData& opened) {
  std::vector<std::string> words;
  each_array(opened, [&](std::size_t, bool, vtkDataArray& array) {
    if (array.GetNumberOfComponents() <= 3 || is_bookkeeping(name_of(array))) return;
    const std::string word = name_of(array) + " (" + std::to_string(array.GetNumberOfComponents()) + " components)";
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  });
  return words;
}

std::optional<ImageGrid> find_image_grid(const ImportedData& opened, const FieldArray& column) {
  if (column.block_indices.size() != 1) return std::nullopt;
  const Block& block = opened.blocks[column.block_indices.front()];
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
    grid.is_flat[a] = n[a] == 1 || (column.is_cell_data && n[a] == 2);
    if (column.is_cell_data && n[a] > 1) {
      --n[a];
      shift[a] = 0.5;
    }
    if (grid.is_flat[a]) shift[a] -= 0.5, n[a] = 2;
  }
  grid.size = {n[0], n[1], n[2]};
  grid.mapping = field::Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(shift));
  return grid;
}

ImageWriteResult write_image(const ImportedData& opened, const FieldArray& column, const ImageGrid& grid, const ValidityMask& mask,
                             float* values, std::uint8_t* valid, std::uint8_t* cells) {
  const Block& block = opened.blocks[column.block_indices.front()];
  vtkDataArray& array = *column.find_in(block);
  ImageWriteResult written;
  const int components = column.components == 1 ? 1 : 3;
  int n[3] = {grid.size.x, grid.size.y, grid.size.z}, data_index[3], cells_along[3];
  for (int a = 0; a < 3; ++a) {
    data_index[a] = grid.is_flat[a] ? 1 : n[a];
    cells_along[a] = std::max(data_index[a] - 1, 1);
  }
  // one contiguous number per voxel: copied at once
  const bool is_contiguous = column.components == components && data_index[0] == n[0] && data_index[1] == n[1] && data_index[2] == n[2] &&
                             array.HasStandardMemoryLayout();
  if (is_contiguous) {
    const std::size_t count = static_cast<std::size_t>(array.GetNumberOfTuples()) * static_cast<std::size_t>(components);
    switch (array.GetDataType()) {
      vtkTemplateMacro(written.is_exact = convert(static_cast<const VTK_TT*>(array.GetVoidPointer(0)), count, values));
    }
  }
  const auto number = [](int i, int j, int k, const int(&size)[3]) {
    return (static_cast<vtkIdType>(std::min(k, size[2] - 1)) * size[1] + std::min(j, size[1] - 1)) * size[0] + std::min(i, size[0] - 1);
  };
  std::size_t at = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i, ++at) {
        const vtkIdType tuple = number(i, j, k, data_index);
        if (!is_contiguous) {
          float* to = values + at * static_cast<std::size_t>(components);
          if (column.components == 2) to[2] = 0;
          written.is_exact = convert_tuple(array, tuple, column.components, to) && written.is_exact;
        }
        const bool is_valid = column.is_cell_data ? mask.is_valid_cell(tuple) : mask.is_valid_point(tuple);
        valid[at] = is_valid ? 1 : 0;
        written.all_valid = written.all_valid && is_valid;
        if (cells == nullptr) continue;
        const bool has_cell = i + 1 < n[0] && j + 1 < n[1] && k + 1 < n[2];
        cells[at] = column.is_cell_data || !has_cell || mask.is_valid_cell(number(i, j, k, cells_along)) ? 1 : 0;
      }
  written.has_cell_mask = cells != nullptr && !column.is_cell_data && needs_cell_mask(grid.size, valid, cells);
  return written;
}

field::GridStats compute_stats(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks) {
  field::GridStats stats;
  double lo = 1e300, hi = -1e300;
  Vec3 minimum(1e300), maximum(-1e300);
  for (const std::size_t b : column.block_indices) {
    vtkDataArray* array = column.find_in(opened.blocks[b]);
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
      if (!(column.is_cell_data ? masks[b].is_valid_cell(i) : masks[b].is_valid_point(i))) continue;
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
      for (int c = 0; c < 3; ++c) minimum[c] = std::min(minimum[c], v[c]), maximum[c] = std::max(maximum[c], v[c]);
    }
  }
  if (lo > hi) return stats;
  stats.min = lo;
  stats.max = hi;
  stats.component_min = minimum;
  stats.component_max = maximum;
  return stats;
}

DisplayRange compute_display_range(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks,
                                   const field::GridStats& stats) {
  constexpr std::uint64_t kSampled = 1u << 17;
  // a sample of the values; the step is not a power of two, because rows may be
  const auto step = static_cast<vtkIdType>(stats.active_voxels > kSampled ? 1 + 2 * (stats.active_voxels / kSampled) : 1);
  const auto each = [&](vtkIdType by, const auto& take) {
    for (const std::size_t b : column.block_indices) {
      vtkDataArray* array = column.find_in(opened.blocks[b]);
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); i += by) {
        if (!(column.is_cell_data ? masks[b].is_valid_cell(i) : masks[b].is_valid_point(i))) continue;
        Vec3 v(0.0);
        for (int c = 0; c < column.components; ++c) v[c] = array->GetComponent(i, c);
        take(column.components == 1 ? v.x : norm(v));
      }
    }
  };
  std::vector<float> sample;
  each(step, [&](double v) { sample.push_back(static_cast<float>(v)); });
  const DisplayRange estimate = display_range(std::move(sample), stats.min, stats.max);
  if (!estimate.has_outliers()) return estimate;
  RangeCounter counter(estimate);
  each(1, [&](double v) { counter.add(v); });
  return counter.range();
}

}  // namespace catena::vtk
