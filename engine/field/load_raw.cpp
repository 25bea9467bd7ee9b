// Bare numbers, x fastest, little-endian; the layout comes from the scene. Voxel (0, 0, 0) is at `origin`.
#include <fmt/format.h>

#include <bit>
#include <fstream>
#include <vector>

#include "engine/field/files.h"
#include "engine/field/grid_make.h"
#include "engine/field/loaders.h"
#include "engine/field/number_type.h"

namespace catena::field {

static_assert(std::endian::native == std::endian::little, "raw files are read as they lie");

Result<AnyField> load_raw(const LoadRequest& request) {
  const std::string& path = request.path;
  CATENA_TRY(const std::uint64_t size, readable_file(path));
  if (!request.raw)
    return Error{fmt::format("{}: a .raw file needs its shape, spacing, origin and type (in the scene's \"fields\")", path)};
  const RawLayout& raw = *request.raw;

  // the layout
  std::string word = raw.type;
  const bool vector = word == "float32x3";
  if (vector) word = "float32";
  const auto type = number_type(word);
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
  const std::string name = stem_of(path);
  if (!request.grid.empty() && request.grid != name)
    return Error{fmt::format("{}: there is no grid \"{}\", a .raw file holds one, \"{}\"", path, request.grid, name)};
  if (request.valid_required) return Error{fmt::format("{}: a .raw file holds no mask", path)};

  // the size, with room for any shape
  const std::size_t components = vector ? 3 : 1, voxel_bytes = components * type->bytes;
  const long double wanted = static_cast<long double>(n.x) * n.y * n.z * static_cast<long double>(voxel_bytes);
  if (wanted != static_cast<long double>(size))
    return Error{fmt::format("{}: the file has {} bytes, expected {:.0f} ({} x {} x {} voxels of {} bytes)", path, size,
                             static_cast<double>(wanted), n.x, n.y, n.z, voxel_bytes)};

  // the numbers
  std::vector<std::byte> bytes(size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) return Error{fmt::format("{}: cannot be read to its end", path)};
  std::vector<float> values(size / type->bytes);
  type->decode(bytes.data(), values.size(), 1, 0, values.data());
  bytes = {};
  count_file();
  count_grid();
  Mat3 linear(0.0);
  for (int a = 0; a < 3; ++a) linear[a][a] = raw.spacing[a];
  const Mapping mapping = Mapping::from_linear(linear, raw.origin);
  AnyField field;
  if (vector) {
    auto made = try_make_vector_grid(name, mapping, n, values);
    if (!made) return Error{path + ": the data " + made.error().message};
    field.vector = *made;
  } else {
    auto made = try_make_scalar_grid(name, mapping, n, values);
    if (!made) return Error{path + ": the data " + made.error().message};
    field.scalar = *made;
  }
  return field;
}

}  // namespace catena::field
