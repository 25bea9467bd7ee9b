// VTK's own formats, and those of simulation programs that it reads.
#include <fmt/format.h>
#include <vtkAlgorithm.h>
#include <vtkCGNSReader.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNetCDFCFReader.h>
#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkXMLGenericDataObjectReader.h>

#include "engine/base/text.h"
#include "engine/vtk/open.h"

namespace catena::vtk {
namespace {

using Reader = vtkSmartPointer<vtkAlgorithm>;

template <class R>
Reader named(const Source& source) {
  const auto reader = vtkSmartPointer<R>::New();
  reader->SetFileName(source.path.c_str());
  return reader;
}

Reader open_foam(const Source& source) {
  const auto reader = vtkSmartPointer<vtkOpenFOAMReader>::New();
  reader->SetFileName(source.path.c_str());
  reader->CreateCellToPointOff();  // its own averages would stand for the cells' values
  reader->DecomposePolyhedraOn();
  reader->UpdateInformation();
  reader->EnableAllCellArrays();
  return reader;
}

Reader open_ensight(const Source& source) {
  const auto reader = vtkSmartPointer<vtkGenericEnSightReader>::New();
  reader->SetCaseFileName(source.path.c_str());
  reader->ReadAllVariablesOn();
  return reader;
}

Reader open_cgns(const Source& source) {
  const auto reader = vtkSmartPointer<vtkCGNSReader>::New();
  reader->SetFileName(source.path.c_str());
  reader->UpdateInformation();
  reader->EnableAllBases();
  reader->EnableAllPointArrays();
  reader->EnableAllCellArrays();
  return reader;
}

Reader open_netcdf(const Source& source) {
  const auto reader = vtkSmartPointer<vtkNetCDFCFReader>::New();
  reader->SetFileName(source.path.c_str());
  reader->SphericalCoordinatesOff();  // degrees stay degrees: a map, not a globe
  reader->ReplaceFillValueWithNanOn();
  return reader;
}

struct Format {
  std::string_view ending;
  Reader (*open)(const Source& source);
};
constexpr Format kFormats[] = {
    {".vtk", named<vtkGenericDataObjectReader>},
    {".ply", named<vtkPLYReader>},
    {".foam", open_foam},
    {".case", open_ensight},
    {".encas", open_ensight},
    {".cgns", open_cgns},
    {".nc", open_netcdf},
    {".cdf", open_netcdf},
};

Reader reader_of(const Source& source) {
  for (const Format& format : kFormats)
    if (has_ending(source.path, format.ending)) return format.open(source);
  return named<vtkXMLGenericDataObjectReader>(source);
}

void keep_units(vtkDataSetAttributes* arrays, Opened& opened) {
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = arrays->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || !array->HasInformation()) continue;
    if (const char* unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL())) opened.units[array->GetName()] = unit;
  }
}

void add_block(vtkDataObject* object, Opened& opened) {
  vtkDataSet* data = vtkDataSet::SafeDownCast(object);
  if (data == nullptr || data->GetNumberOfPoints() == 0) return;
  keep_units(data->GetPointData(), opened);
  keep_units(data->GetCellData(), opened);
  opened.blocks.push_back({data, {}});
}

/// The units that a NetCDF file states of its variables.
void add_netcdf_units(vtkAlgorithm* reader, Opened& opened) {
  auto* netcdf = vtkNetCDFCFReader::SafeDownCast(reader);
  if (netcdf == nullptr) return;
  for (int i = 0; i < netcdf->GetNumberOfVariableArrays(); ++i) {
    const char* name = netcdf->GetVariableArrayName(i);
    if (name != nullptr) opened.units[name] = netcdf->QueryArrayUnits(name);
  }
}

/// NetCDF: variables over other dimensions than the first one's would be left out; those with most dimensions are chosen.
void choose_dimensions(vtkAlgorithm* algorithm, Opened& opened) {
  auto* reader = vtkNetCDFCFReader::SafeDownCast(algorithm);
  if (reader == nullptr) return;
  vtkStringArray* all = reader->GetAllDimensions();
  std::string best;
  std::ptrdiff_t most = 0;
  for (vtkIdType i = 0; all != nullptr && i < all->GetNumberOfValues(); ++i) {
    const std::string words = all->GetValue(i);
    const std::ptrdiff_t commas = std::count(words.begin(), words.end(), ',');
    if (best.empty() || commas > most) best = words, most = commas;
  }
  if (all != nullptr && all->GetNumberOfValues() > 1) {
    reader->SetDimensions(best.c_str());
    opened.notes.push_back(fmt::format("of several sets of dimensions those with most are shown: {}", best));
  }
}

}  // namespace

Result<Opened> open_with_vtk(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.shown + ": " + what)}; };
  Opened opened;
  const Reader reader = reader_of(source);
  // the steps
  reader->UpdateInformation();
  vtkInformation* about = reader->GetOutputInformation(0);
  if (about != nullptr && about->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) {
    const double* times = about->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
    opened.times.assign(times, times + about->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));
  }
  choose_dimensions(reader, opened);
  // the data
  if (opened.times.empty())
    reader->Update();
  else
    reader->UpdateTimeStep(opened.times[std::min(static_cast<std::size_t>(source.step), opened.times.size() - 1)]);
  vtkDataObject* object = reader->GetOutputDataObject(0);
  if (const std::string complaint = take_complaint(); !complaint.empty()) return failed("cannot be read (" + complaint + ")");
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(object)) {
    const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) add_block(each->GetCurrentDataObject(), opened);
  } else if (object != nullptr && vtkDataSet::SafeDownCast(object) == nullptr) {
    return failed(fmt::format("holds a {}, expected grids, meshes, lines or points", object->GetClassName()));
  } else {
    add_block(object, opened);
  }
  add_netcdf_units(reader, opened);
  if (opened.blocks.empty()) return failed("holds nothing, or is not of the kind that its name says");
  return opened;
}

}  // namespace catena::vtk
