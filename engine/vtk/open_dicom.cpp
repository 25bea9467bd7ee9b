// A folder of DICOM images: its series, each of them a volume. Slices are ordered by their places along the normal. And whether a file
// belongs to such a series.
#include <fmt/format.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/vtk/itk_image.h"
#include "engine/vtk/open.h"

namespace catena::vtk {
namespace {

using field::Mapping;

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

std::string series_beside(const Source& source) {
  namespace fs = std::filesystem;
  const fs::path file(source.path);
  const auto series_of_file = [](const fs::path& path) -> std::string {
    try {
      const auto io = itk::GDCMImageIO::New();
      if (!io->CanReadFile(path.c_str())) return {};
      io->SetFileName(path.string());
      io->ReadImageInformation();
      return text_at(io->GetMetaDataDictionary(), "0020|000e");
    } catch (const itk::ExceptionObject&) {
      return {};
    }
  };
  const std::string series = series_of_file(file);
  if (series.empty()) return {};
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(file.parent_path(), code), end; !code && at != end; at.increment(code))
    if (std::error_code ignored; at->is_regular_file(ignored)) files.push_back(at->path());
  std::ranges::sort(files);
  // a series has names in a row: a few on either side tell
  constexpr std::ptrdiff_t kLooks = 4;
  const auto self = std::ranges::find(files, file) - files.begin();
  for (std::ptrdiff_t k = std::max(self - kLooks, std::ptrdiff_t{0}); k <= std::min(self + kLooks, std::ssize(files) - 1); ++k) {
    if (k == self || series_of_file(files[static_cast<std::size_t>(k)]) != series) continue;
    const fs::path shown = fs::path(source.shown).parent_path();
    const std::string folder = shown.empty() ? "." : shown.string();
    return "more images of its series lie beside it: the folder opens as a volume (catena render " + folder + ")";
  }
  return {};
}

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
    return Error{one_line(fmt::format("{}: cannot be read ({})", source.shown, words_of(e)))};
  }
}

}  // namespace catena::vtk
