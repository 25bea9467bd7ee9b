// SPDX-License-Identifier: MIT
// Opens VTK's own formats, and the simulation formats that VTK reads.
#include <fmt/format.h>
#include <vtkAlgorithm.h>
#include <vtkCGNSReader.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLGenericDataObjectReader.h>

#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/vtk/netcdf_size.h"
#include "engine/io/vtk/open.h"
#include "engine/io/vtk/open_netcdf.h"
#include "engine/io/vtk/open_vtk.h"
#include "engine/io/vtk/truncation_check.h"

namespace catena::vtk {
namespace {

void keep_units(vtkDataSetAttributes* arrays, ImportedData& opened) {
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = arrays->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || !array->HasInformation()) continue;
    if (const char* unit = array->GetInformation()->Get(vtkDataArray::UNITS_LABEL())) opened.units[array->GetName()] = unit;
  }
}

/// Returns the time that a file of one step states: ParaView's TimeValue, VisIt's TIME; nullopt if it states none.
std::optional<double> time_of_file(vtkDataObject* object) {
  if (object == nullptr) return std::nullopt;
  for (const char* name : {"TimeValue", "TIME"}) {
    vtkDataArray* array = object->GetFieldData()->GetArray(name);
    if (array != nullptr && array->GetNumberOfValues() == 1 && std::isfinite(array->GetComponent(0, 0))) return array->GetComponent(0, 0);
  }
  return std::nullopt;
}

/// Returns an Error if a block index is too large: VTK allocates every block below the largest index.
Outcome check_indices(const Source& source) {
  constexpr std::uint64_t kMaxBytes = 16 << 20;
  constexpr long long kMaxBlocks = 1'000'000;
  const auto text = read_text_file(source.path, "a collection of blocks", kMaxBytes);
  if (!text) return Done{};  // VTK reports the problem
  for (std::size_t at = text->find("index"); at != std::string::npos; at = text->find("index", at + 1)) {
    const std::size_t open = text->find_first_of("\"'", at),
                      close = open == std::string::npos ? open : text->find_first_of("\"'", open + 1);
    if (close == std::string::npos || trim(std::string_view(*text).substr(at + 5, open - at - 5)) != "=") continue;
    const std::string word = text->substr(open + 1, close - open - 1);
    const auto index = parse_integer(trim(word));
    if (!index || *index < 0 || *index >= kMaxBlocks)
      return Error{fmt::format("{}: a block has the index {}, expected 0 to {}", source.display_name,
                               sanitize_for_terminal(word.substr(0, 40)), kMaxBlocks - 1)};
  }
  return Done{};
}

void add_block(vtkDataObject* object, ImportedData& opened) {
  vtkDataSet* data = vtkDataSet::SafeDownCast(object);
  if (data == nullptr || data->GetNumberOfPoints() == 0) return;
  keep_units(data->GetPointData(), opened);
  keep_units(data->GetCellData(), opened);
  opened.blocks.push_back({data, {}});
}

}  // namespace

Result<ImportedData> open_vtk_xml(const Source& source) {
  const vtkNew<vtkXMLGenericDataObjectReader> reader;
  reader->SetFileName(source.path.c_str());
  return read_with_reader(*reader, source);
}

Result<ImportedData> open_vtk_blocks(const Source& source) {
  CATENA_CHECK(check_indices(source));
  return open_vtk_xml(source);
}

Result<ImportedData> open_vtk_legacy(const Source& source) {
  const vtkNew<vtkGenericDataObjectReader> reader;
  reader->SetFileName(source.path.c_str());
  reader->ReadAllScalarsOn();  // by default VTK reads only the first of several SCALARS
  reader->ReadAllVectorsOn();
  return read_with_reader(*reader, source);
}

Result<ImportedData> open_ensight(const Source& source) {
  const vtkNew<vtkGenericEnSightReader> reader;
  reader->SetCaseFileName(source.path.c_str());
  reader->ReadAllVariablesOn();
  return read_with_reader(*reader, source);
}

Result<ImportedData> open_cgns(const Source& source) {
  const vtkNew<vtkCGNSReader> reader;
  reader->SetFileName(source.path.c_str());
  reader->UpdateInformation();
  reader->EnableAllBases();
  reader->EnableAllPointArrays();
  reader->EnableAllCellArrays();
  return read_with_reader(*reader, source);
}

Result<ImportedData> open_netcdf(const Source& source) {
  if (const Outcome complete = check_netcdf_size(source.path); !complete)
    return Error{one_line(source.display_name + ": " + complete.error().message)};
  return read_with_reader(*make_netcdf_reader(source), source);
}

Result<ImportedData> read_with_reader(vtkAlgorithm& algorithm, const Source& source, const std::set<double>& no_steps) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.display_name + ": " + what)}; };
  ImportedData opened;
  vtkAlgorithm* const reader = &algorithm;
  // the steps
  reader->UpdateInformation();
  vtkInformation* about = reader->GetOutputInformation(0);
  if (about != nullptr && about->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) {
    const double* times = about->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
    opened.times.assign(times, times + about->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()));
  }
  std::erase_if(opened.times, [&](double time) { return !std::isfinite(time) || no_steps.contains(time); });
  if (has_extension(source.path, ".vtk")) opened.times.clear();  // the legacy reader reports 0 for every file
  choose_netcdf_variables(reader, source, opened);
  // the data
  bool again = false;
  const auto complete = read_checking_truncation(
      [&] {
        if (std::exchange(again, true)) reader->Modified();
        if (opened.times.empty())
          reader->Update();
        else
          reader->UpdateTimeStep(opened.times[std::min(static_cast<std::size_t>(source.step), opened.times.size() - 1)]);
      },
      [&] { return reader->GetOutputDataObject(0); });
  vtkDataObject* object = reader->GetOutputDataObject(0);
  if (const std::string reader_errors = take_reader_errors(); !reader_errors.empty())
    return failed("cannot be read (" + reader_errors + ")");
  if (!complete) return failed(complete.error().message);
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(object)) {
    const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem()) add_block(each->GetCurrentDataObject(), opened);
  } else if (object != nullptr && vtkDataSet::SafeDownCast(object) == nullptr) {
    return failed(fmt::format("contains a {}, expected grids, meshes, lines or points", object->GetClassName()));
  } else {
    add_block(object, opened);
  }
  if (opened.times.empty()) {
    auto time = time_of_file(object);
    for (std::size_t b = 0; !time && b < opened.blocks.size(); ++b) time = time_of_file(opened.blocks[b].data);
    if (time) opened.times.push_back(*time);
  }
  if (const auto finished = finish_netcdf(reader, opened); !finished) return failed(finished.error().message);
  if (opened.blocks.empty()) return failed("is empty, or the contents do not match the file extension");
  return opened;
}

}  // namespace catena::vtk
