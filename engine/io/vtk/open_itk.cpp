// SPDX-License-Identifier: MIT
// Opens NRRD and MetaImage with ITK. ITK provides only the numbers of an NRRD: its versions convert the space
// left-anterior-superior differently, so that the header is read here (nrrd_header.h). MetaImage uses patient space with +x left, +y
// posterior (LPS); Catena, like NIfTI, uses +x right, +y anterior (RAS): both formats are converted, unless the file states that its space
// is not patient space.
#include <fmt/format.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/volume/units.h"
#include "engine/io/vtk/itk_image.h"
#include "engine/io/vtk/nrrd_header.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

using field::Mapping;
using Io = itk::SmartPointer<itk::ImageIOBase>;

std::string stem(const std::string& path) {
  std::filesystem::path name = std::filesystem::path(path).filename();
  return name.stem().string();
}

/// Returns the beginning of a file, where formats with a text header have it.
std::string header_of(const std::string& path) {
  constexpr std::size_t kHeader = 8192;
  std::string header(kHeader, ' ');
  std::ifstream in(path, std::ios::binary);
  in.read(header.data(), static_cast<std::streamsize>(kHeader));
  header.resize(static_cast<std::size_t>(in.gcount()));
  return header;
}

/// Returns an Error if the number of axes is more than MetaIO has memory for; MetaIO does not check it.
Outcome check_dimensions(const std::string& path) {
  constexpr long long kMaxAxes = 10;
  std::istringstream lines(header_of(path));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || trim(std::string_view(line).substr(0, equals)) != "NDims") continue;
    const std::string_view word = trim(std::string_view(line).substr(equals + 1));
    const auto axes = parse_integer(word);
    if (!axes || *axes < 1 || *axes > kMaxAxes)
      return Error{fmt::format("NDims is {}, expected 1 to {}", sanitize_for_terminal(std::string(word.substr(0, 40))), kMaxAxes)};
  }
  return Done{};
}

/// Meaning of the numbers of a voxel, and the mapping from the file's space to Catena's.
struct Meaning {
  Mapping mapping;
  bool patient = false;
  NrrdRange range = NrrdRange::directions;  ///< meaning of the numbers of a voxel with several
  std::array<double, 2> signs{1, 1};        ///< signs of the x and y components of directions
  std::vector<std::vector<double>> frame{};
  std::string kind{};  ///< as named in the file
};

std::string left_out(const std::string& name, const std::string& kind, int components) {
  return fmt::format(
      "{} ({}{} numbers per voxel), the only array of the file, cannot be read; expected one number per voxel, or vectors of 2 or 3", name,
      kind.empty() ? "" : kind + ", ", components);
}

/// Returns an Error for files that ITK refuses without a clear message: an axis without a kind and a direction that counts neither
/// positions nor components; general matrices with a mask; a "3-gradient", whose size ITK does not know.
Outcome check_axes(const std::string& path, const std::string& name) {
  CATENA_TRY(const NrrdHeader header, read_nrrd_header(path));
  for (const std::string& kind : header.kinds) {
    if (kind == "2D-masked-matrix" || kind == "3D-masked-matrix") return Error{left_out(name, kind, kind.front() == '2' ? 5 : 10)};
    if (kind == "3-gradient") return Error{"the kind \"3-gradient\" is not supported, expected \"covariant-vector\", which is equivalent"};
  }
  if (const std::size_t axis = header.ambiguous_axis(); axis > 0)
    return Error{fmt::format(
        "axis {} has neither a direction (\"none\") nor a kind, expected its kind in a line \"kinds:\", such as vector, RGB-color or list",
        axis)};
  return Done{};
}

Result<Meaning> meaning_of_nrrd(const Io& io, const std::string& path) {
  CATENA_TRY(const NrrdHeader header, read_nrrd_header(path));
  return Meaning{header.mapping().value_or(read_mapping(*io)),
                 header.is_patient(),
                 header.range(),
                 header.ras_signs(),
                 header.measurement_frame,
                 header.range_kind()};
}

/// Meaning of a MetaImage. ITK's world is that of the header: left, posterior, superior of the patient. MetaImage does not specify the
/// meaning of several numbers per voxel: unsigned integers have no sign that could be flipped.
Meaning meaning_of_meta_image(const Io& io, const std::string& path) {
  Meaning meaning{read_mapping(*io)};
  const std::string header = header_of(path);
  const std::size_t at = header.find("AnatomicalOrientation");
  meaning.patient = at != std::string::npos && header.substr(at, header.find('\n', at) - at).find('?') == std::string::npos;
  if (meaning.patient) meaning.mapping = ras_from_lps(meaning.mapping), meaning.signs = {-1, -1};
  using enum itk::IOComponentEnum;
  const auto type = io->GetComponentType();
  for (const auto without_sign : {UCHAR, USHORT, UINT, ULONG, ULONGLONG})
    if (type == without_sign) meaning.range = NrrdRange::numbers, meaning.kind = "unsigned integers";
  return meaning;
}

/// Transforms directions from the file's axes to the world's: by an NRRD's measurement frame, and by flipping x and y where they differ.
vtkSmartPointer<vtkDataArray> transformed_vectors(const vtkSmartPointer<vtkDataArray>& values, const Meaning& meaning) {
  const int components = values->GetNumberOfComponents();
  if ((components != 2 && components != 3) || (meaning.range != NrrdRange::directions && meaning.range != NrrdRange::points)) return values;
  const auto component_count = static_cast<std::size_t>(components);
  double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // columns
  if (meaning.range == NrrdRange::directions && meaning.frame.size() == component_count)
    for (std::size_t k = 0; k < component_count; ++k)
      for (std::size_t c = 0; c < component_count && c < meaning.frame[k].size(); ++c) frame[k][c] = meaning.frame[k][c];
  const bool fits_float = values->GetDataType() == VTK_FLOAT || values->GetDataTypeSize() <= 2;
  const auto transformed = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(fits_float ? VTK_FLOAT : VTK_DOUBLE));
  transformed->SetNumberOfComponents(components);
  transformed->SetNumberOfTuples(values->GetNumberOfTuples());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) {
    double v[3] = {0, 0, 0}, world[3] = {0, 0, 0};
    values->GetTuple(i, v);
    for (int k = 0; k < components; ++k)
      for (int c = 0; c < components; ++c) world[c] += frame[k][c] * v[k];
    for (std::size_t c = 0; c < 2; ++c) world[c] *= meaning.signs[c];
    transformed->SetTuple(i, world);
  }
  return transformed;
}

Io io_of(const std::string& path) {
  if (has_extension(path, ".nrrd") || has_extension(path, ".nhdr")) return itk::NrrdImageIO::New().GetPointer();
  return itk::MetaImageIO::New().GetPointer();
}

}  // namespace

Result<ImportedData> open_with_itk(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.display_name + ": " + what)}; };
  try {
    const Io io = io_of(source.path);
    const bool nrrd = dynamic_cast<itk::NrrdImageIO*>(io.GetPointer()) != nullptr;
    const auto clear = nrrd ? check_axes(source.path, stem(source.display_name)) : check_dimensions(source.path);
    if (!clear) return failed(clear.error().message);
    if (!io->CanReadFile(source.path.c_str())) return failed("cannot be read: the contents do not match the file extension");
    io->SetFileName(source.path);
    io->ReadImageInformation();
    if (to_vtk_type(io->GetComponentType()) == 0) return failed("has voxels of an unknown type, expected integers or floats");
    const auto shape = read_image_extent(*io);
    if (!shape) return failed(shape.error().message);
    const auto known = nrrd ? meaning_of_nrrd(io, source.path) : Result<Meaning>(meaning_of_meta_image(io, source.path));
    if (!known) return failed(known.error().message);
    const Meaning& meaning = *known;
    const auto components = static_cast<int>(io->GetNumberOfComponents());
    if (components > 3 || (components > 1 && meaning.range == NrrdRange::other))
      return failed(left_out(stem(source.display_name), meaning.kind, components));
    ImportedData opened;
    // these formats cannot declare a fourth axis as time
    const auto read = read_all_voxels(*io, shape->voxel_count() * static_cast<std::size_t>(shape->volume_count));
    if (!read) return failed(read.error().message);
    vtkSmartPointer<vtkDataArray> values = *read;
    if (shape->volume_count > 1) {
      const int volume = std::min(source.step, shape->volume_count - 1);
      const auto one = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
      one->SetNumberOfComponents(values->GetNumberOfComponents());
      const auto voxels = static_cast<vtkIdType>(shape->voxel_count());
      one->SetNumberOfTuples(voxels);
      one->InsertTuples(0, voxels, volume * voxels, values);
      values = one;
      opened.notes.push_back(
          fmt::format("volume {} of {}, counted from 0, is read; \"step\" of the field selects the volume", volume, shape->volume_count));
    }
    opened.is_patient_space = meaning.patient;
    if (components > 1 && meaning.range == NrrdRange::numbers)
      opened.notes.push_back(
          fmt::format("the {} numbers of a voxel are not a direction ({}) and are read without rotation", components, meaning.kind));
    opened.blocks.push_back(
        {make_image_data(shape->size, transformed_vectors(values, meaning), stem(source.display_name)), meaning.mapping});
    if (opened.is_patient_space) opened.unit_length = "mm";
    const itk::MetaDataDictionary& words = io->GetMetaDataDictionary();
    for (const char* key : {"NRRD_space units[0]", "NRRD_space units[1]"})
      if (const std::string unit = metadata_text(words, key); field::is_unit_name(unit)) opened.unit_length = unit;
    return opened;
  } catch (const itk::ExceptionObject& e) {
    return failed(fmt::format("cannot be read ({})", error_message(e)));
  }
}

}  // namespace catena::vtk
