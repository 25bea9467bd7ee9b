// SPDX-License-Identifier: MIT
#include "engine/io/vtk/handle_request.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <new>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/io/sandbox/opened_files.h"
#include "engine/io/vtk/arrays.h"
#include "engine/io/vtk/byte_order.h"
#include "engine/io/vtk/geometry.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

using field::GridInfo;
using field::ReadRequest;
using field::ReadResponse;

std::string list_of(const std::vector<FieldArray>& columns) {
  std::vector<std::string_view> words;
  for (const FieldArray& column : columns) words.push_back(column.name);
  return words.empty() ? "nothing" : join_words(words);
}

std::string type_of(const ImportedData& opened, const FieldArray& column) {
  const std::string word = column.find_in(opened.blocks[column.block_indices.front()])->GetDataTypeAsString();
  return column.components == 1 ? word : fmt::format("{} x {}", word, column.components);
}

/// Handles one request.
class Answer {
 public:
  Answer(const ReadRequest& request, const ImportedData& opened, sandbox::ResponseFile& out)
      : request_(request),
        path_(request.load_request.path),
        opened_(opened),
        columns_(list_field_arrays(opened)),
        masks_(make_validity_masks(opened, request.load_request.mask_grid.value_or(std::string()))),
        out_(out) {}

  Outcome load(ReadResponse& response) {
    CATENA_TRY(const FieldArray* column, choose());
    response.name = column->name;
    response.is_vector = column->components > 1;
    response.dense.components = response.is_vector ? 3 : 1;
    response.dense.type = type_of(opened_, *column);
    if (looks_byte_swapped(*column->find_in(opened_.blocks[column->block_indices.front()]), path_))
      response.notes.push_back(byte_order_advice(path_));
    if (column->components == 2) response.notes.push_back("the vectors have two components; the third is set to 0");
    if (const auto image = find_image_grid(opened_, *column)) return load_image(*column, *image, response);
    return load_cells(*column, response);
  }

  Outcome describe(ReadResponse& response) {
    for (const FieldArray& column : columns_) {
      GridInfo info;
      info.name = column.name;
      info.type = type_of(opened_, column);
      info.is_vector = column.components > 1;
      info.stats = compute_stats(opened_, column, masks_);
      info.display_range = compute_display_range(opened_, column, masks_, info.stats);
      info.is_usable = info.stats.active_voxels > info.stats.nan_count;
      if (const auto image = find_image_grid(opened_, column)) {
        info.size = image->size;
        info.mapping = image->mapping;
      } else {
        std::vector<vtkSmartPointer<vtkDataSet>> owned;
        sandbox::extend_cpu_limit(kSecondsPerVoxel * room_for(column).voxels);
        const std::vector<CellValues> cells = make_cell_values(opened_, column, masks_, owned);
        const auto plan = plan_resampling(cells, room_for(column).voxels);
        info.is_usable = info.is_usable && plan;
        info.element_kind = column.is_cell_data ? field::ElementKind::cells : field::ElementKind::points;
        if (plan) {
          info.type += ", resampled to at least this many voxels";
          info.size = plan->grid.size;
          info.mapping = mapping_of(plan->grid);
          if (const std::string less = coarsened(column, cells, *plan); !less.empty()) response.notes.push_back(column.name + ": " + less);
        }
      }
      info.bytes = static_cast<std::size_t>(info.size.x * info.size.y * info.size.z) * (info.is_vector ? 12 : 4);
      info.series_number = opened_.volume_number;
      info.image_count = opened_.image_count;
      response.grids.push_back(std::move(info));
    }
    return Done{};
  }

 private:
  static field::Mapping mapping_of(const ResampleGrid& lattice) {
    Mat3 linear(0.0);
    for (int a = 0; a < 3; ++a) linear[a][a] = lattice.spacing[a];
    return field::Mapping::from_linear(linear, lattice.origin);
  }

  /// CPU time per resampled voxel: it is located among the cells, repeatedly while the grid is refined.
  static constexpr double kSecondsPerVoxel = 5e-6;

  /// Memory per voxel, in this process and in the grid built from it.
  static double bytes_a_voxel(const FieldArray& column) { return column.components > 1 ? 40 : 20; }

  /// Maximum number of voxels: determined by the file alone, and less only if the user sets a memory limit. Free memory does not count, so
  /// that a file gives the same grid on every system.
  struct Room {
    double voxels, of_file;
  };
  Room room_for(const FieldArray& column) const {
    constexpr double kMaxVoxels = 96e6, kMinVoxels = 8e6, kPerCell = 200, kShare = 0.25;
    double cells = 0;
    for (const std::size_t b : column.block_indices) cells += static_cast<double>(opened_.blocks[b].data->GetNumberOfCells());
    const double of_file = std::clamp(kPerCell * cells, kMinVoxels, kMaxVoxels);
    if (request_.user_memory_limit == 0) return {of_file, of_file};
    return {std::min(of_file, kShare * static_cast<double>(request_.user_memory_limit) / bytes_a_voxel(column)), of_file};
  }

  /// Returns a message fragment about the resolution lost by the user's memory limit; empty if nothing is lost.
  std::string coarsened(const FieldArray& column, const std::vector<CellValues>& cells, const ResamplePlan& plan) const {
    const Room room = room_for(column);
    if (room.voxels == room.of_file) return {};
    const auto full_plan = plan_resampling(cells, room.of_file);
    if (!full_plan || full_plan->grid.voxel_count() == plan.grid.voxel_count()) return {};
    const field::Index3 &n = plan.grid.size, &w = full_plan->grid.size;
    return fmt::format("--memory {:.6g} limits the resampled grid to {} x {} x {} voxels instead of {} x {} x {}",
                       1e-6 * static_cast<double>(request_.user_memory_limit), n.x, n.y, n.z, w.x, w.y, w.z);
  }

  /// Returns an Error if the grid does not fit into memory and the user set no limit: without one nothing is resampled more coarsely.
  Outcome check_room(const FieldArray& column, const ResampleGrid& lattice) const {
    const double bytes = static_cast<double>(lattice.voxel_count()) * bytes_a_voxel(column);
    if (request_.user_memory_limit != 0 || bytes <= static_cast<double>(request_.memory_bytes)) return Done{};
    const double free = std::floor(1e-6 * static_cast<double>(request_.memory_bytes));
    return Error{fmt::format(
        "{}: {}, resampled to {} x {} x {} voxels, needs {:.0f} MB of memory, expected at most {:.0f} MB; --memory {:.0f} "
        "resamples to fewer voxels",
        path_, column.name, lattice.size.x, lattice.size.y, lattice.size.z, std::ceil(1e-6 * bytes), free, std::max(1.0, free))};
  }

  bool has_volume(const FieldArray& column) const {
    std::vector<vtkSmartPointer<vtkDataSet>> owned;
    return find_image_grid(opened_, column) || !make_cell_values(opened_, column, masks_, owned).empty();
  }

  Result<const FieldArray*> choose() const {
    const std::string& name = request_.load_request.grid;
    if (columns_.empty()) return Error{path_ + ": the file has no values that can become a field"};
    const bool is_chosen = name.empty() || !opened_.name.empty();  // the opening function may have chosen the array by another name
    if (is_chosen && columns_.size() == 1) return &columns_.front();
    if (name.empty()) {
      std::vector<FieldArray> fields;
      std::ranges::copy_if(columns_, std::back_inserter(fields), [&](const FieldArray& column) { return has_volume(column); });
      if (fields.empty())
        return Error{fmt::format("{}: the cells of {} have no volume (surfaces, lines or points), expected cells with a volume", path_,
                                 list_of(columns_))};
      if (fields.size() == 1) return &*std::ranges::find(columns_, fields.front().name, &FieldArray::name);
      return Error{fmt::format("{}: the file has several grids, expected the name of one of: {}", path_, list_of(fields))};
    }
    for (const FieldArray& column : columns_)
      if (column.name == name) return &column;
    return Error{fmt::format("{}: there is no grid \"{}\", the file has: {}", path_, name, list_of(columns_))};
  }

  /// Allocates the voxels in the response: their values, one byte each for validity, and one for the cell based at each if `cells` is not
  /// null.
  Outcome allocate(const field::Index3& size, ReadResponse& response, float*& values, std::uint8_t*& valid, std::uint8_t** cells) {
    const double voxels = static_cast<double>(size.x) * size.y * size.z;
    const double bytes = voxels * (4.0 * response.dense.components + (cells != nullptr ? 2 : 1));
    CATENA_CHECK(check_memory_available(fmt::format("{}: the grid of {} x {} x {} voxels", path_, size.x, size.y, size.z), bytes,
                                        request_.memory_bytes));
    response.dense.size = size;
    const auto count = static_cast<std::size_t>(voxels);
    values_ = out_.allocate(count * 4 * static_cast<std::size_t>(response.dense.components), response.dense.values);
    valid_ = out_.allocate(count, response.dense.valid);
    values = reinterpret_cast<float*>(values_.data());
    valid = reinterpret_cast<std::uint8_t*>(valid_.data());
    if (cells == nullptr) return Done{};
    cells_ = out_.allocate(count, response.dense.cells);
    *cells = reinterpret_cast<std::uint8_t*>(cells_.data());
    return Done{};
  }

  Outcome load_image(const FieldArray& column, const ImageGrid& grid, ReadResponse& response) {
    float* values = nullptr;
    std::uint8_t *valid = nullptr, *cells = nullptr;
    const ValidityMask& validity = masks_[column.block_indices.front()];
    CATENA_CHECK(allocate(grid.size, response, values, valid, validity.cells.empty() || column.is_cell_data ? nullptr : &cells));
    response.mapping = grid.mapping;
    const std::string mask = request_.load_request.mask_grid.value_or(std::string());
    if (request_.load_request.mask_required && column.find_in(opened_.blocks[column.block_indices.front()]) != nullptr && !has_array(mask))
      return Error{fmt::format("{}: there is no mask \"{}\"", path_, mask)};
    const ImageWriteResult written = write_image(opened_, column, grid, validity, values, valid, cells);
    if (!written.has_cell_mask) response.dense.cells = {};
    if (written.all_valid && !written.has_cell_mask) response.dense.valid = {};
    if (column.is_cell_data)
      response.notes.push_back(fmt::format("{} has cell values, which are placed at the cell centres{}", column.name,
                                           written.all_valid ? "" : "; holes extend to the centres of the surrounding cells"));
    if (grid.is_flat[0] || grid.is_flat[1] || grid.is_flat[2]) response.notes.push_back("flat data get a thickness of one voxel");
    if (!written.is_exact) response.notes.push_back(fmt::format("values of type {} were rounded to 32-bit floats", response.dense.type));
    return Done{};
  }

  bool has_array(const std::string& name) const {
    for (const Block& block : opened_.blocks)
      if (block.data->GetPointData()->GetArray(name.c_str()) != nullptr || block.data->GetCellData()->GetArray(name.c_str()) != nullptr)
        return true;
    return false;
  }

  Outcome load_cells(const FieldArray& column, ReadResponse& response) {
    sandbox::extend_cpu_limit(kSecondsPerVoxel * room_for(column).voxels);
    std::vector<vtkSmartPointer<vtkDataSet>> owned;
    const std::vector<CellValues> cells = make_cell_values(opened_, column, masks_, owned);
    const auto refused = [&](const Error& e) {
      return Error{fmt::format("{}: {} {} and cannot become a field", path_, column.name, e.message)};
    };
    const auto plan = plan_resampling(cells, room_for(column).voxels);
    if (!plan) return refused(plan.error());
    CATENA_CHECK(check_room(column, plan->grid));
    const auto result = resample(cells, *plan, room_for(column).voxels);
    if (!result) return refused(result.error());
    const field::Index3& n = result->grid.size;
    float* values = nullptr;
    std::uint8_t *valid = nullptr, *own_cells = nullptr;
    const bool masked = needs_cell_mask(n, result->valid.data(), result->cells.data());
    CATENA_CHECK(allocate(n, response, values, valid, masked ? &own_cells : nullptr));
    response.mapping = mapping_of(result->grid);
    std::copy(result->values.begin(), result->values.end(), values);
    std::copy(result->valid.begin(), result->valid.end(), valid);
    if (masked) std::copy(result->cells.begin(), result->cells.end(), own_cells);
    const field::GridStats stats = compute_stats(opened_, column, masks_);
    response.dense.has_range = true;
    response.dense.range = compute_display_range(opened_, column, masks_, stats);
    // the note about the resampling
    vtkIdType count = 0;
    for (const CellValues& block : cells) count += block.data->GetNumberOfCells();
    std::string of = response.is_vector ? "largest length" : "range";
    if (result->range.has_outliers()) of += fmt::format(" without outliers, {:.4g} to {:.4g}", result->range.lo, result->range.hi);
    std::string note = fmt::format(
        "{} cells were resampled to {} x {} x {} voxels: at 99 % of random positions inside the cells the grid differs by at most {:.2g} % "
        "of the {} (maximum {:.2g} %)",
        count, n.x, n.y, n.z, result->error.p99, of, result->error.max);
    if (result->error.p99 > kTargetError && result->refinement_stalled)
      note += "; finer voxels do not reduce the error, because the values change abruptly within less than a voxel";
    else if (result->error.p99 > kTargetError)
      note +=
          fmt::format("; an error below {:g} % needs about {:.2g} million voxels, more than the {:.2g} million that {}", kTargetError,
                      1e-6 * result->required_voxels, 1e-6 * room_for(column).voxels,
                      room_for(column).voxels < room_for(column).of_file ? "--memory allows" : "a file with this number of cells may use");
    response.notes.push_back(note);
    if (column.is_cell_data)
      response.notes.push_back(fmt::format("{} has cell values, which were averaged at the points before resampling", column.name));
    if (stats.nan_count > 0)
      response.notes.push_back(fmt::format("{} values at {} are not finite: cells with such a value are left out", stats.nan_count,
                                           column.is_cell_data ? "cells" : "points"));
    add_losses(response, *result, stats);
    if (const std::string less = coarsened(column, cells, *plan); !less.empty()) response.notes.push_back(less);
    if (!masked && std::all_of(result->valid.begin(), result->valid.end(), [](std::uint8_t v) { return v != 0; }))
      response.dense.valid = {};
    return Done{};
  }

  /// Adds notes about errors of the mask over the whole box, and about extreme values lost in cells that are smaller than voxels.
  static void add_losses(ReadResponse& response, const ResampleResult& result, const field::GridStats& stats) {
    const ResampleShares& shares = result.shares;
    if (shares.falsely_inside + shares.falsely_outside > 0) {
      std::string note = fmt::format(
          "{:.2g} % of random positions in the whole box are outside the cells by less than a voxel, but have a value; {:.2g} % are inside "
          "the cells, but have no value",
          100 * shares.falsely_inside, 100 * shares.falsely_outside);
      if (shares.filled_gaps > 0)
        note += fmt::format("; {:.2g} % are in the middle of gaps that are filled because they are too narrow for these voxels",
                            100 * shares.filled_gaps);
      response.notes.push_back(note);
    }
    const double range = response.is_vector ? stats.max : stats.max - stats.min;
    const bool maximum_lost = stats.max - result.max_value > 0.01 * kTargetError * range,
               bottom = !response.is_vector && result.min_value - stats.min > 0.01 * kTargetError * range;
    if (maximum_lost)
      response.notes.push_back(
          fmt::format("the maximum, {:.6g}, is lost: the grid has {:.6g} at this position", stats.max, result.max_value));
    if (bottom)
      response.notes.push_back(
          fmt::format("the minimum, {:.6g}, is lost: the grid has {:.6g} at this position", stats.min, result.min_value));
  }

  const ReadRequest& request_;
  const std::string& path_;
  const ImportedData& opened_;
  std::vector<FieldArray> columns_;
  std::vector<ValidityMask> masks_;  ///< by block
  sandbox::ResponseFile& out_;
  field::NanoMemory values_, valid_, cells_;
};

/// Describes volumes that are opened one at a time. One that is not a field is listed with the problem; if it is the only one, it is an
/// Error.
Outcome describe_later(const ReadRequest& request, const ImportedData& opened, sandbox::ResponseFile& out, ReadResponse& response) {
  for (const auto& open : opened.deferred_volumes) {
    CATENA_TRY(const ImportedData one, open());
    if (one.problem.empty()) {
      CATENA_CHECK(Answer(request, one, out).describe(response));
      continue;
    }
    if (opened.deferred_volumes.size() == 1) return Error{one.problem};
    GridInfo info;
    info.name = one.name;
    info.type = one.problem;
    info.series_number = one.volume_number;
    info.image_count = one.image_count;
    response.grids.push_back(std::move(info));
  }
  return Done{};
}

void add_words(const ImportedData& opened, ReadResponse& response) {
  response.unit_length = opened.unit_length;
  response.is_patient_space = opened.is_patient_space;
  response.times = opened.times;
  response.time_unit = opened.time_unit;
  response.primitives = find_primitive_kinds(opened);
  for (const FieldArray& column : list_field_arrays(opened)) {
    const auto unit = opened.units.find(column.array_name);
    response.grid_metadata.push_back({column.name, unit != opened.units.end() ? unit->second : "", opened.unit_length, false});
  }
  response.grid_metadata.insert(response.grid_metadata.end(), opened.grid_metadata.begin(), opened.grid_metadata.end());
}

Outcome answer_opened(const ReadRequest& request, const ImportedData& opened, sandbox::ResponseFile& out, ReadResponse& response) {
  response.notes = opened.notes;
  add_words(opened, response);
  Answer answer(request, opened, out);
  switch (request.mode) {
    case field::ReadMode::load:
      return answer.load(response);
    case field::ReadMode::describe:
      if (!opened.deferred_volumes.empty()) return describe_later(request, opened, out, response);
      for (const std::string& other : list_unsupported_arrays(opened)) response.notes.push_back(other + " was left out");
      return answer.describe(response);
    case field::ReadMode::geometry:
      for (const Block& block : opened.blocks)
        if (auto* points = vtkPointSet::SafeDownCast(block.data);
            points != nullptr && looks_byte_swapped(*points->GetPoints()->GetData(), request.load_request.path))
          return Error{fmt::format("{}: the point positions are implausible: {}", request.load_request.path,
                                   byte_order_advice(request.load_request.path))};
      if (const auto done = write_geometry(opened, request.memory_bytes, out, response); !done)
        return Error{fmt::format("{}: {}", request.load_request.path, done.error().message)};
      return Done{};
    default:
      return Done{};
  }
}

/// Adds the step to an error message if there are several, and whether the last step has the missing grid.
std::string with_step(const std::string& what, const ReadRequest& request, const Source& source, const ImportedData& opened) {
  const std::string begin = request.load_request.path + ": ";
  const std::size_t last = opened.times.size() - 1, step = std::min(static_cast<std::size_t>(source.step), last);
  if (opened.times.size() < 2 || !what.starts_with(begin)) return what;
  std::string text = fmt::format("{}at step {} (time {:g}) {}", begin, step, opened.times[step], what.substr(begin.size()));
  const std::vector<FieldArray> columns = list_field_arrays(opened);
  const auto has = [&](const std::vector<FieldArray>& all) {
    return std::ranges::find(all, request.load_request.grid, &FieldArray::name) != all.end();
  };
  if (step == last || request.load_request.grid.empty() || has(columns)) return text;
  Source later = source;
  later.step = static_cast<int>(last);
  const auto other = open_any(later);
  take_reader_errors();
  if (other && has(list_field_arrays(*other))) text += fmt::format("; step {} (time {:g}) has this grid", last, opened.times[last]);
  return text;
}

}  // namespace

ReadResponse handle_request(const ReadRequest& request, const std::string& path, const std::string& folder, sandbox::ResponseFile& out) {
  ReadResponse response;
  const auto failed = [&](const std::string& what) {
    response = {};
    response.error = one_line(what);
    return response;
  };
  try {
    capture_reader_errors();
    const field::LoadRequest& what = request.load_request;
    const Source source{what.path, path, what.grid, what.step, what.axes_xyz, folder, request.mode};
    const auto opened = open_any(source);
    if (!opened) return failed(opened.error().message);
    const auto done = answer_opened(request, *opened, out, response);
    return done ? response : failed(with_step(done.error().message, request, source, *opened));
  } catch (const std::bad_alloc&) {
    return failed(request.load_request.path + ": there is not enough memory to read the file, or the file is damaged");
  } catch (const std::exception& e) {
    out.report(e);
    return failed(fmt::format("{}: the file is damaged or its type is unknown ({})", request.load_request.path, strip_addresses(e.what())));
  }
}

}  // namespace catena::vtk
