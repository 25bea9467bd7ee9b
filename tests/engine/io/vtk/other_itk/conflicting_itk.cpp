// SPDX-License-Identifier: MIT
/// Replaces ITK's NRRD reader in a second catena-read-vtk, with x and y of all axes negated. In the space left-anterior-superior this
/// is the result of an ITK that negates y, as its documentation states; ITK 5.2 negates x.
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
  // A mark by which the test sees that this reader was used.
  EncapsulateMetaData<std::string>(GetMetaDataDictionary(), "NRRD_space units[0]", "km");
}
