// SPDX-License-Identifier: MIT
// Loads voxel data from the responses of the reader programs: the formats of VTK and ITK, and NumPy's. The responses are untrusted and
// validated here.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/base/text.h"
#include "engine/io/client.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/curves/write_polylines.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/stores/describe_store.h"
#include "engine/io/stores/load_store.h"
#include "engine/io/stores/store.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

Result<AnyField> load_answered(const LoadRequest& request) {
  const std::string& path = request.path;
  CATENA_TRY(MappedResponse answer, run_reader(ReadMode::load, request));
  const auto mapped = std::make_shared<const MappedResponse>(std::move(answer));
  const ReadResponse& reply = mapped->response;
  const DenseResponse& dense = reply.dense;
  constexpr std::int64_t kMaxAxis = 1 << 24;
  for (const std::int64_t n : {dense.size.x, dense.size.y, dense.size.z})
    if (n < 1 || n > kMaxAxis) return damaged_response_error(path, fmt::format("an axis has {} voxels", n));
  const Index3 n{static_cast<int>(dense.size.x), static_cast<int>(dense.size.y), static_cast<int>(dense.size.z)};
  const int components = reply.is_vector ? 3 : 1;
  Mapping mapping = reply.mapping;
  if (io::is_numpy_file(path)) {
    Mat3 linear(0.0);
    for (int a = 0; a < 3; ++a) linear[a][a] = request.spacing[a];
    mapping = Mapping::from_linear(linear, request.origin);
  }
  if (!mapping.is_invertible()) return damaged_response_error(path, "the transform cannot be inverted");
  const std::span<const float> values = mapped->numbers<float>(dense.values);
  const std::span<const std::uint8_t> valid = mapped->numbers<std::uint8_t>(dense.valid);
  const std::span<const std::uint8_t> cells = mapped->numbers<std::uint8_t>(dense.cells);
  const double voxels = static_cast<double>(n.x) * n.y * n.z;
  if (static_cast<double>(values.size()) != voxels * components || (!valid.empty() && static_cast<double>(valid.size()) != voxels) ||
      (!cells.empty() && cells.size() != valid.size()))
    return damaged_response_error(path, "the numbers of values and voxels differ");
  CATENA_CHECK(check_dense_memory(fmt::format("{}: the grid of {} x {} x {} voxels", path, n.x, n.y, n.z), n, components, !valid.empty()));
  DenseFile file{reply.name, dense.type, path + ": " + reply.name + " ", mapping, components, {}};
  file.times = reply.times;
  file.time_unit = reply.time_unit;
  file.newest_mtime_ns = reply.newest_mtime_ns;
  file.notes = reply.notes;
  file.source.size = n;
  file.source.has_mask = !valid.empty();
  file.source.read = [mapped, values, valid, n, components](int z, int layers, std::span<float> to,
                                                            std::span<std::uint8_t> validity) -> Outcome {
    const std::size_t layer = static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y);
    const std::size_t first = layer * static_cast<std::size_t>(z), count = layer * static_cast<std::size_t>(layers);
    std::memcpy(to.data(), values.data() + first * static_cast<std::size_t>(components),
                count * static_cast<std::size_t>(components) * sizeof(float));
    for (std::size_t i = 0; i < validity.size(); ++i) validity[i] = valid[first + i] != 0 ? 1 : 0;
    return Done{};
  };
  if (!cells.empty())
    file.source.read_cells = [mapped, cells, n](int z, int layers, std::span<std::uint8_t> validity) -> Outcome {
      const std::size_t layer = static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y);
      const std::size_t first = layer * static_cast<std::size_t>(z), count = layer * static_cast<std::size_t>(layers);
      for (std::size_t i = 0; i < count; ++i) validity[i] = cells[first + i] != 0 ? 1 : 0;
      return Done{};
    };
  if (dense.has_range) {
    const DisplayRange& r = dense.range;
    if (!(std::isfinite(r.data_min) && std::isfinite(r.data_max) && r.data_min <= r.lo && r.lo <= r.hi && r.hi <= r.data_max))
      return damaged_response_error(path, "the value range is invalid");
    file.source.range = r;
  }
  return load_dense(file);
}

Units units_answered(const std::string& path, const std::string& grid) {
  const std::optional<ReadResponse> file = read_file_metadata(path);
  if (!file) return {};
  Units units;
  units.is_patient_space = file->is_patient_space;
  if (is_unit_name(file->unit_length)) units.length = file->unit_length;
  for (const GridMetadata& words : file->grid_metadata)
    if (words.name == grid || (grid.empty() && file->grid_metadata.size() == 1)) units.value = is_unit_name(words.unit) ? words.unit : "";
  return units;
}

std::vector<double> times_answered(const std::string& path) {
  const std::optional<ReadResponse> file = read_file_metadata(path);
  return file ? file->times : std::vector<double>();
}

/// Reads boxes of a .npy file of scalars of a type that stores have; another one is loaded.
Result<VoxelSource> open_npy_voxels(const LoadRequest& request) {
  return find_store(request) ? open_stored_voxels(request) : load_voxels(request);
}

Result<std::vector<GridInfo>> describe_npy(const std::string& path, int step) {
  LoadRequest request;
  request.path = path;
  return is_read_in_bricks(request) ? describe_stored(path, step) : describe_by_loading(path, step);
}

constexpr VolumeReader kRemoteVolume{
    .load = load_answered, .describe = describe_with_reader, .units = units_answered, .times = times_answered};

}  // namespace

std::optional<PrimitiveKinds> read_primitive_kinds(const std::string& path) {
  const std::optional<ReadResponse> file = read_file_metadata(path);
  return file ? std::optional(file->primitives) : std::nullopt;
}

std::vector<double> read_times(const std::string& path) {
  const io::Format* format = io::find_format(path);
  if (format == nullptr && !openfoam_case_folder(path).empty()) return times_answered(path);
  return format != nullptr && format->volume.times != nullptr ? format->volume.times(path) : std::vector<double>();
}

}  // namespace catena::field

namespace catena::io {

Format npy_format() {
  return {
      .name = "NumPy array",
      .extensions = {".npy"},
      .volume = {.load = field::load_answered, .describe = field::describe_npy, .open_voxels = field::open_npy_voxels, .is_array = true}};
}

std::vector<Format> remote_formats() {
  constexpr auto kVolume = field::kRemoteVolume;
  field::VolumeReader dicom = kVolume;
  dicom.reads_folders = true;
  constexpr auto kMesh = mesh::read_surface;
  constexpr auto kCurves = curves::read_lines;
  constexpr auto kPoints = curves::read_points;
  constexpr auto kCompanions = FileLayout::companions;
  constexpr auto kIndex = FileLayout::index;
  return {
      {.name = "VTK XML image data",
       .extensions = {".vti"},
       .volume = kVolume,
       .write_volume = field::write_box<field::write_vti>,
       .has_cell_mask = true},
      {.name = "VTK XML rectilinear grid", .extensions = {".vtr"}, .volume = kVolume},
      {.name = "VTK XML structured grid", .extensions = {".vts"}, .volume = kVolume},
      {.name = "VTK XML unstructured grid", .extensions = {".vtu"}, .volume = kVolume, .read_mesh = kMesh, .read_curves = kCurves},
      {.name = "VTK XML polygonal data",
       .extensions = {".vtp"},
       .read_mesh = kMesh,
       .read_curves = kCurves,
       .read_points = kPoints,
       .write_mesh = mesh::write_vtp,
       .write_curves = curves::write_polylines_vtp},
      {.name = "VTK XML multi-block data", .extensions = {".vtm", ".vtmb"}, .volume = kVolume, .read_mesh = kMesh, .layout = kIndex},
      {.name = "VTK XML parallel data", .extensions = {".pvti", ".pvtr", ".pvts", ".pvtu"}, .volume = kVolume, .layout = kIndex},
      {.name = "VTK XML parallel polygonal data",
       .extensions = {".pvtp"},
       .read_mesh = kMesh,
       .read_curves = kCurves,
       .read_points = kPoints,
       .layout = kIndex},
      {.name = "VTK legacy", .extensions = {".vtk"}, .volume = kVolume, .read_mesh = kMesh, .read_curves = kCurves, .read_points = kPoints},
      {.name = "ParaView collection, file series",
       .extensions = {".pvd", ".series"},
       .volume = kVolume,
       .read_mesh = kMesh,
       .read_curves = kCurves,
       .read_points = kPoints,
       .layout = kIndex},
      {.name = "NRRD",
       .extensions = {".nrrd"},
       .volume = kVolume,
       .write_volume = field::write_box<field::write_nrrd>,
       .layout = kCompanions},
      {.name = "NRRD header with separate data", .extensions = {".nhdr"}, .volume = kVolume, .layout = kIndex},
      {.name = "MetaImage", .extensions = {".mha"}, .volume = kVolume, .layout = kCompanions},
      {.name = "MetaImage header with separate data", .extensions = {".mhd"}, .volume = kVolume, .layout = kIndex},
      {.name = "DICOM", .extensions = {".dcm"}, .volume = dicom, .layout = kCompanions},
      {.name = "OpenFOAM case", .extensions = {".foam"}, .volume = kVolume, .layout = kCompanions},
      {.name = "EnSight Gold case", .extensions = {".case", ".encas"}, .volume = kVolume, .layout = kIndex},
      {.name = "CGNS", .extensions = {".cgns"}, .volume = kVolume, .layout = kCompanions},
      {.name = "NetCDF", .extensions = {".nc", ".cdf"}, .volume = kVolume},
      {.name = "NumPy archive", .extensions = {".npz"}, .volume = kVolume},
      {.name = "PLY", .extensions = {".ply"}, .read_mesh = kMesh, .read_points = kPoints, .write_mesh = mesh::write_ply},
      {.name = "GIFTI surface", .extensions = {".gii"}, .read_mesh = kMesh, .layout = kCompanions},
  };
}

}  // namespace catena::io
