// SPDX-License-Identifier: MIT
#include "engine/io/volume/voxel_source.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "engine/base/input_files.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/grid/grid.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_box.h"
#include "engine/io/volume/write_field.h"

namespace catena::field {
namespace {

/// Integers of at most this magnitude are exact in 32-bit floats.
constexpr double kExactIntegers = 1 << 24;

/// Appends the numbers of a mapping to an identity.
std::string mapping_text(const Mapping& mapping) {
  std::string text;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) text += to_text(mapping.world_from_index_linear[a][b]) + " ";
  for (int a = 0; a < 3; ++a) text += to_text(mapping.origin[a]) + " ";
  return text;
}

}  // namespace

std::string identify_file(const std::string& path) {
  std::error_code code;
  struct stat about {};
  const bool exists = ::stat(path.c_str(), &about) == 0;
  return fmt::format("{}\n{} bytes, changed at {}\n", one_line(std::filesystem::absolute(path, code).lexically_normal().string()),
                     exists && !S_ISDIR(about.st_mode) ? about.st_size : 0, exists ? modified_ns(about) : 0);
}

Result<VoxelSource> voxels_of_grid(const std::string& path, const AnyField& field, const std::string& name, const Units& units) {
  if (!field.scalar)
    return Error{
        one_line(fmt::format("{}: the grid {} contains vectors, expected scalars for OME-Zarr (.vdb, .vti, .nrrd and .nii store "
                             "vectors)",
                             path, in_quotes(name)))};
  const auto box = std::make_shared<const VoxelBox>(field, name, units);
  const ScalarGrid& grid = *field.scalar->grid();
  VoxelSource source{name, *find_number_type("float32"), box->size, box->mapping, units, grid.background()};
  if (box->has_mask) source.fill_value = std::numeric_limits<double>::quiet_NaN();
  source.read = [box](const Index3& lo, const Index3& size, std::span<std::byte> values) -> Outcome {
    box->read_values_or_nan(lo, size, {reinterpret_cast<float*>(values.data()), values.size() / sizeof(float)});
    return Done{};
  };
  if (units.is_label_map && std::fabs(grid.stats().min) <= kExactIntegers && std::fabs(grid.stats().max) <= kExactIntegers) {
    // labels are integers in OME-Zarr
    source.type = *find_number_type("int32");
    source.fill_value = 0;
    source.read = [read = source.read](const Index3& lo, const Index3& size, std::span<std::byte> values) -> Outcome {
      std::vector<float> numbers(values.size() / sizeof(float));
      CATENA_CHECK(read(lo, size, std::as_writable_bytes(std::span(numbers))));
      const std::span labels(reinterpret_cast<std::int32_t*>(values.data()), numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i)
        labels[i] = std::isfinite(numbers[i]) ? static_cast<std::int32_t>(std::lround(numbers[i])) : 0;
      return Done{};
    };
  }
  source.units.is_label_map = source.type.name == "int32";
  source.identity =
      identify_file(path) + fmt::format("grid {}, newest file {}, {}\n", name, field.newest_mtime_ns, mapping_text(box->mapping));
  source.notes = field.notes;
  return source;
}

Result<VoxelSource> voxels_of_formula(const AnyField& formula, int resolution, double lo, double hi) {
  const std::string what =
      fmt::format("field {}, {} nodes per axis from {} to {}", in_quotes(formula.get()->name()), resolution, to_text(lo), to_text(hi));
  if (!formula.scalar) return Error{what + ": these are vectors, expected scalars for OME-Zarr"};
  const double spacing = (hi - lo) / (resolution - 1);
  if (!std::isfinite(spacing) || !(lo + spacing > lo))
    return Error{what + ": the spacing is not a usable number; a smaller or larger box was expected"};
  const Mapping mapping = Mapping::from_linear(Mat3(spacing), Vec3(lo));
  VoxelSource source{formula.get()->name(), *find_number_type("float32"), {resolution, resolution, resolution}, mapping};
  source.identity = what + "\n";
  source.read = [field = formula.scalar, mapping, what](const Index3& first, const Index3& size, std::span<std::byte> values) -> Outcome {
    float* out = reinterpret_cast<float*>(values.data());
    Cursor cursor;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x, ++out) {
          const ScalarSample sample = field->sample(mapping.world_from_index(Vec3(first.x + x, first.y + y, first.z + z)), cursor);
          *out = sample.inside ? static_cast<float>(sample.value) : std::numeric_limits<float>::quiet_NaN();
          if (sample.inside && !std::isfinite(*out))
            return Error{what + ": samples do not fit into 32-bit floats; smaller values were expected"};
        }
    return Done{};
  };
  return source;
}

Result<VoxelSource> open_voxels(const LoadRequest& request) {
  const io::Format* format = io::find_reader(request.path, io::DataKind::volume);
  if (format != nullptr && format->volume.open_voxels != nullptr) return format->volume.open_voxels(request);
  return load_voxels(request);
}

Result<VoxelSource> load_voxels(const LoadRequest& request) {
  CATENA_TRY(const AnyField field, load(request));
  const std::string own_name = field.get()->name();
  CATENA_TRY(VoxelSource source, voxels_of_grid(request.path, field, own_name.empty() ? io::file_stem(request.path) : own_name,
                                                read_units(request.path, request.grid)));
  if (const std::string note = lost_mask_note(".zarr", field); !note.empty()) source.notes.push_back(note);
  source.identity += fmt::format("step {}\n", request.step);
  return source;
}

}  // namespace catena::field
