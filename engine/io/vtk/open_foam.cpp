// SPDX-License-Identifier: MIT
// Opens OpenFOAM cases.
#include <fmt/format.h>
#include <vtkAppendFilter.h>
#include <vtkDummyController.h>
#include <vtkExtractCells.h>
#include <vtkNew.h>
#include <vtkPOpenFOAMReader.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/vtk/foam_times.h"
#include "engine/io/vtk/open_vtk.h"

namespace catena::vtk {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code code;
  return fs::is_directory(path, code);
}

template <class Visit>
void each_folder_in(const fs::path& folder, const Visit& visit) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
    if (std::error_code ignored; at->is_directory(ignored)) visit(at->path());
}

/// Returns the name of the collated folder, such as "processors4"; empty: there is none.
std::string collated_in(const fs::path& folder) {
  std::string name;
  each_folder_in(folder, [&](const fs::path& one) {
    const std::string word = one.filename().string();
    if (word.starts_with("processors") && word.size() > 10 && word[10] >= '0' && word[10] <= '9') name = word;
  });
  return name;
}

/// Selects the volumes of all regions, and no patches.
void choose_volumes(vtkOpenFOAMReader& reader) {
  const auto is_volume = [](const std::string& name) { return name == "internalMesh" || name.ends_with("/internalMesh"); };
  for (int i = 0; i < reader.GetNumberOfPatchArrays(); ++i) {
    const char* name = reader.GetPatchArrayName(i);
    reader.SetPatchArrayStatus(name, is_volume(name) ? 1 : 0);
  }
}

/// Joins the pieces of a decomposed case, which the reader leaves separate, so that cells on both sides of a cut share its points.
/// vtkAppendFilter merges the points of two inputs or more, so that it gets the cells in two halves.
void join_pieces(ImportedData& opened) {
  for (Block& block : opened.blocks) {
    const vtkIdType cells = block.data->GetNumberOfCells();
    if (cells < 2) continue;
    vtkNew<vtkAppendFilter> join;
    join->MergePointsOn();
    for (const auto& [first, last] : {std::pair(vtkIdType{0}, cells / 2 - 1), std::pair(cells / 2, cells - 1)}) {
      vtkNew<vtkExtractCells> half;
      half->SetInputData(block.data);
      half->AddCellRange(first, last);
      half->Update();
      join->AddInputData(half->GetOutput());
    }
    join->Update();
    block.data = join->GetOutput();
  }
}

/// Returns the times without fields, such as a "0" whose fields were removed, which are not steps. Empty if no time has a field.
std::set<double> times_without_fields(const fs::path& folder) {
  std::set<double> times = list_foam_times(folder);
  const std::size_t all = times.size();
  std::erase_if(times, [&](double time) { return !list_foam_fields(folder, time).empty(); });
  return times.size() == all ? std::set<double>() : times;
}

/// Adds a note about fields that are in the last step but not in the first.
void add_later_fields(const fs::path& folder, ImportedData& opened) {
  const std::set<std::string> first = list_foam_fields(folder, opened.times.front());
  std::vector<std::string> later;
  for (const std::string& name : list_foam_fields(folder, opened.times.back()))
    if (!first.contains(name)) later.push_back(name);
  if (later.empty()) return;
  const std::vector<std::string_view> names(later.begin(), later.end());
  opened.notes.push_back(
      fmt::format("step {} (time {:g}) has more fields: {}", opened.times.size() - 1, opened.times.back(), join_words(names)));
}

}  // namespace

Result<ImportedData> open_foam(const Source& source) {
  const fs::path folder = is_folder(source.path) ? fs::path(source.path) : fs::path(source.path).parent_path();
  const auto failed = [&](const std::string& what) { return Error{one_line(source.display_name + ": " + what)}; };
  const bool has_mesh = field::has_openfoam_mesh(folder.string()), pieces = is_folder(folder / "processor0");
  std::error_code code;
  if (!has_mesh && !pieces) {
    if (const std::string collated_folder = collated_in(folder); !collated_folder.empty())
      return failed(fmt::format("is decomposed in the unsupported collated format ({}): reconstructPar converts it to a reconstructed case",
                                collated_folder));
    return failed("is an OpenFOAM case without a mesh; constant/polyMesh, constant/REGION/polyMesh or processor0 was expected");
  }
  if (!fs::exists(folder / "system/controlDict", code))
    return failed("is an OpenFOAM case without system/controlDict, which defines the names of the time folders");
  vtkNew<vtkDummyController> alone;
  const auto reader = vtkSmartPointer<vtkPOpenFOAMReader>::New();
  reader->SetController(alone);
  reader->SetCaseType(has_mesh ? vtkPOpenFOAMReader::RECONSTRUCTED_CASE : vtkPOpenFOAMReader::DECOMPOSED_CASE);
  reader->SetFileName((folder / "case.foam").c_str());
  reader->CreateCellToPointOff();  // the reader's own averages would replace the cell values
  reader->DecomposePolyhedraOn();
  reader->UpdateInformation();
  choose_volumes(*reader);
  reader->EnableAllCellArrays();
  const fs::path time_folder = has_mesh ? folder : folder / "processor0";
  CATENA_TRY(ImportedData opened, read_with_reader(*reader, source, times_without_fields(time_folder)));
  if (!has_mesh) join_pieces(opened);
  if (opened.times.size() > 1 && source.step == 0) add_later_fields(time_folder, opened);
  if (has_mesh && pieces) {
    const std::set<double> times = list_foam_times(folder), piece_times = list_foam_times(folder / "processor0");
    if (!std::includes(times.begin(), times.end(), piece_times.begin(), piece_times.end()))
      opened.notes.push_back("the reconstructed case is read; processor* has more times, which reconstructPar adds");
  }
  return opened;
}

}  // namespace catena::vtk
