// Medical images as ITK reads them: NRRD, MetaImage, DICOM. ITK's world is a patient's with +x to the left and +y to the back; Catena's,
// as NIfTI's, has +x to the right and +y to the front: both are turned round, unless the file says that its space is no patient's.
#include <fmt/format.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <filesystem>
#include <fstream>

#include "engine/base/text.h"
#include "engine/field/units.h"
#include "engine/vtk/open.h"

namespace catena::vtk {
namespace {

using field::Mapping;
using Io = itk::SmartPointer<itk::ImageIOBase>;

std::string text_at(const itk::MetaDataDictionary& words, const std::string& key) {
  std::string text;
  itk::ExposeMetaData<std::string>(words, key, text);
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  return end == std::string::npos ? std::string() : text.substr(0, end + 1);
}

int vtk_type(itk::IOComponentEnum type) {
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

/// Columns: the steps of the image's first three axes; an image of fewer has steps of 1 across.
Mapping mapping_of(const itk::ImageIOBase& io) {
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

Mapping turned_round(const Mapping& m) {
  Mat3 linear = m.world_from_index_linear;
  Vec3 origin = m.origin;
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 2; ++c) linear[a][c] = -linear[a][c];
  for (int c = 0; c < 2; ++c) origin[c] = -origin[c];
  return Mapping::from_linear(linear, origin);
}

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

/// An image of these voxels, x fastest; the axes go beside it. The mapping is the block's.
vtkSmartPointer<vtkImageData> image_of(const int (&size)[3], const vtkSmartPointer<vtkDataArray>& values, const std::string& name) {
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0], size[1], size[2]);
  values->SetName(name.c_str());
  image->GetPointData()->SetScalars(values);
  return image;
}

std::string stem(const std::string& path) {
  std::filesystem::path name = std::filesystem::path(path).filename();
  return name.stem().string();
}

/// One more step in time is one more volume behind the first: a fourth axis of an image.
struct Shape {
  int size[3] = {1, 1, 1};
  int volumes = 1;
  std::size_t voxels() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
};

Result<Shape> shape_of(const itk::ImageIOBase& io) {
  Shape shape;
  double all = 1;
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) {
    const auto n = io.GetDimensions(a);
    all *= static_cast<double>(n);
    if (n < 1 || n > 1'000'000 || all > 1e12) return Error{fmt::format("the size along axis {} is {}, expected 1 to 1000000", a, n)};
    if (a < 3)
      shape.size[a] = static_cast<int>(n);
    else
      shape.volumes *= static_cast<int>(n);
  }
  return shape;
}

Io io_of(const std::string& path) {
  if (has_ending(path, ".nrrd") || has_ending(path, ".nhdr")) return itk::NrrdImageIO::New().GetPointer();
  if (has_ending(path, ".mha") || has_ending(path, ".mhd")) return itk::MetaImageIO::New().GetPointer();
  return itk::GDCMImageIO::New().GetPointer();
}

vtkSmartPointer<vtkDataArray> read_whole(itk::ImageIOBase& io, std::size_t all_voxels) {
  const auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type(io.GetComponentType())));
  values->SetNumberOfComponents(static_cast<int>(io.GetNumberOfComponents()));
  values->SetNumberOfTuples(static_cast<vtkIdType>(all_voxels));
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) region.SetSize(a, io.GetDimensions(a));
  io.SetIORegion(region);
  io.Read(values->GetVoidPointer(0));
  return values;
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
    if (text_at(words, "0008|0060") == "CT") opened.units[stem(source.shown)] = "HU";
    return opened;
  } catch (const itk::ExceptionObject& e) {
    return failed(fmt::format("cannot be read ({})", e.GetDescription()));
  }
}

namespace {

/// The slices of one series, in the order of their places along the normal.
struct Series {
  std::string uid, name, unit;
  std::vector<std::string> files;
};

std::vector<Series> series_of(const std::string& folder) {
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetRecursive(true);
  names->SetGlobalWarningDisplay(false);
  names->SetDirectory(folder);
  std::vector<Series> all;
  for (const std::string& uid : names->GetSeriesUIDs()) {
    Series series;
    series.uid = uid;
    series.files = names->GetFileNames(uid);
    if (series.files.empty()) continue;
    const auto io = itk::GDCMImageIO::New();
    io->SetFileName(series.files.front());
    io->ReadImageInformation();
    const itk::MetaDataDictionary& words = io->GetMetaDataDictionary();
    const std::string described = text_at(words, "0008|103e");
    series.name = free_name(described.empty() ? "series" : described, [&](const std::string& name) {
      return std::any_of(all.begin(), all.end(), [&](const Series& other) { return other.name == name; });
    });
    if (text_at(words, "0008|0060") == "CT") series.unit = "HU";
    all.push_back(std::move(series));
  }
  return all;
}

struct Slice {
  Mapping mapping;
  vtkSmartPointer<vtkDataArray> values;
  int size[3];
};

/// Slices at these places along the normal, brought to equal distances by linear interpolation between neighbours.
void even_out(std::vector<float>& values, std::size_t slice_voxels, const std::vector<double>& at, std::size_t count, double step) {
  std::vector<float> even(slice_voxels * count);
  std::size_t k = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double place = std::min(at.front() + step * static_cast<double>(n), at.back());
    while (k + 2 < at.size() && at[k + 1] < place) ++k;
    const double t = std::clamp((place - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0);
    for (std::size_t i = 0; i < slice_voxels; ++i)
      even[n * slice_voxels + i] = static_cast<float>((1 - t) * static_cast<double>(values[k * slice_voxels + i]) +
                                                      t * static_cast<double>(values[(k + 1) * slice_voxels + i]));
  }
  values = std::move(even);
}

Result<Opened> open_series(const Series& series, const std::string& shown) {
  std::vector<float> values;
  std::vector<double> at;
  Mapping first, last;
  int size[3] = {0, 0, 0};
  Vec3 normal(0.0);
  for (const std::string& file : series.files) {
    const auto io = itk::GDCMImageIO::New();
    io->SetFileName(file);
    io->ReadImageInformation();
    const auto shape = shape_of(*io);
    const std::string name = std::filesystem::path(file).filename().string();
    if (!shape) return Error{fmt::format("{}: {}: {}", shown, name, shape.error().message)};
    if (shape->size[2] > 1)
      return Error{fmt::format("{}: {} holds {} frames, expected a file of its own for it", shown, name, shape->size[2])};
    if (io->GetNumberOfComponents() != 1) return Error{fmt::format("{}: {} is a picture in colours, expected grey values", shown, name)};
    const Mapping mapping = mapping_of(*io);
    if (at.empty()) {
      std::copy_n(shape->size, 3, size);
      first = mapping;
      normal = direction(cross(mapping.world_from_index_linear[0], mapping.world_from_index_linear[1]));
    } else if (shape->size[0] != size[0] || shape->size[1] != size[1]) {
      return Error{fmt::format("{}: {} has {} x {} pixels, expected {} x {} as the other slices", shown, name, shape->size[0],
                               shape->size[1], size[0], size[1])};
    }
    const double place = dot(mapping.origin, normal);
    if (!at.empty() && std::fabs(place - at.back()) < 1e-6) continue;  // the same place again: another time or echo
    at.push_back(place);
    last = mapping;
    const auto slice = read_whole(*io, shape->voxels());
    for (vtkIdType i = 0; i < slice->GetNumberOfTuples(); ++i) values.push_back(static_cast<float>(slice->GetComponent(i, 0)));
  }
  // along the normal
  Opened opened;
  const std::size_t slice_voxels = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  if (at.size() != series.files.size())
    opened.notes.push_back(
        fmt::format("of {} slices {} lie at places of their own; the first at each is shown", series.files.size(), at.size()));
  std::size_t count = at.size();
  Vec3 step = first.world_from_index_linear[2];
  if (count > 1) {
    double least = 1e300, most = 0;
    for (std::size_t k = 1; k < count; ++k)
      least = std::min(least, std::fabs(at[k] - at[k - 1])), most = std::max(most, std::fabs(at[k] - at[k - 1]));
    step = (last.origin - first.origin) / static_cast<double>(count - 1);
    constexpr double kEven = 0.01;
    if (most - least > kEven * least) {
      const double span = at.back() - at.front();
      constexpr double kMostSlices = 4096;
      const auto finer = static_cast<std::size_t>(std::min(kMostSlices, std::ceil(std::fabs(span) / least))) + 1;
      even_out(values, slice_voxels, at, finer, span / static_cast<double>(finer - 1));
      step = (last.origin - first.origin) / static_cast<double>(finer - 1);
      opened.notes.push_back(fmt::format("slices lie {:.4g} to {:.4g} mm apart: {} were brought to {} at equal distances, linearly", least,
                                         most, count, finer));
      count = finer;
    }
  }
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_FLOAT));
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), static_cast<float*>(array->GetVoidPointer(0)));
  const int all[3] = {size[0], size[1], static_cast<int>(count)};
  Mat3 linear = first.world_from_index_linear;
  linear[2] = step;
  opened.blocks.push_back({image_of(all, array, series.name), turned_round(Mapping::from_linear(linear, first.origin))});
  opened.patient = true;
  opened.unit_length = "mm";
  if (!series.unit.empty()) opened.units[series.name] = series.unit;
  return opened;
}

}  // namespace

Result<Opened> open_dicom_folder(const Source& source) {
  try {
    const std::vector<Series> all = series_of(source.path);
    if (all.empty()) return Error{source.shown + ": the folder holds no DICOM images"};
    Opened opened;
    for (const Series& series : all) {
      if (!source.grid.empty() && series.name != source.grid) continue;
      CATENA_TRY(Opened one, open_series(series, source.shown));
      opened.blocks.push_back(std::move(one.blocks.front()));
      opened.units.merge(one.units);
      for (const std::string& note : one.notes) opened.notes.push_back(all.size() > 1 ? series.name + ": " + note : note);
    }
    if (opened.blocks.empty()) {
      std::vector<std::string_view> names;
      for (const Series& series : all) names.push_back(series.name);
      return Error{one_line(fmt::format("{}: there is no grid \"{}\", the folder has: {}", source.shown, source.grid, joined(names)))};
    }
    opened.patient = true;
    opened.unit_length = "mm";
    return opened;
  } catch (const itk::ExceptionObject& e) {
    return Error{one_line(fmt::format("{}: cannot be read ({})", source.shown, e.GetDescription()))};
  }
}

}  // namespace catena::vtk
