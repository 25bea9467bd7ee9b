// SPDX-License-Identifier: MIT
#include "engine/io/vdb/handle_request.h"

#include <fmt/format.h>

#include <new>
#include <optional>

#include "engine/base/text.h"
#include "engine/field/grid/grid_factory.h"
#include "engine/field/nanovdb/nano_statistics.h"
#include "engine/io/vdb/to_nano.h"
#include "engine/io/vdb/vdb_file.h"
#include "engine/io/volume/crop.h"

namespace catena::vdb {
namespace {

using field::ActiveBox;
using field::GridInfo;
using field::LoadRequest;
using field::Mapping;
using field::NanoAllocator;
using field::NanoMemory;
using field::ReadRequest;
using field::ReadResponse;
using nanovdb::ValueMask;
using ValueMaskGrid = nanovdb::NanoGrid<ValueMask>;

Result<Mapping> mapping_of(const openvdb::GridBase& grid) {
  const auto map = grid.transform().baseMap();
  if (!map->isLinear()) return Error{"has a perspective (frustum) transform, expected a linear one"};
  const openvdb::Mat4d m = map->getAffineMap()->getMat4();  // the rows are the transformed axes
  Mat3 j;
  for (int a = 0; a < 3; ++a) j[a] = Vec3(m(a, 0), m(a, 1), m(a, 2));
  const Mapping mapping = Mapping::from_linear(j, Vec3(m(3, 0), m(3, 1), m(3, 2)));
  if (!is_finite(mapping.origin) || !is_finite(mapping.index_from_world(Vec3(1.0))) || !(mapping.min_voxel_edge() > 0))
    return Error{"has a transform that cannot be inverted"};
  return mapping;
}

bool same_mapping(const Mapping& a, const Mapping& b) {
  const double edge = a.min_voxel_edge();
  for (int c = 0; c < 3; ++c)
    if (norm(a.world_from_index_linear[c] - b.world_from_index_linear[c]) > 1e-6 * edge) return false;
  return norm(a.origin - b.origin) <= 1e-3 * edge;
}

/// Calls use(tree) for the first matching grid type in `Grids`; returns false if none matches.
template <class... Grids, class Use>
bool with_tree(const openvdb::GridBase::Ptr& grid, const Use& use) {
  const auto one = [&]<class Grid>(const Grid*) {
    const auto typed = openvdb::gridPtrCast<Grid>(grid);
    if (typed) use(typed->tree());
    return static_cast<bool>(typed);
  };
  return (one(static_cast<const Grids*>(nullptr)) || ...);
}

template <class Use>
bool with_scalars(const openvdb::GridBase::Ptr& grid, const Use& use) {
  return with_tree<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid>(grid, use);
}

template <class Use>
bool with_vectors(const openvdb::GridBase::Ptr& grid, const Use& use) {
  return with_tree<openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>(grid, use);
}

/// Calls use(tree) for a bool grid, whose true voxels are valid, or a mask grid, whose active voxels are valid; returns false for other
/// grids.
template <class Use>
bool with_mask(const openvdb::GridBase::Ptr& grid, const Use& use) {
  return with_tree<openvdb::BoolGrid, openvdb::MaskGrid>(grid, use);
}

/// Returns the requested entry, or the only usable one.
Result<const VdbEntry*> choose(const VdbFile& f, const LoadRequest& request) {
  const auto& entries = f.entries();
  const auto usable = [](const VdbEntry& e) { return is_scalar_type(type_name(e)) || is_vector_type(type_name(e)); };
  if (!request.grid.empty()) {
    const VdbEntry* e = f.find(request.grid);
    if (!e) return Error{fmt::format("{}: there is no grid \"{}\", the file has: {}", request.path, request.grid, format_entries(entries))};
    if (!usable(*e))
      return Error{fmt::format("{}: grid \"{}\" is of type {}, expected a scalar (float, half, double, int32, int64) or a 3-vector grid",
                               request.path, request.grid, type_name(*e))};
    return e;
  }
  const VdbEntry* only = nullptr;
  int count = 0;
  for (const VdbEntry& e : entries)
    if (usable(e)) only = &e, ++count;
  if (count == 1) return only;
  if (count == 0)
    return Error{fmt::format("{}: there is no scalar or 3-vector grid; the file has: {}", request.path, format_entries(entries))};
  return Error{fmt::format("{}: the file has several grids, expected the name of one of: {}", request.path, format_entries(entries))};
}

/// Handles one request.
class Answer {
 public:
  Answer(const ReadRequest& request, VdbFile& file, sandbox::ResponseFile& out)
      : request_(request), what_(request.load_request), file_(file), out_(out) {}

  Outcome load(ReadResponse& response) {
    CATENA_TRY(const VdbEntry* entry, choose(file_, what_));
    response.name = entry->name;
    const auto about = [&](const Error& e) { return Error{fmt::format("{}: grid \"{}\" {}", what_.path, entry->name, e.message)}; };
    openvdb::GridBase::Ptr grid = file_.read(*entry, part());
    if (!grid) return not_a_field(*entry);
    const auto mapping = mapping_of(*grid);
    if (!mapping) return about(mapping.error());
    response.mapping = *mapping;
    // the values; the tree is freed before the mask is read
    const std::string name = fmt::format("{}: grid \"{}\"", what_.path, entry->name);
    Result<NanoMemory> values = Error{};
    const bool scalar = with_scalars(grid, [&](const auto& tree) { values = to_nano<float>(tree, name, left(), into(response.values)); });
    response.is_vector = !scalar && with_vectors(grid, [&](const auto& tree) {
      values = to_nano<nanovdb::Vec3f>(tree, name, left(), into(response.values));
    });
    if (!scalar && !response.is_vector) return not_a_field(*entry);
    if (!values) return values.error();
    grid.reset();
    const ActiveBox box = scalar ? field::compute_active_box(field::as_nano_grid<float>(*values))
                                 : field::compute_active_box(field::as_nano_grid<nanovdb::Vec3f>(*values));
    if (box.empty() && what_.crop) return about(Error{"has no active voxels inside \"crop\"; a box that overlaps the data was expected"});
    if (box.empty()) return about(Error{"has no active voxels, expected a grid with data"});
    if (!is_within_index_limits(box)) return about(field::index_range_error(box));
    return load_mask(response, box);
  }

  Outcome describe(ReadResponse& response) {
    for (const VdbEntry& entry : file_.entries()) {
      CATENA_TRY(GridInfo info, describe(entry));
      response.grids.push_back(std::move(info));
    }
    return Done{};
  }

 private:
  std::uint64_t left() const { return request_.memory_bytes; }
  /// Returns the region that "crop" leaves of a grid; the whole grid if its transform is going to be refused.
  VdbFile::RegionSelector part() const {
    if (!what_.crop) return {};
    return [crop = *what_.crop](const openvdb::GridBase& grid) {
      const auto mapping = mapping_of(grid);
      if (!mapping) return openvdb::CoordBBox();
      const ActiveBox box = field::voxels_in_box(crop, *mapping);
      return openvdb::CoordBBox(box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]);
    };
  }
  NanoAllocator into(field::BufferRange& piece) {
    return [this, &piece](std::size_t bytes) { return out_.allocate(bytes, piece); };
  }
  Error not_a_field(const VdbEntry& entry) const {
    return Error{
        fmt::format("{}: grid \"{}\" is of type {}, expected a scalar or 3-vector grid", what_.path, entry.name, type_name(entry))};
  }

  Outcome load_mask(ReadResponse& response, const ActiveBox& box) {
    if (!what_.mask_grid) return Done{};
    const VdbEntry* entry = file_.find(*what_.mask_grid);
    if (!entry) {
      if (!what_.mask_required) return Done{};
      return Error{fmt::format("{}: there is no grid \"{}\" for the mask, the file has: {}", what_.path, *what_.mask_grid,
                               format_entries(file_.entries()))};
    }
    const std::string word = type_name(*entry);
    if (word != "bool" && word != "mask")
      return Error{fmt::format("{}: the mask \"{}\" is of type {}, expected bool", what_.path, entry->name, word)};
    const auto grid = file_.read(*entry, part());
    CATENA_TRY(const Mapping mask_mapping, mapping_of(*grid));
    if (!same_mapping(response.mapping, mask_mapping))
      return Error{
          fmt::format("{}: the transforms of the mask \"{}\" and the grid differ, expected equal ones (\"valid\": null ignores the mask)",
                      what_.path, entry->name)};
    const std::string name = fmt::format("{}: the mask \"{}\"", what_.path, entry->name);
    Result<NanoMemory> voxels = Error{};
    response.has_mask =
        with_mask(grid, [&](const auto& tree) { voxels = to_nano<ValueMask>(tree, name, left(), into(response.valid_voxels)); });
    if (!response.has_mask) return Done{};
    if (!voxels) return voxels.error();
    CATENA_TRY(const NanoMemory own_cells, cell_mask(response, *what_.mask_grid));
    const ValueMaskGrid* by_cells = response.has_cell_mask ? &field::as_nano_grid<ValueMask>(own_cells) : nullptr;
    const auto check_memory = [&](double bytes) { return check_memory_available(name, bytes, left()); };
    CATENA_TRY(const NanoMemory cells,
               field::erode_mask(field::as_nano_grid<ValueMask>(*voxels), box, by_cells, into(response.valid_cells), check_memory));
    return Done{};
  }

  /// Returns the cell mask that belongs to a voxel mask; empty if there is none.
  Result<NanoMemory> cell_mask(ReadResponse& response, const std::string& of) {
    const VdbEntry* entry = file_.find(of + "_cells");
    if (!entry || (type_name(*entry) != "bool" && type_name(*entry) != "mask")) return NanoMemory();
    const std::string name = fmt::format("{}: the mask \"{}\"", what_.path, entry->name);
    const auto grid = file_.read(*entry, part());
    CATENA_TRY(const Mapping mask_mapping, mapping_of(*grid));
    if (!same_mapping(response.mapping, mask_mapping))
      return Error{name + " and the grid have different transforms, expected equal ones (\"valid\": null ignores the mask)"};
    Result<NanoMemory> cells = NanoMemory();
    response.has_cell_mask =
        with_mask(grid, [&](const auto& tree) { cells = to_nano<ValueMask>(tree, name, left(), &NanoMemory::reserve); });
    return cells;
  }

  Result<GridInfo> describe(const VdbEntry& entry) {
    GridInfo info;
    info.name = entry.name;
    info.type = type_name(entry);
    const auto grid = file_.read(entry);
    if (!grid) return info;
    const auto mapping = mapping_of(*grid);
    if (mapping) info.mapping = *mapping;
    // extent and statistics
    const std::string name = fmt::format("{}: grid \"{}\"", what_.path, entry.name);
    Outcome done = Done{};
    const auto values = [&]<class T>(const auto& tree, const T*) -> Outcome {
      CATENA_TRY(const NanoMemory memory, to_nano<T>(tree, name, left(), &NanoMemory::reserve));
      const auto& nano = field::as_nano_grid<T>(memory);
      set_box(info, field::compute_active_box(nano));
      CATENA_TRY(const ValueMaskGrid* valid, mask_for(info.mapping));
      info.stats = field::compute_stats(nano, valid).stats;
      info.display_range = field::compute_display_range(nano, valid, info.stats);
      info.bytes = memory.size();
      return Done{};
    };
    const auto masks = [&](const auto& tree) -> Outcome {
      CATENA_TRY(const NanoMemory memory, to_nano<ValueMask>(tree, name, left(), &NanoMemory::reserve));
      const std::uint64_t on = field::count_voxels(field::as_nano_grid<ValueMask>(memory)), active = tree.activeVoxelCount();
      openvdb::CoordBBox box;
      tree.evalActiveVoxelBoundingBox(box);
      set_box(info, box);
      info.stats.active_voxels = active;
      info.stats.min = on > 0 && on == active ? 1 : 0;
      info.stats.max = on > 0 ? 1 : 0;
      info.bytes = memory.size();
      return Done{};
    };
    if (with_scalars(grid, [&](const auto& tree) { done = values(tree, static_cast<const float*>(nullptr)); })) {
    } else if (with_vectors(grid, [&](const auto& tree) { done = values(tree, static_cast<const nanovdb::Vec3f*>(nullptr)); })) {
      info.is_vector = true;
    } else if (!with_mask(grid, [&](const auto& tree) { done = masks(tree); })) {
      set_box(info, grid->evalActiveVoxelBoundingBox());
      info.stats.active_voxels = grid->activeVoxelCount();
      info.bytes = grid->memUsage();
    }
    if (!done) return done.error();
    info.is_usable =
        mapping && (is_scalar_type(info.type) || is_vector_type(info.type)) && info.stats.active_voxels > info.stats.nan_count && is_near_;
    return info;
  }

  /// Returns the mask that is loaded with a grid; null: the file has none, or it has another transform.
  Result<const ValueMaskGrid*> mask_for(const Mapping& mapping) {
    const VdbEntry* entry = what_.mask_grid ? file_.find(*what_.mask_grid) : nullptr;
    if (entry != nullptr && !mask_read_ && (type_name(*entry) == "bool" || type_name(*entry) == "mask")) {
      const auto grid = file_.read(*entry);
      const auto mask_mapping = mapping_of(*grid);
      const std::string name = fmt::format("{}: the mask \"{}\"", what_.path, entry->name);
      Result<NanoMemory> voxels = NanoMemory();
      with_mask(grid, [&](const auto& tree) { voxels = to_nano<ValueMask>(tree, name, left(), &NanoMemory::reserve); });
      CATENA_TRY(mask_, std::move(voxels));
      if (mask_mapping && mask_.size() > 0) mask_mapping_ = *mask_mapping;
    }
    mask_read_ = true;
    return mask_mapping_ && same_mapping(mapping, *mask_mapping_) ? &field::as_nano_grid<ValueMask>(mask_) : nullptr;
  }

  void set_box(GridInfo& info, const ActiveBox& box) {
    is_near_ = is_within_index_limits(box);
    if (box.empty()) return;
    info.size = {box.voxels(0), box.voxels(1), box.voxels(2)};
    info.first_index = {box.lo[0], box.lo[1], box.lo[2]};
  }
  void set_box(GridInfo& info, const openvdb::CoordBBox& box) {
    if (!box.empty()) set_box(info, ActiveBox{to_nano_coord(box.min()), to_nano_coord(box.max())});
  }

  const ReadRequest& request_;
  const LoadRequest& what_;
  VdbFile& file_;
  sandbox::ResponseFile& out_;
  bool is_near_ = true;
  // cached while grids are described
  bool mask_read_ = false;
  NanoMemory mask_;
  std::optional<Mapping> mask_mapping_;
};

Outcome answer_or_throw(const ReadRequest& request, std::span<const std::byte> bytes, sandbox::ResponseFile& out, ReadResponse& response) {
  openvdb::initialize();
  CATENA_TRY(const auto file, VdbFile::open(bytes, request.load_request.path));
  file->read_units(response);
  Answer answer(request, *file, out);
  if (request.mode == field::ReadMode::load) return answer.load(response);
  if (request.mode == field::ReadMode::describe) return answer.describe(response);
  return Done{};
}

}  // namespace

ReadResponse handle_request(const ReadRequest& request, std::span<const std::byte> file, sandbox::ResponseFile& out) {
  const std::string& path = request.load_request.path;
  ReadResponse response;
  Outcome done = Done{};
  try {
    done = answer_or_throw(request, file, out, response);
  } catch (const std::bad_alloc&) {
    constexpr double kMegabyte = 1e6;
    done =
        Error{fmt::format("{}: reading the file needs more than the allowed {:.0f} MB of memory, or the file is damaged (--memory MB "
                          "allows more)",
                          path, static_cast<double>(request.memory_bytes) / kMegabyte)};
  } catch (const std::exception& e) {
    out.report(e);
    done = Error{fmt::format("{}: the file is damaged or its type is unknown ({})", path, one_line(e.what()))};
  } catch (...) {
    done = Error{fmt::format("{}: the file is damaged or its type is unknown", path)};
  }
  if (done) return response;
  ReadResponse refusal;
  refusal.error = done.error().message;
  return refusal;
}

}  // namespace catena::vdb
