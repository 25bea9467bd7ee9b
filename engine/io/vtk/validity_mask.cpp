// SPDX-License-Identifier: MIT
#include "engine/io/vtk/validity_mask.h"

#include <vtkCellData.h>
#include <vtkExtractCells.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace catena::vtk {
namespace {

constexpr int kHiddenCell = vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

/// Returns the named array with one number per point, or per cell; null if there is none of the right size.
vtkDataArray* numbers_named(vtkDataSetAttributes* arrays, const char* name, vtkIdType count) {
  vtkDataArray* array = arrays->GetArray(name);
  return array != nullptr && array->GetNumberOfTuples() == count && array->GetNumberOfComponents() == 1 ? array : nullptr;
}

constexpr const char* kGhostLevels = "vtkGhostLevels";  ///< array of old files: above 0 means a duplicate

vtkDataArray* flags_of(vtkDataSetAttributes* arrays, vtkIdType count) {
  vtkDataArray* flags = numbers_named(arrays, vtkDataSetAttributes::GhostArrayName(), count);
  return flags != nullptr ? flags : numbers_named(arrays, kGhostLevels, count);
}

int flags_at(vtkDataArray* flags, vtkIdType i) {
  const double v = flags->GetComponent(i, 0);
  if (std::strcmp(flags->GetName(), kGhostLevels) == 0) return v > 0 ? vtkDataSetAttributes::DUPLICATECELL : 0;
  return v >= -128 && v <= 255 ? static_cast<int>(v) & 255 : 0;
}

/// Calls visit(point index) for the corners of one cell after the other.
class Corners {
 public:
  explicit Corners(vtkDataSet* data) : data_(data) {
    if (auto* image = vtkImageData::SafeDownCast(data)) {
      image_ = true;
      int n[3];
      image->GetDimensions(n);
      for (int a = 0; a < 3; ++a) n_[a] = n[a], m_[a] = std::max(n[a] - 1, 1);
    }
  }
  template <class Visit>
  void each(vtkIdType cell, const Visit& visit) {
    if (!image_) {
      data_->GetCellPoints(cell, ids_);
      for (vtkIdType i = 0; i < ids_->GetNumberOfIds(); ++i) visit(ids_->GetId(i));
      return;
    }
    const vtkIdType i = cell % m_[0], j = cell / m_[0] % m_[1], k = cell / m_[0] / m_[1];
    for (int c = 0; c < 8; ++c)
      visit((std::min(k + (c >> 2), n_[2] - 1) * n_[1] + std::min(j + (c >> 1 & 1), n_[1] - 1)) * n_[0] + std::min(i + (c & 1), n_[0] - 1));
  }

 private:
  vtkDataSet* data_;
  vtkNew<vtkIdList> ids_;
  bool image_ = false;
  vtkIdType n_[3]{}, m_[3]{};
};

/// Cells that a piece owns, identified by their bounds, which are bitwise equal in other pieces that contain duplicates of them.
using Bounds6 = std::array<double, 6>;
std::set<Bounds6> owned_cells(const ImportedData& opened) {
  std::set<Bounds6> owned;
  bool some = false;
  for (const Block& block : opened.blocks) {
    vtkDataArray* flags = flags_of(block.data->GetCellData(), block.data->GetNumberOfCells());
    for (vtkIdType i = 0; flags != nullptr && !some && i < block.data->GetNumberOfCells(); ++i)
      some = (flags_at(flags, i) & vtkDataSetAttributes::DUPLICATECELL) != 0;
  }
  if (!some) return owned;
  for (const Block& block : opened.blocks) {
    vtkDataArray* flags = flags_of(block.data->GetCellData(), block.data->GetNumberOfCells());
    for (vtkIdType i = 0; i < block.data->GetNumberOfCells(); ++i) {
      if (flags != nullptr && (flags_at(flags, i) & (kHiddenCell | vtkDataSetAttributes::DUPLICATECELL)) != 0) continue;
      Bounds6 b;
      block.data->GetCellBounds(i, b.data());
      owned.insert(b);
    }
  }
  return owned;
}

/// Returns whether the data are an unstructured grid with points that belong to no cell.
bool has_loose_points(vtkDataSet* data) {
  if (vtkUnstructuredGrid::SafeDownCast(data) == nullptr || data->GetNumberOfCells() == 0) return false;
  std::vector<bool> is_used(static_cast<std::size_t>(data->GetNumberOfPoints()), false);
  Corners corners(data);
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
    corners.each(i, [&](vtkIdType p) { is_used[static_cast<std::size_t>(p)] = true; });
  return std::find(is_used.begin(), is_used.end(), false) != is_used.end();
}

ValidityMask mask_of_block(vtkDataSet* data, const std::string& mask, std::set<Bounds6>& owned) {
  const vtkIdType points = data->GetNumberOfPoints(), cells = data->GetNumberOfCells();
  const auto masks_of = [&](vtkDataSetAttributes* arrays, vtkIdType count) -> vtkDataArray* {
    if (mask.empty()) return nullptr;
    vtkDataArray* own = numbers_named(arrays, mask.c_str(), count);
    return own == nullptr && mask == "valid" ? numbers_named(arrays, "vtkValidPointMask", count) : own;
  };
  vtkDataArray *point_flags = flags_of(data->GetPointData(), points), *cell_flags = flags_of(data->GetCellData(), cells);
  vtkDataArray *point_mask = masks_of(data->GetPointData(), points), *cell_mask = masks_of(data->GetCellData(), cells);
  ValidityMask result;
  const bool loose = has_loose_points(data);
  if (point_flags == nullptr && cell_flags == nullptr && point_mask == nullptr && cell_mask == nullptr && !loose) return result;
  result.points.assign(static_cast<std::size_t>(points), 1);
  result.cells.assign(static_cast<std::size_t>(cells), 1);
  bool all = true;
  for (vtkIdType i = 0; i < points; ++i) {
    const bool valid = (point_flags == nullptr || (flags_at(point_flags, i) & vtkDataSetAttributes::HIDDENPOINT) == 0) &&
                       (point_mask == nullptr || point_mask->GetComponent(i, 0) != 0);
    result.points[static_cast<std::size_t>(i)] = valid ? 1 : 0;
    all = all && valid;
  }
  Corners corners(data);
  const bool all_points = all;
  for (vtkIdType i = 0; i < cells; ++i) {
    const int flags = cell_flags != nullptr ? flags_at(cell_flags, i) : 0;
    bool valid = (flags & kHiddenCell) == 0 && (cell_mask == nullptr || cell_mask->GetComponent(i, 0) != 0);
    if (!all_points && valid) corners.each(i, [&](vtkIdType p) { valid = valid && result.is_valid_point(p); });
    if (valid && (flags & vtkDataSetAttributes::DUPLICATECELL) != 0) {
      Bounds6 b;
      data->GetCellBounds(i, b.data());
      valid = owned.insert(b).second;
    }
    result.cells[static_cast<std::size_t>(i)] = valid ? 1 : 0;
    all = all && valid;
  }
  // points that no valid cell uses
  if (all && !loose) return {};
  std::vector<std::uint8_t> touched(result.points.size(), 0);  // 1: used by a cell; 2: used by a valid cell
  for (vtkIdType i = 0; i < cells; ++i)
    corners.each(i, [&, mark = static_cast<std::uint8_t>(result.is_valid_cell(i) ? 2 : 1)](vtkIdType p) {
      std::uint8_t& at = touched[static_cast<std::size_t>(p)];
      at = std::max(at, mark);
    });
  for (std::size_t p = 0; p < touched.size(); ++p)
    if (touched[p] == 1 || (touched[p] == 0 && loose)) result.points[p] = 0;
  if (std::find(result.cells.begin(), result.cells.end(), 0) == result.cells.end()) result.cells.clear();
  return result;
}

}  // namespace

std::vector<ValidityMask> make_validity_masks(const ImportedData& opened, const std::string& mask) {
  std::set<Bounds6> owned = owned_cells(opened);
  std::vector<ValidityMask> all;
  for (const Block& block : opened.blocks) all.push_back(mask_of_block(block.data, mask, owned));
  return all;
}

vtkSmartPointer<vtkDataSet> extract_valid_cells(vtkDataSet* data, const ValidityMask& mask) {
  const char* const names[] = {vtkDataSetAttributes::GhostArrayName(), kGhostLevels};
  bool flagged = false;
  for (const char* name : names) flagged = flagged || data->GetPointData()->HasArray(name) != 0 || data->GetCellData()->HasArray(name) != 0;
  if (mask.cells.empty() && !flagged) return data;
  // the ghost flags are removed, because filters would omit additional cells because of them
  vtkSmartPointer<vtkDataSet> plain = vtkSmartPointer<vtkDataSet>::Take(data->NewInstance());
  plain->ShallowCopy(data);
  for (const char* name : names) {
    plain->GetPointData()->RemoveArray(name);
    plain->GetCellData()->RemoveArray(name);
  }
  if (mask.cells.empty()) return plain;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
    if (mask.is_valid_cell(i)) ids->InsertNextId(i);
  vtkNew<vtkExtractCells> extract;
  extract->SetInputData(plain);
  extract->SetCellList(ids);
  extract->Update();
  return extract->GetOutput();
}

bool needs_cell_mask(const field::Index3& size, const std::uint8_t* valid, const std::uint8_t* cells) {
  const auto at = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  };
  for (int k = 0; k + 1 < size.z; ++k)
    for (int j = 0; j + 1 < size.y; ++j)
      for (int i = 0; i + 1 < size.x; ++i) {
        if (cells[at(i, j, k)] != 0) continue;
        bool all = true;
        for (int c = 0; c < 8; ++c) all = all && valid[at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))] != 0;
        if (all) return true;
      }
  return false;
}

}  // namespace catena::vtk
