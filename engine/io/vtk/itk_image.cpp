// SPDX-License-Identifier: MIT
#include "engine/io/vtk/itk_image.h"

#include <fmt/format.h>
#include <itkMetaDataObject.h>
#include <vtkPointData.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/io/vtk/truncation_check.h"

namespace catena::vtk {

using field::Mapping;

std::string metadata_text(const itk::MetaDataDictionary& words, const std::string& key) {
  std::string text;
  itk::ExposeMetaData<std::string>(words, key, text);
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  return end == std::string::npos ? std::string() : text.substr(0, end + 1);
}

int to_vtk_type(itk::IOComponentEnum type) {
  switch (type) {
    case itk::IOComponentEnum::UCHAR:
      return VTK_UNSIGNED_CHAR;
    case itk::IOComponentEnum::CHAR:
      return VTK_SIGNED_CHAR;
    case itk::IOComponentEnum::USHORT:
      return VTK_UNSIGNED_SHORT;
    case itk::IOComponentEnum::SHORT:
      return VTK_SHORT;
    case itk::IOComponentEnum::UINT:
      return VTK_UNSIGNED_INT;
    case itk::IOComponentEnum::INT:
      return VTK_INT;
    case itk::IOComponentEnum::ULONG:
      return VTK_UNSIGNED_LONG;
    case itk::IOComponentEnum::LONG:
      return VTK_LONG;
    case itk::IOComponentEnum::ULONGLONG:
      return VTK_UNSIGNED_LONG_LONG;
    case itk::IOComponentEnum::LONGLONG:
      return VTK_LONG_LONG;
    case itk::IOComponentEnum::FLOAT:
      return VTK_FLOAT;
    case itk::IOComponentEnum::DOUBLE:
      return VTK_DOUBLE;
    default:
      return 0;
  }
}

Mapping read_mapping(const itk::ImageIOBase& io) {
  Mat3 linear(1.0);
  Vec3 origin(0.0);
  const unsigned axes = std::min(3u, io.GetNumberOfDimensions());
  for (unsigned a = 0; a < axes; ++a) {
    const std::vector<double> direction = io.GetDirection(a);
    for (unsigned c = 0; c < 3; ++c)
      linear[static_cast<int>(a)][static_cast<int>(c)] = c < direction.size() ? direction[c] * io.GetSpacing(a) : 0;
    origin[static_cast<int>(a)] = io.GetOrigin(a);
  }
  return Mapping::from_linear(linear, origin);
}

Mapping ras_from_lps(const Mapping& m) {
  Mat3 linear = m.world_from_index_linear;
  Vec3 origin = m.origin;
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 2; ++c) linear[a][c] = -linear[a][c];
  for (int c = 0; c < 2; ++c) origin[c] = -origin[c];
  return Mapping::from_linear(linear, origin);
}

std::string error_message(const itk::ExceptionObject& error) {
  std::string words = strip_addresses(error.GetDescription());
  // NRRD's library reports every function on the call path as a line "[nrrd] FUNCTION: WHAT"; the last one is the cause
  constexpr std::string_view kNrrd = "[nrrd] ";
  if (const auto last = words.rfind(kNrrd); last != std::string::npos) {
    words.erase(0, last + kNrrd.size());
    if (const auto name = words.find(": "); name != std::string::npos) words.erase(0, name + 2);
    return words;
  }
  // "itk::ERROR: CLASS: WHAT"
  const auto object = words.find(": ", 12);
  return (words.starts_with("ITK ERROR: ") || words.starts_with("itk::ERROR: ")) && object != std::string::npos ? words.substr(object + 2)
                                                                                                                : words;
}

Result<ImageExtent> read_image_extent(const itk::ImageIOBase& io) {
  ImageExtent shape;
  double all = 1;
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    const auto n = io.GetDimensions(a);
    all *= static_cast<double>(n);
    if (n < 1 || n > 1'000'000) return Error{fmt::format("the size of axis {} is {}, expected 1 to 1000000", a + 1, n)};
    if (all > 1e12) return Error{fmt::format("the first {} axes have {:.3g} voxels, expected at most 1e12", a + 1, all)};
    if (a < 3)
      shape.size[a] = static_cast<int>(n);
    else
      shape.volume_count *= static_cast<int>(n);
  }
  return shape;
}

Result<vtkSmartPointer<vtkDataArray>> read_all_voxels(itk::ImageIOBase& io, std::size_t all_voxels) {
  const auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(to_vtk_type(io.GetComponentType())));
  values->SetNumberOfComponents(static_cast<int>(io.GetNumberOfComponents()));
  values->SetNumberOfTuples(static_cast<vtkIdType>(all_voxels));
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) region.SetSize(a, io.GetDimensions(a));
  io.SetIORegion(region);
  const auto value_bytes = static_cast<std::size_t>(values->GetDataTypeSize());
  const std::size_t bytes = value_bytes * static_cast<std::size_t>(values->GetNumberOfValues());
  void* const memory = values->GetVoidPointer(0);
  CATENA_CHECK(read_checking_truncation(static_cast<std::byte*>(memory), bytes, value_bytes, [&] { io.Read(memory); }));
  return values;
}

vtkSmartPointer<vtkImageData> make_image_data(const int (&size)[3], const vtkSmartPointer<vtkDataArray>& values, const std::string& name) {
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0], size[1], size[2]);
  values->SetName(name.c_str());
  image->GetPointData()->SetScalars(values);
  return image;
}

}  // namespace catena::vtk
