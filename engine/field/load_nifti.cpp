// NIfTI-1 volumes. The library reads the header and opens the (compressed) stream; the voxels are decoded here, because the
// library's own reader turns NaN into 0. World: the sform, else the qform, else the voxel sizes; millimetres, RAS, as stored.
#include <nifti1_io.h>

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

#include "engine/field/files.h"
#include "engine/field/grid_make.h"
#include "engine/field/loaders.h"
#include "engine/field/number_type.h"

namespace catena::field {
namespace {

struct FreeImage {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
using Image = std::unique_ptr<nifti_image, FreeImage>;

struct Volume {
  std::shared_ptr<const ScalarGrid> grid;
  std::string type;
};

std::string_view word_of(int datatype) {
  switch (datatype) {
    case NIFTI_TYPE_UINT8:
      return "uint8";
    case NIFTI_TYPE_INT8:
      return "int8";
    case NIFTI_TYPE_UINT16:
      return "uint16";
    case NIFTI_TYPE_INT16:
      return "int16";
    case NIFTI_TYPE_UINT32:
      return "uint32";
    case NIFTI_TYPE_INT32:
      return "int32";
    case NIFTI_TYPE_UINT64:
      return "uint64";
    case NIFTI_TYPE_INT64:
      return "int64";
    case NIFTI_TYPE_FLOAT32:
      return "float32";
    case NIFTI_TYPE_FLOAT64:
      return "float64";
    default:
      return {};
  }
}

Mapping mapping_of(const nifti_image& image) {
  const mat44& m = image.sform_code > 0 ? image.sto_xyz : image.qto_xyz;
  Mat3 j;
  for (int a = 0; a < 3; ++a) j[a] = Vec3(m.m[0][a], m.m[1][a], m.m[2][a]);
  return Mapping::from_linear(j, Vec3(m.m[0][3], m.m[1][3], m.m[2][3]));
}

/// The bytes of the first volume, in the machine's order.
Result<std::vector<std::byte>> read_bytes(const std::string& path, const nifti_image& image, std::uint64_t file_size, std::size_t bytes) {
  const bool compressed = nifti_is_gzfile(image.iname) != 0;
  const auto offset = static_cast<std::uint64_t>(image.iname_offset);
  const auto short_of = [&](std::uint64_t has) {
    return Error{fmt::format("{}: the file is cut short, expected {} bytes of voxels after its header, it has {}", path, bytes, has)};
  };
  // a header that promises more than the file can hold (deflate packs at most 1032 : 1)
  constexpr std::uint64_t best_ratio = 1032;
  const std::uint64_t most = compressed ? file_size * best_ratio : file_size;
  if (offset > most || bytes > most - offset) return short_of(most > offset ? (compressed ? 0 : most - offset) : 0);
  znzFile file = znzopen(image.iname, "rb", compressed);
  if (znz_isnull(file)) return Error{fmt::format("{}: cannot be opened", path)};
  std::vector<std::byte> data(bytes);
  const bool placed = znzseek(file, static_cast<znz_off_t>(offset), SEEK_SET) >= 0;
  const std::size_t got = placed ? znzread(data.data(), 1, bytes, file) : 0;
  // one byte beyond lets the decompressor check its trailer when the volume is the whole file
  std::byte beyond{};
  const bool whole = image.nvox * static_cast<std::size_t>(image.nbyper) == bytes;
  bool sound = !whole || znzread(&beyond, 1, 1, file) <= 1;
  sound = znzclose(file) == 0 && sound;
  if (got != bytes) return short_of(got > bytes ? 0 : got);
  if (!sound) return Error{fmt::format("{}: the compressed file is cut short or damaged", path)};
  if (image.swapsize > 1 && image.byteorder != nifti_short_order())
    nifti_swap_Nbytes(bytes / static_cast<std::size_t>(image.swapsize), image.swapsize, data.data());
  return data;
}

/// The header is looked at first: the library reports some bad ones on stderr, whatever its debug level.
Image read_header(const std::string& path) {
  nifti_set_debug_level(0);
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(nifti_read_header(path.c_str(), &swapped, 0), &std::free);
  if (!header || nifti_hdr_looks_good(header.get()) == 0) return nullptr;
  const int dimensions = header->dim[0];
  if (dimensions < 1 || dimensions > 7 || header->datatype == DT_BINARY || header->datatype == DT_UNKNOWN) return nullptr;
  for (int d = 1; d <= dimensions; ++d)
    if (header->dim[d] < 1) return nullptr;
  return Image(nifti_image_read(path.c_str(), 0));
}

Result<Volume> read_volume(const std::string& path) {
  // the header
  CATENA_TRY(const std::uint64_t file_size, readable_file(path));
  const Image image = read_header(path);
  if (!image) return Error{fmt::format("{}: this is not a NIfTI-1 file, or its header is damaged", path)};
  const std::string_view word = word_of(image->datatype);
  const auto type = number_type(word);
  if (!type)
    return Error{fmt::format("{}: voxels of type {} are not supported, expected integers or floats (uint8 to int64, float32, float64)",
                             path, nifti_datatype_string(image->datatype))};
  if (image->nu > 1 || image->nv > 1 || image->nw > 1)
    return Error{
        fmt::format("{}: the image has {} dimensions (vectors or more), expected a scalar volume of 3, or 4 with time", path, image->ndim)};
  if (image->nx < 1 || image->ny < 1 || image->nz < 1 || image->iname_offset < 0 || !image->iname)
    return Error{fmt::format("{}: the header is damaged", path)};
  const Mapping mapping = mapping_of(*image);
  if (!is_finite(mapping.origin) || !is_finite(mapping.index_from_world(Vec3(1.0))) || !(mapping.smallest_edge() > 0))
    return Error{fmt::format("{}: the transform of the header cannot be inverted", path)};

  // the voxels of the first volume
  const long double wanted = static_cast<long double>(image->nx) * image->ny * image->nz * static_cast<long double>(type->bytes);
  if (wanted > 1e15L)
    return Error{fmt::format("{}: the header asks for {} x {} x {} voxels: it is damaged", path, image->nx, image->ny, image->nz)};
  CATENA_TRY(std::vector<std::byte> bytes, read_bytes(path, *image, file_size, static_cast<std::size_t>(wanted)));
  const bool scaled = image->scl_slope != 0 && std::isfinite(image->scl_slope) && std::isfinite(image->scl_inter);
  std::vector<float> values(bytes.size() / type->bytes);
  type->decode(bytes.data(), values.size(), scaled ? image->scl_slope : 1, scaled ? image->scl_inter : 0, values.data());
  bytes = {};

  auto grid = try_make_scalar_grid(stem_of(path), mapping, {image->nx, image->ny, image->nz}, values);
  if (!grid) return Error{path + ": the volume " + grid.error().message};
  return Volume{*grid, image->nt > 1 ? fmt::format("{}, first of {} volumes", word, image->nt) : std::string(word)};
}

}  // namespace

Result<AnyField> load_nifti(const LoadRequest& request) {
  const std::string name = stem_of(request.path);
  if (!request.grid.empty() && request.grid != name)
    return Error{fmt::format("{}: there is no grid \"{}\", a NIfTI file holds one, \"{}\"", request.path, request.grid, name)};
  if (request.valid_required) return Error{fmt::format("{}: a NIfTI file holds no mask", request.path)};
  CATENA_TRY(Volume volume, read_volume(request.path));
  count_file();
  count_grid();
  AnyField field;
  field.scalar = volume.grid;
  return field;
}

Result<std::vector<GridInfo>> describe_nifti(const std::string& path) {
  CATENA_TRY(Volume volume, read_volume(path));
  const ScalarGrid& grid = *volume.grid;
  GridInfo info;
  info.name = grid.name();
  info.type = volume.type;
  const Vec3 size = grid.index_box().hi;
  info.size = {static_cast<int>(size.x) + 1, static_cast<int>(size.y) + 1, static_cast<int>(size.z) + 1};
  info.mapping = grid.mapping();
  info.stats = grid.stats();
  info.bytes = grid.bytes();
  info.usable = true;
  return std::vector<GridInfo>{info};
}

}  // namespace catena::field
