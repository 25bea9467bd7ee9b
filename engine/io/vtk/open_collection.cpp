// SPDX-License-Identifier: MIT
// Opens collections: text files that name the files of a series with their times. ParaView's .pvd (XML; several parts may make up one step)
// and .series (JSON: .vtk.series, .vtu.series and so on). The parts of the requested step become blocks, as in a multi-block file.
#include <fmt/format.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "engine/base/json.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

namespace fs = std::filesystem;

/// One step: file names as in the collection, in their order.
struct Step {
  double time = 0;
  std::vector<std::string> files;
};
using Steps = std::vector<Step>;

constexpr std::uint64_t kMaxBytes = 64 << 20;
/// Maximum number of XML elements; parsing that many takes seconds.
constexpr std::ptrdiff_t kMaxElements = 200'000;

bool is_collection(const std::string& path) { return has_extension(path, ".pvd") || has_extension(path, ".series"); }

/// Adds the data sets of a collection by time. The error is a message fragment.
Outcome add_datasets(vtkXMLDataElement& collection, std::map<double, std::vector<std::string>>& steps) {
  for (int i = 0; i < collection.GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = collection.GetNestedElement(i);
    if (std::strcmp(element->GetName(), "DataSet") != 0) continue;
    const char *file = element->GetAttribute("file"), *time = element->GetAttribute("timestep");
    if (file == nullptr || *file == '\0') return Error{fmt::format("DataSet {} has no file", i + 1)};
    const auto number = time == nullptr ? std::optional(0.0) : parse_double(time);
    if (!number || !std::isfinite(*number))
      return Error{fmt::format("the timestep {} of the DataSet with file {} is invalid; a finite number was expected", in_quotes(time),
                               in_quotes(file))};
    steps[*number].emplace_back(file);
  }
  return Done{};
}

Result<Steps> read_pvd(const std::string& path) {
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  if (const std::string reader_errors = take_reader_errors(); root == nullptr || !reader_errors.empty())
    return Error{"the file is not valid XML, or is truncated" + (reader_errors.empty() ? "" : " (" + reader_errors + ")")};
  std::map<double, std::vector<std::string>> by_time;  // files of the same time are parts of one step
  for (int i = 0; i < root->GetNumberOfNestedElements(); ++i)
    if (std::strcmp(root->GetNestedElement(i)->GetName(), "Collection") == 0)
      CATENA_CHECK(add_datasets(*root->GetNestedElement(i), by_time));
  Steps steps;
  for (auto& [time, names] : by_time) steps.push_back({time, std::move(names)});
  return steps;
}

Result<Steps> read_series(const std::string& path, const std::string& text) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  const json::Node* files = root.find("files");
  if (files == nullptr || files->kind != json::Kind::array) return Error{"there is no list \"files\""};
  Steps steps;
  for (const json::Node& one : files->items) {
    CATENA_TRY(const std::string name, json::require_string(one, "name"));
    CATENA_TRY(const double time, json::require_number(one, "time"));
    steps.push_back({time, {name}});
  }
  std::ranges::stable_sort(steps, {}, &Step::time);
  return steps;
}

/// Returns the path of a named file for this process. The error is a message fragment.
Result<std::string> part_path(const Source& source, const std::string& name) {
  const fs::path folder = fs::path(source.path).parent_path();
  std::error_code code;
  const fs::path relative = fs::path(name).is_absolute() ? fs::path(name).lexically_relative(source.original_folder) : fs::path(name);
  const fs::path at = fs::weakly_canonical(folder / relative, code);
  const fs::path inside = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, code);
  if (std::mismatch(inside.begin(), inside.end(), at.begin(), at.end()).first != inside.end())
    return Error{in_quotes(name) + " is outside the folder of the collection; a file in this folder or below was expected"};
  if (!fs::exists(at, code)) return Error{in_quotes(name) + ", named in the collection, does not exist"};
  if (is_collection(name)) return Error{in_quotes(name) + " is a collection, too; a data file was expected"};
  return at.string();
}

void append(ImportedData part, ImportedData& all) {
  std::move(part.blocks.begin(), part.blocks.end(), std::back_inserter(all.blocks));
  all.units.merge(part.units);
  all.unit_length = part.unit_length;
  all.is_patient_space = all.is_patient_space || part.is_patient_space;
  for (std::string& note : part.notes)
    if (std::ranges::find(all.notes, note) == all.notes.end()) all.notes.push_back(std::move(note));
}

}  // namespace

Result<ImportedData> open_collection(const Source& source) {
  const auto failed = [&](const std::string& what) { return Error{one_line(source.display_name + ": " + what)}; };
  const auto text = read_text_file(source.path, "a collection of files", kMaxBytes);
  if (!text) return failed("cannot be read as a collection of files: the file is larger than 64 MiB, or cannot be opened");
  const bool pvd = has_extension(source.path, ".pvd");
  if (std::ranges::count(*text, pvd ? '<' : '{') > kMaxElements)
    return failed(fmt::format("has more than {} elements; a shorter collection was expected", kMaxElements));
  const auto steps = pvd ? read_pvd(source.path) : read_series(source.display_name, *text);
  if (!steps) return failed(steps.error().message);
  if (steps->empty()) return failed("the collection lists no files");
  ImportedData all;
  for (const Step& step : *steps) all.times.push_back(step.time);
  const Step& step = (*steps)[std::min(static_cast<std::size_t>(source.step), steps->size() - 1)];
  for (const std::string& name : step.files) {
    const auto path = part_path(source, name);
    if (!path) return failed(fmt::format("at time {:g} {}", step.time, path.error().message));
    Source part = source;
    part.display_name = fmt::format("{}: {}", source.display_name, name);
    part.path = *path;
    part.step = 0;
    CATENA_TRY(ImportedData opened, open_any(part));
    append(std::move(opened), all);
  }
  return all;
}

}  // namespace catena::vtk
