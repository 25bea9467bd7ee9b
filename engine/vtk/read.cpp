#include "engine/vtk/read.h"

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
#include "engine/reader/opened.h"
#include "engine/vtk/arrays.h"
#include "engine/vtk/byte_order.h"
#include "engine/vtk/open.h"
#include "engine/vtk/shape.h"

namespace catena::vtk {
namespace {

using field::GridInfo;
using field::ReadReply;
using field::ReadRequest;

std::string list_of(const std::vector<Column>& columns) {
  std::vector<std::string_view> words;
  for (const Column& column : columns) words.push_back(column.name);
  return words.empty() ? "nothing" : joined(words);
}

std::string type_of(const Opened& opened, const Column& column) {
  const std::string word = column.in(opened.blocks[column.blocks.front()])->GetDataTypeAsString();
  return column.components == 1 ? word : fmt::format("{} x {}", word, column.components);
}

/// One request while it is answered.
class Answer {
 public:
  Answer(const ReadRequest& request, const Opened& opened, reader::AnswerFile& out)
      : request_(request),
        path_(request.what.path),
        opened_(opened),
        columns_(columns_of(opened)),
        seen_(seen_of(opened, request.what.valid_grid.value_or(std::string()))),
        out_(out) {}

  Outcome load(ReadReply& reply) {
    CATENA_TRY(const Column* column, choose());
    reply.name = column->name;
    reply.is_vector = column->components > 1;
    reply.dense.components = reply.is_vector ? 3 : 1;
    reply.dense.type = type_of(opened_, *column);
    if (looks_swapped(*column->in(opened_.blocks[column->blocks.front()]), path_)) reply.notes.push_back(byte_order_advice(path_));
    if (column->components == 2) reply.notes.push_back("vectors of two components have got a third, 0");
    if (const auto image = image_grid(opened_, *column)) return load_image(*column, *image, reply);
    return load_cells(*column, reply);
  }

  Outcome describe(ReadReply& reply) {
    for (const Column& column : columns_) {
      GridInfo info;
      info.name = column.name;
      info.type = type_of(opened_, column);
      info.is_vector = column.components > 1;
      info.stats = stats_of(opened_, column, seen_);
      info.shown = shown_of(opened_, column, seen_, info.stats);
      info.usable = info.stats.active_voxels > info.stats.nan_count;
      if (const auto image = image_grid(opened_, column)) {
        info.size = image->size;
        info.mapping = image->mapping;
      } else {
        std::vector<vtkSmartPointer<vtkDataSet>> keep;
        reader::allow_time(kSecondsPerVoxel * room_for(column).voxels);
        const std::vector<CellValues> cells = cells_of(opened_, column, seen_, keep);
        const auto plan = plan_resampling(cells, room_for(column).voxels);
        info.usable = info.usable && plan;
        info.counted = column.of_cells ? field::Counted::cells : field::Counted::points;
        if (plan) {
          info.type += ", resampled to so many voxels or more";
          info.size = plan->lattice.size;
          info.mapping = mapping_of(plan->lattice);
          if (const std::string less = coarsened(column, cells, *plan); !less.empty()) reply.notes.push_back(column.name + ": " + less);
        }
      }
      info.bytes = static_cast<std::size_t>(info.size.x * info.size.y * info.size.z) * (info.is_vector ? 12 : 4);
      info.number = opened_.number;
      info.images = opened_.images;
      reply.grids.push_back(std::move(info));
    }
    return Done{};
  }

 private:
  static field::Mapping mapping_of(const Lattice& lattice) {
    Mat3 linear(0.0);
    for (int a = 0; a < 3; ++a) linear[a][a] = lattice.spacing[a];
    return field::Mapping::from_linear(linear, lattice.origin);
  }

  /// What a resampled voxel may cost: it is found among the cells, and tried again while the grid is refined.
  static constexpr double kSecondsPerVoxel = 5e-6;

  /// In memory, here and in the grid that is made of it.
  static double bytes_a_voxel(const Column& column) { return column.components > 1 ? 40 : 20; }

  /// How many voxels there may be: by the file alone, and less only where the user states an allowance. What is free on the machine does
  /// not count, so that a file becomes the same grid everywhere.
  struct Room {
    double voxels, of_file;
  };
  Room room_for(const Column& column) const {
    constexpr double kMost = 96e6, kLeast = 8e6, kPerCell = 200, kShare = 0.25;
    double cells = 0;
    for (const std::size_t b : column.blocks) cells += static_cast<double>(opened_.blocks[b].data->GetNumberOfCells());
    const double of_file = std::clamp(kPerCell * cells, kLeast, kMost);
    if (request_.stated_memory == 0) return {of_file, of_file};
    return {std::min(of_file, kShare * static_cast<double>(request_.stated_memory) / bytes_a_voxel(column)), of_file};
  }

  /// What the stated allowance costs, as a sentence without an end; empty: nothing.
  std::string coarsened(const Column& column, const std::vector<CellValues>& cells, const ResamplePlan& plan) const {
    const Room room = room_for(column);
    if (room.voxels == room.of_file) return {};
    const auto whole = plan_resampling(cells, room.of_file);
    if (!whole || whole->lattice.voxels() == plan.lattice.voxels()) return {};
    const field::Index3 &n = plan.lattice.size, &w = whole->lattice.size;
    return fmt::format("--memory {:.6g} has it resampled to {} x {} x {} voxels instead of {} x {} x {}",
                       1e-6 * static_cast<double>(request_.stated_memory), n.x, n.y, n.z, w.x, w.y, w.z);
  }

  /// Without a stated allowance nothing is made coarser: what does not fit is refused.
  Outcome check_room(const Column& column, const Lattice& lattice) const {
    const double bytes = static_cast<double>(lattice.voxels()) * bytes_a_voxel(column);
    if (request_.stated_memory != 0 || bytes <= static_cast<double>(request_.memory_bytes)) return Done{};
    const double free = std::floor(1e-6 * static_cast<double>(request_.memory_bytes));
    return Error{fmt::format(
        "{}: {} resampled to {} x {} x {} voxels needs {:.0f} MB of memory, expected at most {:.0f} MB; --memory {:.0f} "
        "resamples it to fewer voxels",
        path_, column.name, lattice.size.x, lattice.size.y, lattice.size.z, std::ceil(1e-6 * bytes), free, std::max(1.0, free))};
  }

  bool has_volume(const Column& column) const {
    std::vector<vtkSmartPointer<vtkDataSet>> keep;
    return image_grid(opened_, column) || !cells_of(opened_, column, seen_, keep).empty();
  }

  Result<const Column*> choose() const {
    const std::string& name = request_.what.grid;
    if (columns_.empty()) return Error{path_ + ": there are no values in the file that a field could be made of"};
    const bool chosen = name.empty() || !opened_.name.empty();  // by whoever opened it, by other names, too
    if (chosen && columns_.size() == 1) return &columns_.front();
    if (name.empty()) {
      std::vector<Column> fields;
      std::ranges::copy_if(columns_, std::back_inserter(fields), [&](const Column& column) { return has_volume(column); });
      if (fields.empty())
        return Error{fmt::format("{}: the cells of {} have no volume (surfaces, lines or points), so that no field can be made of them",
                                 path_, list_of(columns_))};
      if (fields.size() == 1) return &*std::ranges::find(columns_, fields.front().name, &Column::name);
      return Error{fmt::format("{}: the file has several grids, name one of: {}", path_, list_of(fields))};
    }
    for (const Column& column : columns_)
      if (column.name == name) return &column;
    return Error{fmt::format("{}: there is no grid \"{}\", the file has: {}", path_, name, list_of(columns_))};
  }

  /// Room for the voxels in the answer: their values, a byte each, and one for the cell based at each where `cells` is not null.
  Outcome allocate(const field::Index3& size, ReadReply& reply, float*& values, std::uint8_t*& valid, std::uint8_t** cells) {
    const double voxels = static_cast<double>(size.x) * size.y * size.z;
    const double bytes = voxels * (4.0 * reply.dense.components + (cells != nullptr ? 2 : 1));
    CATENA_CHECK(
        ask_for_memory(fmt::format("{}: the grid of {} x {} x {} voxels", path_, size.x, size.y, size.z), bytes, request_.memory_bytes));
    reply.dense.size = size;
    const auto count = static_cast<std::size_t>(voxels);
    values_ = out_.allocate(count * 4 * static_cast<std::size_t>(reply.dense.components), reply.dense.values);
    valid_ = out_.allocate(count, reply.dense.valid);
    values = reinterpret_cast<float*>(values_.data());
    valid = reinterpret_cast<std::uint8_t*>(valid_.data());
    if (cells == nullptr) return Done{};
    cells_ = out_.allocate(count, reply.dense.cells);
    *cells = reinterpret_cast<std::uint8_t*>(cells_.data());
    return Done{};
  }

  Outcome load_image(const Column& column, const ImageGrid& grid, ReadReply& reply) {
    float* values = nullptr;
    std::uint8_t *valid = nullptr, *cells = nullptr;
    const Seen& seen = seen_[column.blocks.front()];
    CATENA_CHECK(allocate(grid.size, reply, values, valid, seen.cells.empty() || column.of_cells ? nullptr : &cells));
    reply.mapping = grid.mapping;
    const std::string mask = request_.what.valid_grid.value_or(std::string());
    if (request_.what.valid_required && column.in(opened_.blocks[column.blocks.front()]) != nullptr && !has_array(mask))
      return Error{fmt::format("{}: there is no mask \"{}\"", path_, mask)};
    const Written written = write_image(opened_, column, grid, seen, values, valid, cells);
    if (!written.cells) reply.dense.cells = {};
    if (written.all_valid && !written.cells) reply.dense.valid = {};
    if (column.of_cells)
      reply.notes.push_back(fmt::format("{} belongs to cells: its values sit in their middles{}", column.name,
                                        written.all_valid ? "" : ", and holes reach to the middles of the cells around them"));
    if (grid.flat[0] || grid.flat[1] || grid.flat[2]) reply.notes.push_back("what is flat has got a thickness of one voxel");
    if (!written.exact) reply.notes.push_back(fmt::format("values of type {} are rounded to 32-bit floats", reply.dense.type));
    return Done{};
  }

  bool has_array(const std::string& name) const {
    for (const Block& block : opened_.blocks)
      if (block.data->GetPointData()->GetArray(name.c_str()) != nullptr || block.data->GetCellData()->GetArray(name.c_str()) != nullptr)
        return true;
    return false;
  }

  Outcome load_cells(const Column& column, ReadReply& reply) {
    reader::allow_time(kSecondsPerVoxel * room_for(column).voxels);
    std::vector<vtkSmartPointer<vtkDataSet>> keep;
    const std::vector<CellValues> cells = cells_of(opened_, column, seen_, keep);
    const auto refused = [&](const Error& e) {
      return Error{fmt::format("{}: {} {}, so that no field can be made of it", path_, column.name, e.message)};
    };
    const auto plan = plan_resampling(cells, room_for(column).voxels);
    if (!plan) return refused(plan.error());
    CATENA_CHECK(check_room(column, plan->lattice));
    const auto made = resample(cells, *plan, room_for(column).voxels);
    if (!made) return refused(made.error());
    const field::Index3& n = made->lattice.size;
    float* values = nullptr;
    std::uint8_t *valid = nullptr, *own_cells = nullptr;
    const bool masked = needs_cells(n, made->valid.data(), made->cells.data());
    CATENA_CHECK(allocate(n, reply, values, valid, masked ? &own_cells : nullptr));
    reply.mapping = mapping_of(made->lattice);
    std::copy(made->values.begin(), made->values.end(), values);
    std::copy(made->valid.begin(), made->valid.end(), valid);
    if (masked) std::copy(made->cells.begin(), made->cells.end(), own_cells);
    const field::GridStats stats = stats_of(opened_, column, seen_);
    reply.dense.has_range = true;
    reply.dense.range = shown_of(opened_, column, seen_, stats);
    // in a sentence
    vtkIdType count = 0;
    for (const CellValues& block : cells) count += block.data->GetNumberOfCells();
    std::string of = reply.is_vector ? "largest length" : "range";
    if (made->range.is_cut()) of += fmt::format(" without outliers, {:.4g} to {:.4g}", made->range.lo, made->range.hi);
    std::string note = fmt::format(
        "{} cells resampled to {} x {} x {} voxels: at random places inside the cells it differs by {:.2g} % of the {} (99 % of them; at "
        "most {:.2g} %)",
        count, n.x, n.y, n.z, made->error.p99, of, made->error.most);
    if (made->error.p99 > kWantedError && made->jumps)
      note += "; finer voxels hardly help: the values jump, or bend, within less than a voxel";
    else if (made->error.p99 > kWantedError)
      note += fmt::format("; less than {:g} % would take about {:.2g} million voxels, more than the {:.2g} million that {}", kWantedError,
                          1e-6 * made->wanted_voxels, 1e-6 * room_for(column).voxels,
                          room_for(column).voxels < room_for(column).of_file ? "--memory allows" : "a file of so many cells gets");
    reply.notes.push_back(note);
    if (column.of_cells)
      reply.notes.push_back(fmt::format("{} belongs to cells: its values were averaged at the points first", column.name));
    if (stats.nan_count > 0)
      reply.notes.push_back(fmt::format("{} values of {} are not finite: no cell that has one is read", stats.nan_count,
                                        column.of_cells ? "cells" : "points"));
    add_losses(reply, *made, stats);
    if (const std::string less = coarsened(column, cells, *plan); !less.empty()) reply.notes.push_back(less);
    if (!masked && std::all_of(made->valid.begin(), made->valid.end(), [](std::uint8_t v) { return v != 0; })) reply.dense.valid = {};
    return Done{};
  }

  /// What is said of the whole box, and of values that cells smaller than voxels hold.
  static void add_losses(ReadReply& reply, const Resampled& made, const field::GridStats& stats) {
    const ResampleShares& shares = made.shares;
    if (shares.became_inside + shares.became_outside > 0) {
      std::string note = fmt::format(
          "of random places in the whole box {:.2g} % are outside the cells, less than a voxel from one, and have a value; {:.2g} % are "
          "inside "
          "and have none",
          100 * shares.became_inside, 100 * shares.became_outside);
      if (shares.in_gaps > 0)
        note += fmt::format("; {:.2g} % are in the middle of gaps too narrow for these voxels, which are filled", 100 * shares.in_gaps);
      reply.notes.push_back(note);
    }
    const double range = reply.is_vector ? stats.max : stats.max - stats.min;
    const bool top = stats.max - made.most > 0.01 * kWantedError * range,
               bottom = !reply.is_vector && made.least - stats.min > 0.01 * kWantedError * range;
    if (top)
      reply.notes.push_back(fmt::format("the greatest value, {:.6g}, is lost: at its place the grid has {:.6g}", stats.max, made.most));
    if (bottom)
      reply.notes.push_back(fmt::format("the least value, {:.6g}, is lost: at its place the grid has {:.6g}", stats.min, made.least));
  }

  const ReadRequest& request_;
  const std::string& path_;
  const Opened& opened_;
  std::vector<Column> columns_;
  std::vector<Seen> seen_;  ///< by block
  reader::AnswerFile& out_;
  field::NanoMemory values_, valid_, cells_;
};

/// Volumes that are opened one at a time. One that is no field is listed with the reason; alone it is an error.
Outcome describe_later(const ReadRequest& request, const Opened& opened, reader::AnswerFile& out, ReadReply& reply) {
  for (const auto& open : opened.later) {
    CATENA_TRY(const Opened one, open());
    if (one.trouble.empty()) {
      CATENA_CHECK(Answer(request, one, out).describe(reply));
      continue;
    }
    if (opened.later.size() == 1) return Error{one.trouble};
    GridInfo info;
    info.name = one.name;
    info.type = one.trouble;
    info.number = one.number;
    info.images = one.images;
    reply.grids.push_back(std::move(info));
  }
  return Done{};
}

void add_words(const Opened& opened, ReadReply& reply) {
  reply.unit_length = opened.unit_length;
  reply.patient = opened.patient;
  reply.times = opened.times;
  reply.time_unit = opened.time_unit;
  reply.shapes = shapes_of(opened);
  for (const Column& column : columns_of(opened)) {
    const auto unit = opened.units.find(column.array);
    reply.words.push_back({column.name, unit != opened.units.end() ? unit->second : "", opened.unit_length, false});
  }
  reply.words.insert(reply.words.end(), opened.words.begin(), opened.words.end());
}

Outcome answer_opened(const ReadRequest& request, const Opened& opened, reader::AnswerFile& out, ReadReply& reply) {
  reply.notes = opened.notes;
  add_words(opened, reply);
  Answer answer(request, opened, out);
  switch (request.mode) {
    case field::ReadMode::load:
      return answer.load(reply);
    case field::ReadMode::describe:
      if (!opened.later.empty()) return describe_later(request, opened, out, reply);
      for (const std::string& other : others_of(opened)) reply.notes.push_back(other + " is left out");
      return answer.describe(reply);
    case field::ReadMode::shape:
      for (const Block& block : opened.blocks)
        if (auto* points = vtkPointSet::SafeDownCast(block.data);
            points != nullptr && looks_swapped(*points->GetPoints()->GetData(), request.what.path))
          return Error{fmt::format("{}: its places are no shape: {}", request.what.path, byte_order_advice(request.what.path))};
      if (const auto done = answer_shape(opened, request.memory_bytes, out, reply); !done)
        return Error{fmt::format("{}: {}", request.what.path, done.error().message)};
      return Done{};
    default:
      return Done{};
  }
}

/// Which step an error is about, where there are several, and whether the last one has the grid that is missing.
std::string with_step(const std::string& what, const ReadRequest& request, const Source& source, const Opened& opened) {
  const std::string begin = request.what.path + ": ";
  const std::size_t last = opened.times.size() - 1, step = std::min(static_cast<std::size_t>(source.step), last);
  if (opened.times.size() < 2 || !what.starts_with(begin)) return what;
  std::string text = fmt::format("{}at step {} (time {:g}) {}", begin, step, opened.times[step], what.substr(begin.size()));
  const std::vector<Column> columns = columns_of(opened);
  const auto has = [&](const std::vector<Column>& all) { return std::ranges::find(all, request.what.grid, &Column::name) != all.end(); };
  if (step == last || request.what.grid.empty() || has(columns)) return text;
  Source later = source;
  later.step = static_cast<int>(last);
  const auto other = open_any(later);
  take_complaint();
  if (other && has(columns_of(*other))) text += fmt::format("; step {} (time {:g}) has it", last, opened.times[last]);
  return text;
}

}  // namespace

ReadReply answer(const ReadRequest& request, const std::string& path, const std::string& folder, reader::AnswerFile& out) {
  ReadReply reply;
  const auto failed = [&](const std::string& what) {
    reply = {};
    reply.error = one_line(what);
    return reply;
  };
  try {
    listen_to_complaints();
    const field::LoadRequest& what = request.what;
    const Source source{what.path, path, what.grid, what.step, what.axes_xyz, folder, request.mode};
    const auto opened = open_any(source);
    if (!opened) return failed(opened.error().message);
    const auto done = answer_opened(request, *opened, out, reply);
    return done ? reply : failed(with_step(done.error().message, request, source, *opened));
  } catch (const std::bad_alloc&) {
    return failed(request.what.path + ": not enough memory to read it (or the file is damaged)");
  } catch (const std::exception& e) {
    out.note(e);
    return failed(fmt::format("{}: the file is damaged or of an unknown kind ({})", request.what.path, without_addresses(e.what())));
  }
}

}  // namespace catena::vtk
