#include <fmt/format.h>

#include <filesystem>

#include "engine/base/text.h"
#include "engine/vtk/open.h"

namespace catena::vtk {
namespace {

/// The registry: what VTK's own families do not read.
struct Family {
  std::string_view ending;
  Result<Opened> (*open)(const Source& source);
};
constexpr Family kFamilies[] = {
    {".nrrd", open_with_itk}, {".nhdr", open_with_itk}, {".mha", open_with_itk}, {".mhd", open_with_itk},
    {".dcm", open_with_itk},  {".npz", open_npz},       {".gii", open_gifti},
};

}  // namespace

Result<Opened> open_any(const Source& source) {
  std::error_code code;
  if (std::filesystem::is_directory(source.path, code)) return open_dicom_folder(source);
  for (const Family& family : kFamilies)
    if (has_ending(source.path, family.ending)) return family.open(source);
  return open_with_vtk(source);
}

}  // namespace catena::vtk
