// SPDX-License-Identifier: MIT
#include "engine/io/volume/write_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_nodes.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

/// Applies `use` to the storage of a scalar or a vector grid.
template <class Use>
auto with_storage(const AnyField& field, const Use& use) {
  return field.scalar ? use(field.scalar->grid()->storage()) : use(field.vector->grid()->storage());
}

const NanoMask* mask_of(const AnyField& field) {
  return with_storage(field, [](const auto& storage) { return storage.valid_voxels; });
}

}  // namespace

VoxelBox::VoxelBox(const AnyField& field, const std::string& box_name, const Units& box_units)
    : name(box_name),
      units(box_units),
      mapping(field.get()->mapping()),
      components(field.vector ? 3 : 1),
      has_mask(mask_of(field) != nullptr),
      has_cell_mask(with_storage(field, [](const auto& storage) { return storage.has_cell_mask; })),
      field_(field) {
  CATENA_ASSERT(field.get()->is_grid());
  const auto index = [](const Vec3& v) {
    return Index3{static_cast<std::int32_t>(v.x), static_cast<std::int32_t>(v.y), static_cast<std::int32_t>(v.z)};
  };
  const Box& full_box = field.get()->index_box();
  first_index_ = index(full_box.lo);
  size = index(full_box.hi - full_box.lo + Vec3(1.0));
  mapping.origin = mapping.world_from_index(full_box.lo);
}

void VoxelBox::read_values(std::int32_t z, std::span<float> out) const {
  const Index3 origin{first_index_.x, first_index_.y, first_index_.z + z}, layer{size.x, size.y, 1};
  if (field_.scalar)
    field_.scalar->grid()->read_block(origin, layer, out);
  else
    field_.vector->grid()->read_block(origin, layer, out);
}

void VoxelBox::read_valid(std::int32_t z, std::span<std::uint8_t> out) const {
  const NanoMask* mask = mask_of(field_);
  if (mask == nullptr) {
    std::fill(out.begin(), out.end(), std::uint8_t{1});
    return;
  }
  const auto accessor = mask->getAccessor();
  std::size_t n = 0;
  for (std::int32_t y = 0; y < size.y; ++y)
    for (std::int32_t x = 0; x < size.x; ++x)
      out[n++] = accessor.getValue({first_index_.x + x, first_index_.y + y, first_index_.z + z}) ? 1 : 0;
}

void VoxelBox::read_cells(std::int32_t z, std::span<std::uint8_t> out) const {
  std::fill(out.begin(), out.end(), std::uint8_t{1});
  with_storage(field_, [&](const auto& storage) {
    if (storage.valid_cells == nullptr) return;
    const auto cells = storage.valid_cells->getAccessor();
    std::size_t n = 0;
    for (std::int32_t y = 0; y < size.y; ++y)
      for (std::int32_t x = 0; x < size.x; ++x, ++n) {
        const Index3 base{first_index_.x + x, first_index_.y + y, first_index_.z + z};
        if (storage.is_legal_base(base)) out[n] = storage.is_cell_valid(cells, base) ? 1 : 0;
      }
  });
}

void VoxelBox::read_values_or_nan(const Index3& lo, const Index3& count, std::span<float> out) const {
  const Index3 origin{first_index_.x + lo.x, first_index_.y + lo.y, first_index_.z + lo.z};
  if (field_.scalar)
    field_.scalar->grid()->read_block(origin, count, out);
  else
    field_.vector->grid()->read_block(origin, count, out);
  const NanoMask* mask = mask_of(field_);
  if (mask == nullptr) return;
  const auto accessor = mask->getAccessor();
  const auto n = static_cast<std::size_t>(components);
  auto at = out.begin();
  for (std::int32_t z = 0; z < count.z; ++z)
    for (std::int32_t y = 0; y < count.y; ++y)
      for (std::int32_t x = 0; x < count.x; ++x, at += components)
        if (!accessor.getValue({origin.x + x, origin.y + y, origin.z + z})) std::fill_n(at, n, std::numeric_limits<float>::quiet_NaN());
}

/// Returns a note if single precision of axes and origin displaces voxels far from the origin; empty if none moves by more than a hundredth
/// of its edge.
static std::string rounding_note(const VoxelBox& box) {
  constexpr double kMinReportedShift = 0.01;
  const Mapping& exact = box.mapping;
  const auto rounded = [&](const Vec3& index) {
    Vec3 at(glm::vec3(exact.origin));
    for (int a = 0; a < 3; ++a) at += index[a] * Vec3(glm::vec3(exact.world_from_index_linear[a]));
    return at;
  };
  double max_shift = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3 corner((c & 1) != 0 ? box.size.x - 1 : 0, (c & 2) != 0 ? box.size.y - 1 : 0, (c & 4) != 0 ? box.size.z - 1 : 0);
    max_shift = std::max(max_shift, max_abs(exact.index_from_world(rounded(corner)) - corner));
  }
  if (!(max_shift > kMinReportedShift)) return {};
  return fmt::format(
      "the 32-bit positions displace voxels by up to {:.2g} of an edge so far from the origin (.vdb, .vti and .nrrd store 64 bits)",
      max_shift);
}

std::string lost_mask_note(const std::string& path, const AnyField& field) {
  const io::Format* format = io::find_writer(path, io::DataKind::volume);
  if (format == nullptr) return {};
  const VoxelBox box(field, {}, {});
  std::string note = format->has_float_positions ? rounding_note(box) : "";
  if (!box.has_cell_mask || format->has_cell_mask) return note;
  // count the invalid cells between valid voxels
  std::vector<std::uint8_t> below(box.layer_voxels()), above(box.layer_voxels()), cells(box.layer_voxels());
  const int step[3] = {box.size.x > 1, box.size.y > 1, box.size.z > 1};
  std::uint64_t lost_cells = 0;
  for (int z = 0; z < std::max(1, box.size.z - 1); ++z) {
    box.read_valid(z, below);
    box.read_valid(z + step[2], above);
    box.read_cells(z, cells);
    for (int y = 0; y < std::max(1, box.size.y - 1); ++y)
      for (int x = 0; x < std::max(1, box.size.x - 1); ++x) {
        const auto at = [&](int i, int j) { return static_cast<std::size_t>(y + j) * static_cast<std::size_t>(box.size.x) + x + i; };
        bool open = cells[at(0, 0)] == 0;
        for (int c = 0; c < 4 && open; ++c) {
          const std::size_t corner = at((c & 1) * step[0], (c >> 1) * step[1]);
          open = below[corner] != 0 && above[corner] != 0;
        }
        lost_cells += open ? 1 : 0;
      }
  }
  if (lost_cells == 0) return note;
  if (!note.empty()) note += "; ";
  return note + fmt::format(
                    "{} invalid cells have valid voxels at all corners: {} masks voxels only, so that these cells get values (.vdb and "
                    ".vti keep them invalid)",
                    lost_cells, path.substr(path.find_last_of('/') + 1));
}

Outcome write_field(const std::string& path, const AnyField& field, const std::string& name, const Units& units) {
  const io::Format* format = io::find_writer(path, io::DataKind::volume);
  if (format == nullptr) return Error{path + ": expected an output that ends in " + io::writable_extensions(io::DataKind::volume)};
  return format->write_volume(path, field, name, units);
}

Outcome write_box_with(Outcome (*write)(const std::string& path, const VoxelBox& box), const std::string& path, const AnyField& field,
                       const std::string& name, const Units& units) {
  const VoxelBox box(field, name, units);
  CATENA_CHECK(
      check_memory_available(fmt::format("{}: the whole box of the grid, {} x {} x {} voxels,", path, box.size.x, box.size.y, box.size.z),
                             box.voxels() * (box.components * static_cast<double>(sizeof(float)) + (box.has_mask ? 1 : 0))));
  return write(path, box);
}

Result<std::string> convert_file(const LoadRequest& request, const std::string& path, const std::string& name,
                                 std::vector<std::string>* notes, const WriteProgress& progress) {
  if (has_extension(path, ".zarr")) return convert_to_zarr(request, path, name, notes, progress);
  // import writes .vdb data if the extension is unknown
  const bool as_vdb = has_extension(path, ".vdb") || io::find_writer(path, io::DataKind::volume) == nullptr;
  if (as_vdb) {
    // slice by slice if the format supports it
    const io::Format* format = io::find_reader(request.path, io::DataKind::volume);
    if (format == nullptr || format->volume.open != nullptr) return import_as_vdb(request, path, name);
  }
  CATENA_TRY(const AnyField field, load(request));
  if (notes != nullptr) *notes = field.notes;
  const std::string own_name = field.get()->name();
  const std::string chosen_name = !name.empty() ? name : !own_name.empty() ? own_name : io::file_stem(request.path);
  if (as_vdb) {
    CATENA_CHECK(write_vdb(path, {{field, chosen_name}}));
  } else {
    CATENA_CHECK(write_field(path, field, chosen_name, read_units(request.path, request.grid)));
    if (const std::string note = lost_mask_note(path, field); notes != nullptr && !note.empty()) notes->push_back(note);
  }
  return chosen_name;
}

}  // namespace catena::field
