// SPDX-License-Identifier: MIT
// Loads NIfTI-1 volumes. The library reads the header and opens the (compressed) stream; the voxels are decoded here, because the
// library's own reader turns NaN into 0. World: the sform, else the qform, else the voxel sizes; millimeters, RAS, as stored.
#include <nifti1_io.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/base/text.h"
#include "engine/field/number_type.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

struct FreeImage {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
using Image = std::unique_ptr<nifti_image, FreeImage>;

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

Mapping mapping_of(const mat44& m) {
  Mat3 j;
  for (int a = 0; a < 3; ++a) j[a] = Vec3(m.m[0][a], m.m[1][a], m.m[2][a]);
  return Mapping::from_linear(j, Vec3(m.m[0][3], m.m[1][3], m.m[2][3]));
}

bool is_usable(const Mapping& mapping) {
  return is_finite(mapping.origin) && is_finite(mapping.index_from_world(Vec3(1.0))) && mapping.min_voxel_edge() > 0;
}

/// Returns the mapping by the sform, else the qform, else the voxel sizes. Adds a note if the sform cannot be used, or if the two differ.
Result<Mapping> placement_of(const nifti_image& image, const std::string& path, std::vector<std::string>& notes) {
  const bool has_sform = image.sform_code > 0, has_qform = image.qform_code > 0;
  const Mapping sform = mapping_of(image.sto_xyz), qform = mapping_of(image.qto_xyz);
  if (has_sform && is_usable(sform)) {
    if (!has_qform || !is_usable(qform)) return sform;
    double max_difference = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 index((corner & 1) * (image.nx - 1.0), (corner >> 1 & 1) * (image.ny - 1.0), (corner >> 2) * (image.nz - 1.0));
      max_difference = std::max(max_difference, norm(sform.world_from_index(index) - qform.world_from_index(index)));
    }
    constexpr double kOfVoxel = 0.01;
    if (max_difference > kOfVoxel * sform.min_voxel_edge())
      notes.push_back(fmt::format("the sform ({}) and the qform ({}) differ by up to {:.3g} at the corners: the sform is used",
                                  nifti_xform_string(image.sform_code), nifti_xform_string(image.qform_code), max_difference));
    return sform;
  }
  if (has_sform && !has_qform)
    return Error{fmt::format("{}: the transform in the header (sform) cannot be inverted, and there is no qform", path)};
  if (!is_usable(qform)) return Error{fmt::format("{}: the transform in the header cannot be inverted", path)};
  if (has_sform) notes.push_back("the sform cannot be inverted: the qform is used");
  return qform;
}

/// The voxels of one volume, in order. The library's stream is decompressed only as far as the header specifies.
class NiftiLayers {
 public:
  NiftiLayers(const std::string& path, const nifti_image& image, const NumberType& type, bool swapped, std::uint64_t file_size, int volume)
      : path_(path), type_(type), swapped_(swapped) {
    if (image.scl_slope != 0 && std::isfinite(image.scl_slope) && std::isfinite(image.scl_inter)) {
      slope_ = image.scl_slope;
      inter_ = image.scl_inter;
    }
    compressed_ = nifti_is_gzfile(image.iname) != 0;
    offset_ = static_cast<std::uint64_t>(image.iname_offset);
    bytes_ = static_cast<std::uint64_t>(image.nx) * image.ny * image.nz * type.bytes;
    offset_ += static_cast<std::uint64_t>(volume) * bytes_;
    whole_ = image.nvox * static_cast<std::size_t>(image.nbyper) == bytes_;
    file_size_ = file_size;
  }

  /// Opens the stream. Returns an Error before anything is read if the header specifies more data than the file can contain.
  Outcome open(const char* name) {
    constexpr std::uint64_t best_ratio = 1032;  // maximum compression ratio of deflate
    const std::uint64_t max_size = compressed_ ? file_size_ * best_ratio : file_size_;
    if (offset_ > max_size || bytes_ > max_size - offset_) return cut(max_size > offset_ ? (compressed_ ? 0 : max_size - offset_) : 0);
    file_.reset(znzopen(name, "rb", compressed_));
    if (!file_) return Error{fmt::format("{}: cannot be opened", path_)};
    if (znzseek(file_.get(), static_cast<znz_off_t>(offset_), SEEK_SET) < 0) return cut(0);
    return Done{};
  }

  Outcome read(std::span<float> values) {
    constexpr std::size_t kPiece = 1 << 18;  // numbers
    raw_.resize(kPiece * type_.bytes);
    for (std::size_t at = 0; at < values.size(); at += kPiece) {
      const std::size_t count = std::min(kPiece, values.size() - at), requested = count * type_.bytes;
      const std::size_t received = znzread(raw_.data(), 1, requested, file_.get());
      done_ += received <= requested ? received : 0;
      if (received != requested) return cut(done_);
      if (swapped_ && type_.bytes > 1) nifti_swap_Nbytes(count, static_cast<int>(type_.bytes), raw_.data());
      type_.decode(raw_.data(), count, slope_, inter_, values.data() + at, *rounding);
    }
    if (done_ < bytes_) return Done{};
    // reading one more byte lets the decompressor check its trailer if the volume is the whole file
    std::byte next_byte{};
    bool complete = !whole_ || znzread(&next_byte, 1, 1, file_.get()) <= 1;
    znzFile last = file_.release();
    complete = znzclose(last) == 0 && complete;
    if (!complete) return Error{fmt::format("{}: the compressed file is truncated or damaged", path_)};
    return Done{};
  }

  const std::shared_ptr<RoundingLoss> rounding = std::make_shared<RoundingLoss>();

 private:
  struct Close {
    void operator()(znzFile file) const { znzclose(file); }
  };
  Error cut(std::uint64_t has) const {
    return Error{fmt::format("{}: the file is truncated, expected {} bytes of voxels after the header, found {}", path_, bytes_, has)};
  }

  std::string path_;
  NumberType type_;
  bool swapped_, compressed_ = false, whole_ = false;
  double slope_ = 1, inter_ = 0;
  std::uint64_t offset_ = 0, bytes_ = 0, file_size_ = 0, done_ = 0;
  std::unique_ptr<znzptr, Close> file_;
  std::vector<std::byte> raw_;
};

/// Steps along the fourth axis.
struct Steps {
  std::vector<double> times;  ///< seconds; empty if the axis is not time
  std::string interval;       ///< message fragment for the type
  std::string note;           ///< message on missing times; empty: none
};
Steps steps_of(const nifti_image& image, double dt, int volume) {
  Steps steps;
  if (image.nt <= 1) return steps;
  const std::string volume_text = fmt::format("volume {} of {}, counted from 0: ", volume, image.nt);
  const std::string other = "; \"step\" of the field selects the volume";
  const double unit = image.time_units == NIFTI_UNITS_SEC    ? 1
                      : image.time_units == NIFTI_UNITS_MSEC ? 1e-3
                      : image.time_units == NIFTI_UNITS_USEC ? 1e-6
                                                             : 0;
  if (unit == 0) {
    const std::string unit_text = image.time_units > 0 ? std::string(", but in ") + nifti_units_string(image.time_units)
                                  : dt != 0            ? fmt::format(" (pixdim[4] is {:g}, without a unit)", dt)
                                                       : "";
    steps.note = volume_text + "the header does not declare the volumes as time steps" + unit_text + other;
  } else if (!(dt > 0) || !std::isfinite(dt) || !std::isfinite(image.toffset)) {
    steps.note = volume_text + fmt::format("the time between volumes, pixdim[4], is {:g}, so that the volumes have no times", dt) + other;
  } else {
    for (int i = 0; i < image.nt; ++i) steps.times.push_back(unit * (static_cast<double>(image.toffset) + i * dt));
    steps.interval = fmt::format(", {:g} s apart, the first at {:g} s", unit * dt, steps.times.front());
  }
  return steps;
}

struct Header {
  Image image;
  bool swapped = false;
  std::array<float, 5> pixdim{};  ///< as stored: the library replaces 0 by 1
};

/// Reads the header, checking it before the library does: the library reports some errors on stderr, whatever its debug level, and accepts
/// a voxel offset that is not a number. Extensions, which may be of any size, are not read.
Result<Header> read_header(const std::string& path) {
  nifti_set_debug_level(0);
  const auto unknown = [&] {
    std::array<unsigned char, 4> first{};
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(first.data()), first.size());
    const bool second = (first[0] == 28 && first[1] == 2) || (first[2] == 2 && first[3] == 28);  // 540, the size of the NIfTI-2 header
    if (second) return Error{fmt::format("{}: this is a NIfTI-2 file, expected NIfTI-1", path)};
    if (first[0] == 0x1f && first[1] == 0x8b && !has_extension(path, ".gz"))
      return Error{fmt::format("{}: the file is compressed, expected a file name that ends in .nii.gz", path)};
    return Error{fmt::format("{}: this is not a NIfTI-1 file, or its header is damaged", path)};
  };
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(nifti_read_header(path.c_str(), &swapped, 0), &std::free);
  if (!header || nifti_hdr_looks_good(header.get()) == 0) return unknown();
  const int dimensions = header->dim[0];
  if (dimensions < 1 || dimensions > 7 || header->datatype == DT_BINARY || header->datatype == DT_UNKNOWN) return unknown();
  for (int d = 1; d <= dimensions; ++d)
    if (header->dim[d] < 1) return unknown();
  constexpr std::int32_t kMaxOffset = 1 << 28;
  if (!(header->vox_offset >= 0 && header->vox_offset <= static_cast<float>(kMaxOffset)))
    return Error{fmt::format("{}: vox_offset is {}, expected 0 to {} bytes", path, header->vox_offset, kMaxOffset)};
  Header read{Image(nifti_convert_nhdr2nim(*header, path.c_str())), swapped != 0, {}};
  if (!read.image) return unknown();
  std::copy_n(header->pixdim, read.pixdim.size(), read.pixdim.begin());
  return read;
}

}  // namespace

static Result<DenseFile> open_nifti(const LoadRequest& request) {
  const std::string &path = request.path, name = io::file_stem(request.path);
  if (!request.grid.empty() && request.grid != name)
    return Error{fmt::format("{}: there is no grid \"{}\"; the only grid of the NIfTI file is \"{}\"", path, request.grid, name)};
  if (request.mask_required) return Error{fmt::format("{}: a NIfTI file has no mask", path)};
  // the header
  CATENA_TRY(const std::uint64_t file_size, readable_file_size(path));
  CATENA_TRY(const Header header, read_header(path));
  const nifti_image& image = *header.image;
  const std::string_view word = word_of(image.datatype);
  const auto type = find_number_type(word);
  if (!type)
    return Error{fmt::format("{}: voxels of type {} are not supported, expected integers or floats (uint8 to int64, float32, float64)",
                             path, nifti_datatype_string(image.datatype))};
  const bool is_vector = image.nu == 3 && image.nt <= 1 && image.nv <= 1 && image.nw <= 1;
  if (!is_vector && (image.nu > 1 || image.nv > 1 || image.nw > 1))
    return Error{
        fmt::format("{}: the image has {} dimensions, expected a volume with 3 dimensions, 4 with time, or 5 with vectors of 3 components",
                    path, image.ndim)};
  if (image.nx < 1 || image.ny < 1 || image.nz < 1 || image.iname_offset < 0 || !image.iname)
    return Error{fmt::format("{}: the header is damaged", path)};
  std::vector<std::string> notes;
  CATENA_TRY(const Mapping mapping, placement_of(image, path, notes));
  for (std::size_t a = 1; a <= 3 && image.sform_code <= 0; ++a)
    if (static_cast<int>(a) <= image.ndim && (header.pixdim[a] == 0 || !std::isfinite(header.pixdim[a])))
      notes.push_back(fmt::format(
          "the voxel size pixdim[{}] is {:g}, expected a finite number other than 0: 1 of the file's unit of length is used instead", a,
          header.pixdim[a]));
  if (image.scl_slope != 0 && !(std::isfinite(image.scl_slope) && std::isfinite(image.scl_inter)))
    notes.push_back("scl_slope or scl_inter is not finite: the stored values are used unscaled");
  // the requested volume; dimensions are 16-bit numbers
  const int volumes = std::max(image.nt, 1), volume = std::min(request.step, volumes - 1);
  // the components of vectors are volumes, one after the other
  std::vector<std::shared_ptr<NiftiLayers>> components;
  for (int c = 0; c < (is_vector ? 3 : 1); ++c)
    components.push_back(std::make_shared<NiftiLayers>(path, image, *type, header.swapped, file_size, volume + c));
  const auto layers = components.front();
  if (const auto voxels = find_file_id(image.iname)) register_inputs({*voxels});  // a second file (.img) if the header names one
  for (const auto& component : components) CATENA_CHECK(component->open(image.iname));
  if (is_vector) notes.push_back("the components of the vectors are used as stored; ITK and ANTs store them in LPS axes");
  Steps steps = steps_of(image, static_cast<double>(header.pixdim[4]), volume);
  DenseFile file{name,
                 volumes > 1 ? fmt::format("{}, one of {} volumes{}", word, volumes, steps.interval) : std::string(word),
                 path + ": the volume ",
                 mapping,
                 static_cast<int>(components.size()),
                 {}};
  file.times = std::move(steps.times);
  if (!file.times.empty()) file.time_unit = "s";
  if (!steps.note.empty()) notes.push_back(steps.note);
  file.notes = std::move(notes);
  file.rounding = layers->rounding;
  file.source.size = {image.nx, image.ny, image.nz};
  CATENA_CHECK(check_dense_memory(fmt::format("{}: the grid of {} x {} x {} voxels", path, image.nx, image.ny, image.nz), file.source.size,
                                  file.components,
                                  /*masked=*/false));
  file.source.read = [components](int, int, std::span<float> values, std::span<std::uint8_t>) -> Outcome {
    if (components.size() == 1) return components.front()->read(values);
    std::vector<float> one(values.size() / components.size());
    for (std::size_t c = 0; c < components.size(); ++c) {
      CATENA_CHECK(components[c]->read(one));
      for (std::size_t i = 0; i < one.size(); ++i) values[i * components.size() + c] = one[i];
    }
    return Done{};
  };
  return file;
}

}  // namespace catena::field

namespace catena::io {

Format nifti_format() {
  return {.name = "NIfTI-1",
          .extensions = {".nii", ".nii.gz"},
          .volume = {.open = field::open_nifti, .describe = field::describe_by_loading, .units = field::read_nifti_units},
          .write_volume = field::write_box<field::write_nifti>,
          .has_float_positions = true};
}

}  // namespace catena::io
