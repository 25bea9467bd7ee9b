// Medical images as ITK reads them: NRRD, MetaImage, a file of DICOM. ITK's world is a patient's with +x to the left and +y to the back;
// Catena's, as NIfTI's, has +x to the right and +y to the front: both are turned round, unless the file says that its space is no
// patient's.
#include <fmt/format.h>
#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>

#include <filesystem>
#include <fstream>

#include "engine/base/text.h"
#include "engine/field/units.h"
#include "engine/vtk/itk_image.h"
#include "engine/vtk/open.h"

namespace catena::vtk {
namespace {

using field::Mapping;
using Io = itk::SmartPointer<itk::ImageIOBase>;

/// The start of a file, where formats with a header of text have it.
std::string header_of(const std::string& path) {
  constexpr std::size_t kHeader = 8192;
  std::string header(kHeader, ' ');
  std::ifstream in(path, std::ios::binary);
  in.read(header.data(), static_cast<std::streamsize>(kHeader));
  header.resize(static_cast<std::size_t>(in.gcount()));
  return header;
}

/// A patient's space of an NRRD, as "las" or "left-anterior-superior"; empty: it is in none. The header says it: ITK has turned some spaces
/// by the time it tells, and calls all of them left, back, head.
std::string patient_space(const std::string& path) {
  const std::string header = header_of(path);
  const std::size_t at = header.find("\nspace: ");
  if (at == std::string::npos) return {};
  std::string word = header.substr(at + 8, header.find_first_of("\r\n", at + 8) - at - 8);
  for (char& c : word) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  for (const char* known : {"ras", "las", "lps", "right-anterior-superior", "left-anterior-superior", "left-posterior-superior"})
    if (word.starts_with(known)) return word;
  return {};
}
bool is_left(const std::string& space) { return space.starts_with('l'); }
bool is_posterior(const std::string& space) { return space.starts_with("lp") || space.starts_with("left-posterior"); }

/// How ITK's world lies to Catena's. ITK says left, back, head of a patient; but of an NRRD in left, front, head it turns x alone, and what
/// it gives is right, front, head already.
Mapping world_of(const std::string& path, const Mapping& mapping) {
  const std::string space = patient_space(path);
  return is_left(space) && !is_posterior(space) ? mapping : turned_round(mapping);
}

/// Vectors in the file's own axes, to those of the world: by an NRRD's measurement frame, and what of x and y points the other way.
vtkSmartPointer<vtkDataArray> turned_vectors(const Io& io, const std::string& path, const vtkSmartPointer<vtkDataArray>& values,
                                             bool patient) {
  if (values->GetNumberOfComponents() != 3) return values;
  const itk::MetaDataDictionary& words = io->GetMetaDataDictionary();
  const std::string space = patient_space(path);
  const bool nrrd = dynamic_cast<itk::NrrdImageIO*>(io.GetPointer()) != nullptr;
  double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // columns
  std::vector<std::vector<double>> stated;
  if (itk::ExposeMetaData(words, "NRRD_measurement frame", stated) && stated.size() >= 3)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3 && c < stated[k].size(); ++c) frame[k][c] = stated[k][c];
  // a frame that is stated has been turned by ITK together with the space
  const bool left = !nrrd || is_left(space), posterior = !nrrd || is_posterior(space), framed = !stated.empty();
  const bool turn_x = framed ? posterior || !left : left, turn_y = framed ? posterior || !left : posterior;
  const double sign[2] = {patient && turn_x ? -1.0 : 1.0, patient && turn_y ? -1.0 : 1.0};
  const auto turned = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_FLOAT));
  turned->SetNumberOfComponents(3);
  turned->SetNumberOfTuples(values->GetNumberOfTuples());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) {
    double v[3], world[3] = {0, 0, 0};
    values->GetTuple(i, v);
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) world[c] += frame[k][c] * v[k];
    for (int c = 0; c < 2; ++c) world[c] *= sign[c];
    turned->SetTuple(i, world);
  }
  return turned;
}

/// Whether the axes of the world are a patient's.
bool is_patient(const Io& io, const std::string& path) {
  if (dynamic_cast<itk::GDCMImageIO*>(io.GetPointer()) != nullptr) return true;
  if (dynamic_cast<itk::NrrdImageIO*>(io.GetPointer()) != nullptr) return !patient_space(path).empty();
  // MetaImage: the header names an orientation or "???"
  const std::string header = header_of(path);
  const std::size_t at = header.find("AnatomicalOrientation");
  return at != std::string::npos && header.substr(at, header.find('\n', at) - at).find('?') == std::string::npos;
}

std::string stem(const std::string& path) {
  std::filesystem::path name = std::filesystem::path(path).filename();
  return name.stem().string();
}

Io io_of(const std::string& path) {
  if (has_ending(path, ".nrrd") || has_ending(path, ".nhdr")) return itk::NrrdImageIO::New().GetPointer();
  if (has_ending(path, ".mha") || has_ending(path, ".mhd")) return itk::MetaImageIO::New().GetPointer();
  return itk::GDCMImageIO::New().GetPointer();
}

}  // namespace

Result<Opened> open_with_itk(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.shown + ": " + what)}; };
  try {
    const Io io = io_of(source.path);
    if (!io->CanReadFile(source.path.c_str())) return failed("cannot be read: it is not of the kind that its name says");
    io->SetFileName(source.path);
    io->ReadImageInformation();
    if (vtk_type(io->GetComponentType()) == 0) return failed("has voxels of an unknown type, expected integers or floats");
    const auto shape = shape_of(*io);
    if (!shape) return failed(shape.error().message);
    Opened opened;
    // a fourth axis is one of time only where the header says so, and these do not
    vtkSmartPointer<vtkDataArray> values = read_whole(*io, shape->voxels() * static_cast<std::size_t>(shape->volumes));
    if (shape->volumes > 1) {
      const int volume = std::min(source.step, shape->volumes - 1);
      const auto one = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
      one->SetNumberOfComponents(values->GetNumberOfComponents());
      const auto voxels = static_cast<vtkIdType>(shape->voxels());
      one->SetNumberOfTuples(voxels);
      one->InsertTuples(0, voxels, volume * voxels, values);
      values = one;
      opened.notes.push_back(fmt::format("volume {} of {}, counted from 0: \"step\" of the field chooses another", volume, shape->volumes));
    }
    opened.patient = is_patient(io, source.path);
    const Mapping mapping = mapping_of(*io);
    values = turned_vectors(io, source.path, values, opened.patient);
    opened.blocks.push_back({image_of(shape->size, values, stem(source.shown)), opened.patient ? world_of(source.path, mapping) : mapping});
    if (opened.patient) opened.unit_length = "mm";
    const itk::MetaDataDictionary& words = io->GetMetaDataDictionary();
    for (const char* key : {"NRRD_space units[0]", "NRRD_space units[1]"})
      if (const std::string unit = text_at(words, key); field::is_unit(unit)) opened.unit_length = unit;
    if (dynamic_cast<itk::GDCMImageIO*>(io.GetPointer()) != nullptr)
      if (const std::string beside = series_beside(source); !beside.empty()) opened.notes.push_back(beside);
    if (text_at(words, "0008|0060") == "CT") opened.units[stem(source.shown)] = "HU";
    return opened;
  } catch (const itk::ExceptionObject& e) {
    return failed(fmt::format("cannot be read ({})", words_of(e)));
  }
}

}  // namespace catena::vtk
