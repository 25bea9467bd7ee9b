// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "engine/base/text.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/vtk/open.h"
namespace catena::vtk {
namespace {

/// Registry of the formats that VTK's own readers do not read.
struct Family {
  std::string_view ending;
  Result<ImportedData> (*open)(const Source& source);
};
constexpr Family kFamilies[] = {
    {".nrrd", open_with_itk},  {".nhdr", open_with_itk},     {".mha", open_with_itk}, {".mhd", open_with_itk},
    {".dcm", open_dicom},      {".npz", open_npz},           {".gii", open_gifti},    {".ply", open_ply},
    {".pvd", open_collection}, {".series", open_collection}, {".foam", open_foam},
};

}  // namespace

Result<ImportedData> open_any(const Source& source) {
  std::error_code code;
  if (std::filesystem::is_directory(source.path, code))
    return field::is_openfoam_case(source.path) ? open_foam(source) : open_dicom(source);
  for (const Family& family : kFamilies)
    if (has_extension(source.path, family.ending)) return family.open(source);
  if (is_dicom_file(source.path)) return open_dicom(source);
  return open_with_vtk(source);
}

}  // namespace catena::vtk
