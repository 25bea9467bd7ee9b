// SPDX-License-Identifier: MIT
// Writes NIfTI-1; the library creates the header and the stream. The sform stores the exact axes; orthogonal axes are also stored in the
// qform, for programs that read only the qform.
#include <nifti1_io.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

struct FreeWrittenImage {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
struct CloseStream {
  void operator()(znzFile file) const { znzclose(file); }
};

int nifti_unit(const std::string& word) {
  if (word == "mm") return NIFTI_UNITS_MM;
  if (word == "m") return NIFTI_UNITS_METER;
  if (word == "\u00b5m" || word == "um") return NIFTI_UNITS_MICRON;
  return NIFTI_UNITS_UNKNOWN;
}

nifti_1_header header_of(const VoxelBox& box) {
  const bool vector = box.components == 3;
  const int dims[8] = {vector ? 5 : 3, box.size.x, box.size.y, box.size.z, 1, vector ? 3 : 1, 1, 1};
  const std::unique_ptr<nifti_image, FreeWrittenImage> image(nifti_make_new_nim(dims, NIFTI_TYPE_FLOAT32, 0));
  image->nifti_type = NIFTI_FTYPE_NIFTI1_1;
  image->intent_code = vector ? NIFTI_INTENT_VECTOR : NIFTI_INTENT_NONE;
  image->xyz_units = nifti_unit(box.units.length);
  std::strncpy(image->intent_name, box.name.c_str(), sizeof image->intent_name - 1);
  const Mat3& steps = box.mapping.world_from_index_linear;
  mat44& m = image->sto_xyz;
  for (int r = 0; r < 3; ++r) {
    for (int a = 0; a < 3; ++a) m.m[r][a] = static_cast<float>(steps[a][r]);
    m.m[r][3] = static_cast<float>(box.mapping.origin[r]);
  }
  m.m[3][3] = 1;
  image->sform_code = box.units.is_patient_space ? NIFTI_XFORM_SCANNER_ANAT : NIFTI_XFORM_ALIGNED_ANAT;
  bool square = true;
  for (int a = 0; a < 3; ++a) square = square && std::fabs(dot(direction(steps[a]), direction(steps[(a + 1) % 3]))) < 1e-5;
  if (square) {
    image->qform_code = image->sform_code;
    nifti_mat44_to_quatern(m, &image->quatern_b, &image->quatern_c, &image->quatern_d, &image->qoffset_x, &image->qoffset_y,
                           &image->qoffset_z, nullptr, nullptr, nullptr, &image->qfac);
  }
  const auto edge = [&](int a) { return static_cast<float>(norm(steps[a])); };
  image->pixdim[1] = image->dx = edge(0);
  image->pixdim[2] = image->dy = edge(1);
  image->pixdim[3] = image->dz = edge(2);
  nifti_1_header header = nifti_convert_nim2nhdr(image.get());
  constexpr int kVoxels = 352;  // the header, and four bytes that declare no extensions
  header.vox_offset = kVoxels;
  return header;
}

/// Writes to the file `target`; errors name `path`.
Outcome write_into(const std::string& target, const std::string& path, const VoxelBox& box) {
  errno = 0;
  const auto failed = [&] { return system_error(path + ": cannot write", errno != 0 ? errno : EIO); };
  std::unique_ptr<znzptr, CloseStream> file(znzopen(target.c_str(), "wb", has_extension(path, ".gz")));
  if (!file) return failed();
  const auto write = [&](const void* data, std::size_t bytes) { return znzwrite(data, 1, bytes, file.get()) == bytes; };
  const nifti_1_header header = header_of(box);
  const char no_extensions[4]{};
  if (!write(&header, sizeof header) || !write(no_extensions, sizeof no_extensions)) return failed();
  // components one after the other, each as a volume
  const auto components = static_cast<std::size_t>(box.components);
  std::vector<float> values(box.layer_voxels() * components), one(components > 1 ? box.layer_voxels() : 0);
  for (std::size_t c = 0; c < components; ++c)
    for (int z = 0; z < box.size.z; ++z) {
      box.read_values_or_nan(z, values);
      for (std::size_t i = 0; i < one.size(); ++i) one[i] = values[i * components + c];
      const std::vector<float>& layer = components > 1 ? one : values;
      if (!write(layer.data(), layer.size() * sizeof(float))) return failed();
    }
  znzFile last = file.release();
  return znzclose(last) != 0 ? failed() : Outcome(Done{});
}

}  // namespace

Outcome write_nifti(const std::string& path, const VoxelBox& box) {
  constexpr int kMaxAxisVoxels = 32767;
  for (const int n : {box.size.x, box.size.y, box.size.z})
    if (n > kMaxAxisVoxels)
      return Error{fmt::format("{}: an axis has {} voxels, expected at most {} for NIfTI-1", path, n, kMaxAxisVoxels)};
  if (is_written_directly(path)) {
    CATENA_TRY(OutputFile direct, OutputFile::open(path));
    CATENA_CHECK(write_into(fmt::format("/proc/self/fd/{}", ::fileno(direct.stream())), path, box));
    return direct.commit();
  }
  // a symbolic link is resolved, so that its target is replaced
  std::error_code code;
  const bool link = std::filesystem::is_symlink(path, code);
  CATENA_TRY(TemporaryFile part, TemporaryFile::create(link ? std::filesystem::weakly_canonical(path, code).string() : path));
  CATENA_CHECK(write_into(part.name(), path, box));
  return part.commit();
}

}  // namespace catena::field
