// SPDX-License-Identifier: MIT
// The formats that catena-read-vtk reads, with their readers: the counterpart of remote_formats() in engine/io/volume/load_remote.cpp.
#include <fmt/format.h>

#include <filesystem>

#include "engine/base/text.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

struct Format {
  std::string_view extension;
  Result<ImportedData> (*open)(const Source& source);
};
/// All extensions but those of VTK's XML files.
constexpr Format kFormats[] = {
    {".vtk", open_vtk_legacy}, {".vtm", open_vtk_blocks}, {".vtmb", open_vtk_blocks},   {".nrrd", open_with_itk}, {".nhdr", open_with_itk},
    {".mha", open_with_itk},   {".mhd", open_with_itk},   {".dcm", open_dicom},         {".npz", open_npz},       {".gii", open_gifti},
    {".ply", open_ply},        {".pvd", open_collection}, {".series", open_collection}, {".foam", open_foam},     {".case", open_ensight},
    {".encas", open_ensight},  {".cgns", open_cgns},      {".nc", open_netcdf},         {".cdf", open_netcdf},
};

}  // namespace

Result<ImportedData> open_any(const Source& source) {
  std::error_code code;
  if (std::filesystem::is_directory(source.path, code))
    return field::is_openfoam_case(source.path) ? open_foam(source) : open_dicom(source);
  for (const Format& format : kFormats)
    if (has_extension(source.path, format.extension)) return format.open(source);
  if (is_dicom_file(source.path)) return open_dicom(source);
  return open_vtk_xml(source);
}

}  // namespace catena::vtk
