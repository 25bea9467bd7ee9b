// SPDX-License-Identifier: MIT
/// Stands before ITK's NRRD reader in a second catena-read-vtk: it answers with x and y of all axes turned round. In the space
/// left-anterior-superior that is what an ITK that turns y to the back, as its documentation has it, would answer; ITK 5.2 turns x.
#include <dlfcn.h>
#include <itkMetaDataObject.h>
#include <itkNrrdImageIO.h>

#include <algorithm>

void itk::NrrdImageIO::ReadImageInformation() {
  using Function = void (*)(NrrdImageIO*);
  static const auto original = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "_ZN3itk11NrrdImageIO20ReadImageInformationEv"));
  original(this);
  for (unsigned a = 0; a < GetNumberOfDimensions(); ++a) {
    std::vector<double> direction = GetDirection(a);
    for (std::size_t c = 0; c < std::min<std::size_t>(2, direction.size()); ++c) direction[c] = -direction[c];
    SetDirection(a, direction);
    if (a < 2) SetOrigin(a, -GetOrigin(a));
  }
  // so that a test sees that it was asked
  EncapsulateMetaData<std::string>(GetMetaDataDictionary(), "NRRD_space units[0]", "km");
}
