#include "engine/vtk/read.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/vtk/arrays.h"
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
      : request_(request), path_(request.what.path), opened_(opened), columns_(columns_of(opened)), out_(out) {}

  Outcome load(ReadReply& reply) {
    CATENA_TRY(const Column* column, choose());
    reply.name = column->name;
    reply.is_vector = column->components > 1;
    reply.dense.components = reply.is_vector ? 3 : 1;
    reply.dense.type = type_of(opened_, *column);
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
      info.stats = stats_of(opened_, column);
      info.usable = info.stats.active_voxels > info.stats.nan_count;
      if (const auto image = image_grid(opened_, column)) {
        info.size = image->size;
        info.mapping = image->mapping;
      } else {
        std::vector<vtkSmartPointer<vtkDataSet>> keep;
        const auto plan = plan_resampling(cells_of(opened_, column, keep), most_voxels(column));
        info.usable = info.usable && plan;
        info.counted = column.of_cells ? field::Counted::cells : field::Counted::points;
        if (plan) {
          info.type += ", resampled";
          info.size = plan->lattice.size;
          info.mapping = mapping_of(plan->lattice);
        }
      }
      info.bytes = static_cast<std::size_t>(info.size.x * info.size.y * info.size.z) * (info.is_vector ? 12 : 4);
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

  double most_voxels(const Column& column) const {
    constexpr double kMost = 96e6, kLeast = 8e6, kPerCell = 200, kShare = 0.25;
    double cells = 0;
    for (const std::size_t b : column.blocks) cells += static_cast<double>(opened_.blocks[b].data->GetNumberOfCells());
    const double bytes_a_voxel = column.components > 1 ? 40 : 20;  // here, and in the grid that is made of it
    return std::min(std::clamp(kPerCell * cells, kLeast, kMost), kShare * static_cast<double>(request_.memory_bytes) / bytes_a_voxel);
  }

  Result<const Column*> choose() const {
    const std::string& name = request_.what.grid;
    if (columns_.empty()) return Error{path_ + ": there are no values in the file that a field could be made of"};
    if (name.empty() && columns_.size() == 1) return &columns_.front();
    if (name.empty()) return Error{fmt::format("{}: the file has several grids, name one of: {}", path_, list_of(columns_))};
    for (const Column& column : columns_)
      if (column.name == name) return &column;
    return Error{fmt::format("{}: there is no grid \"{}\", the file has: {}", path_, name, list_of(columns_))};
  }

  /// Room for the voxels in the answer: their values, and a byte each.
  Outcome allocate(const field::Index3& size, ReadReply& reply, float*& values, std::uint8_t*& valid) {
    const double voxels = static_cast<double>(size.x) * size.y * size.z;
    const double bytes = voxels * (4.0 * reply.dense.components + 1);
    CATENA_CHECK(
        ask_for_memory(fmt::format("{}: the grid of {} x {} x {} voxels", path_, size.x, size.y, size.z), bytes, request_.memory_bytes));
    reply.dense.size = size;
    const auto count = static_cast<std::size_t>(voxels);
    values_ = out_.allocate(count * 4 * static_cast<std::size_t>(reply.dense.components), reply.dense.values);
    valid_ = out_.allocate(count, reply.dense.valid);
    values = reinterpret_cast<float*>(values_.data());
    valid = reinterpret_cast<std::uint8_t*>(valid_.data());
    return Done{};
  }

  Outcome load_image(const Column& column, const ImageGrid& grid, ReadReply& reply) {
    float* values = nullptr;
    std::uint8_t* valid = nullptr;
    CATENA_CHECK(allocate(grid.size, reply, values, valid));
    reply.mapping = grid.mapping;
    const std::string mask = request_.what.valid_grid.value_or(std::string());
    if (request_.what.valid_required && column.in(opened_.blocks[column.blocks.front()]) != nullptr && !has_array(mask))
      return Error{fmt::format("{}: there is no mask \"{}\"", path_, mask)};
    const Written written = write_image(opened_, column, grid, mask, values, valid);
    if (written.all_valid) reply.dense.valid = {};
    if (column.of_cells) reply.notes.push_back(fmt::format("{} belongs to cells: its values sit in their middles", column.name));
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
    std::vector<vtkSmartPointer<vtkDataSet>> keep;
    const std::vector<CellValues> cells = cells_of(opened_, column, keep);
    const auto made = resample(cells, most_voxels(column));
    if (!made) return Error{fmt::format("{}: {} {}, so that no field can be made of it", path_, column.name, made.error().message)};
    float* values = nullptr;
    std::uint8_t* valid = nullptr;
    const field::Index3& n = made->lattice.size;
    CATENA_CHECK(allocate(n, reply, values, valid));
    reply.mapping = mapping_of(made->lattice);
    std::copy(made->values.begin(), made->values.end(), values);
    std::copy(made->valid.begin(), made->valid.end(), valid);
    // in a sentence
    vtkIdType count = 0;
    for (const CellValues& block : cells) count += block.data->GetNumberOfCells();
    std::string note = fmt::format(
        "{} cells resampled to {} x {} x {} voxels: at random places inside the cells it differs by {:.2g} % of the {} (99 % of them; at "
        "most {:.2g} %)",
        count, n.x, n.y, n.z, made->error.p99, reply.is_vector ? "largest length" : "range", made->error.most);
    if (made->error.p99 > kWantedError && made->jumps)
      note += "; finer voxels do not help: the values jump, or bend, within less than a cell";
    else if (made->error.p99 > kWantedError)
      note += fmt::format("; less than {:g} % would take about {:.2g} million voxels, more than there is room for", kWantedError,
                          1e-6 * std::max(made->wanted_voxels, 1.1 * static_cast<double>(made->lattice.voxels())));
    reply.notes.push_back(note);
    if (column.of_cells)
      reply.notes.push_back(fmt::format("{} belongs to cells: its values were averaged at the points first", column.name));
    if (std::all_of(made->valid.begin(), made->valid.end(), [](std::uint8_t v) { return v != 0; })) reply.dense.valid = {};
    return Done{};
  }

  const ReadRequest& request_;
  const std::string& path_;
  const Opened& opened_;
  std::vector<Column> columns_;
  reader::AnswerFile& out_;
  field::NanoMemory values_, valid_;
};

void add_words(const Opened& opened, ReadReply& reply) {
  reply.unit_length = opened.unit_length;
  reply.patient = opened.patient;
  reply.times = opened.times;
  reply.shapes = shapes_of(opened);
  for (const Column& column : columns_of(opened)) {
    const auto unit = opened.units.find(column.array);
    reply.words.push_back({column.name, unit != opened.units.end() ? unit->second : "", opened.unit_length, false});
  }
}

Outcome answer_opened(const ReadRequest& request, const Opened& opened, reader::AnswerFile& out, ReadReply& reply) {
  reply.notes = opened.notes;
  add_words(opened, reply);
  Answer answer(request, opened, out);
  switch (request.mode) {
    case field::ReadMode::load:
      return answer.load(reply);
    case field::ReadMode::describe:
      for (const std::string& other : others_of(opened)) reply.notes.push_back(other + " is left out");
      return answer.describe(reply);
    case field::ReadMode::shape:
      if (const auto done = answer_shape(opened, request.memory_bytes, out, reply); !done)
        return Error{fmt::format("{}: {}", request.what.path, done.error().message)};
      return Done{};
    default:
      return Done{};
  }
}

}  // namespace

ReadReply answer(const ReadRequest& request, const std::string& path, reader::AnswerFile& out) {
  ReadReply reply;
  const auto failed = [&](const std::string& what) {
    reply = {};
    reply.error = one_line(what);
    return reply;
  };
  try {
    set_memory_limit(request.memory_bytes);
    listen_to_complaints();
    const field::LoadRequest& what = request.what;
    const auto opened = open_any({what.path, path, what.grid, what.step, what.axes_xyz});
    if (!opened) return failed(opened.error().message);
    const auto done = answer_opened(request, *opened, out, reply);
    return done ? reply : failed(done.error().message);
  } catch (const std::bad_alloc&) {
    return failed(request.what.path + ": not enough memory to read it (or the file is damaged)");
  } catch (const std::exception& e) {
    return failed(fmt::format("{}: the file is damaged or of an unknown kind ({})", request.what.path, e.what()));
  }
}

}  // namespace catena::vtk
