// SPDX-License-Identifier: MIT
// Loads raw numbers, x fastest, little-endian, slice by slice; the layout comes from the scene. Voxel (0, 0, 0) is at `origin`.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <vector>

#include "engine/field/number_type.h"
#include "engine/io/formats.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

static_assert(std::endian::native == std::endian::little, "raw files are read without swapping bytes");

namespace {

/// The file from its first byte to its last; slices must be read in order.
class RawLayers {
 public:
  RawLayers(const std::string& path, const NumberType& type) : path_(path), type_(type), in_(path, std::ios::binary) {}

  Outcome read(std::span<float> values) {
    if (type_.name == "float32") {
      in_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
      return whole();
    }
    constexpr std::size_t kPiece = 1 << 18;  // numbers
    bytes_.resize(kPiece * type_.bytes);
    for (std::size_t at = 0; at < values.size(); at += kPiece) {
      const std::size_t count = std::min(kPiece, values.size() - at);
      in_.read(reinterpret_cast<char*>(bytes_.data()), static_cast<std::streamsize>(count * type_.bytes));
      CATENA_CHECK(whole());
      type_.decode(bytes_.data(), count, 1, 0, values.data() + at, *rounding);
    }
    return Done{};
  }

  const std::shared_ptr<RoundingLoss> rounding = std::make_shared<RoundingLoss>();

 private:
  Outcome whole() const {
    if (!in_) return Error{fmt::format("{}: cannot be read to the end", path_)};
    return Done{};
  }

  std::string path_;
  NumberType type_;
  std::ifstream in_;
  std::vector<std::byte> bytes_;
};

/// The validated layout of a file.
struct RawFile {
  std::string name;
  NumberType type;
  std::size_t components;
  Mapping mapping;
};

}  // namespace

/// Checks the layout of a request against the file.
static Result<RawFile> check_raw(const LoadRequest& request) {
  const std::string& path = request.path;
  CATENA_TRY(const std::uint64_t size, readable_file_size(path));
  if (!request.raw) return Error{fmt::format("{}: a .raw file needs shape, spacing, origin and type in the scene's \"fields\"", path)};
  const RawLayout& raw = *request.raw;

  // the layout
  std::string word = raw.type;
  const bool vector = word == "float32x3";
  if (vector) word = "float32";
  const auto type = find_number_type(word);
  if (!type || word == "int64" || word == "uint64")
    return Error{
        fmt::format("{}: type is \"{}\", expected one of float32 float64 uint8 int8 uint16 int16 uint32 int32 float32x3", path, raw.type)};
  const Index3& n = raw.shape;
  if (n.x < 1 || n.y < 1 || n.z < 1)
    return Error{fmt::format("{}: shape is [{}, {}, {}], expected three positive numbers", path, n.x, n.y, n.z)};
  if (!is_finite(raw.origin)) return Error{fmt::format("{}: origin must be finite", path)};
  for (int a = 0; a < 3; ++a)
    if (!(raw.spacing[a] > 0) || !std::isfinite(raw.spacing[a]))
      return Error{fmt::format("{}: spacing is {}, expected positive numbers", path, raw.spacing[a])};
  const std::string name = io::file_stem(path);
  if (!request.grid.empty() && request.grid != name)
    return Error{fmt::format("{}: there is no grid \"{}\"; the only grid of the .raw file is \"{}\"", path, request.grid, name)};
  if (request.mask_required) return Error{fmt::format("{}: a .raw file has no mask", path)};

  // the size, computed without overflow for any shape
  const std::size_t components = vector ? 3 : 1, voxel_bytes = components * type->bytes;
  const long double expected_size = static_cast<long double>(n.x) * n.y * n.z * static_cast<long double>(voxel_bytes);
  if (expected_size != static_cast<long double>(size))
    return Error{fmt::format("{}: the file has {} bytes, expected {:.0f} ({} x {} x {} voxels of {} bytes)", path, size,
                             static_cast<double>(expected_size), n.x, n.y, n.z, voxel_bytes)};
  Mat3 linear(0.0);
  for (int a = 0; a < 3; ++a) linear[a][a] = raw.spacing[a];
  return RawFile{name, *type, components, Mapping::from_linear(linear, raw.origin)};
}

static Result<DenseFile> open_raw(const LoadRequest& request) {
  CATENA_TRY(const RawFile raw, check_raw(request));
  const std::string& path = request.path;
  const Index3& n = request.raw->shape;
  CATENA_CHECK(check_dense_memory(fmt::format("{}: the grid of {} x {} x {} voxels", path, n.x, n.y, n.z), n,
                                  static_cast<int>(raw.components),
                                  /*masked=*/false));
  const auto layers = std::make_shared<RawLayers>(path, raw.type);
  DenseFile file{raw.name, request.raw->type, path + ": the data ", raw.mapping, static_cast<int>(raw.components), {}};
  file.rounding = layers->rounding;
  file.source.size = n;
  file.source.read = [layers](int, int, std::span<float> values, std::span<std::uint8_t>) { return layers->read(values); };
  return file;
}

/// Reads boxes of the file.
static Result<VoxelSource> open_raw_voxels(const LoadRequest& request) {
  CATENA_TRY(const RawFile raw, check_raw(request));
  if (raw.components > 1) return Error{request.path + ": these are vectors, expected scalars for OME-Zarr"};
  return open_stored_voxels(request);
}

static Result<std::vector<GridInfo>> describe_raw(const std::string& path, int) {
  CATENA_CHECK(readable_file_size(path));
  return Error{
      path +
      ": a .raw file does not describe its layout; expected shape, spacing, origin and type in a scene, or --shape for catena import"};
}

}  // namespace catena::field

namespace catena::io {

Format raw_format() {
  return {.name = "Raw numbers",
          .extensions = {".raw"},
          .volume = {.open = field::open_raw,
                     .describe = field::describe_raw,
                     .open_voxels = field::open_raw_voxels,
                     .is_array = true,
                     .needs_layout = true}};
}

}  // namespace catena::io
