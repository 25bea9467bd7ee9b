#include "engine/field/units.h"

#include <nifti1_io.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>

#include "engine/field/formats.h"
#include "engine/field/reader.h"

namespace catena::field {

Units nifti_units(const std::string& path, const std::string&) {
  nifti_set_debug_level(0);
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(nifti_read_header(path.c_str(), &swapped, 0), &std::free);
  if (!header) return {};
  Units units;
  const int code = XYZT_TO_SPACE(header->xyzt_units);
  units.length = code == NIFTI_UNITS_METER ? "m" : code == NIFTI_UNITS_MM ? "mm" : code == NIFTI_UNITS_MICRON ? "µm" : "";
  units.patient = header->sform_code > 0 || header->qform_code > 0;
  units.labels = header->intent_code == NIFTI_INTENT_LABEL;
  return units;
}

Units vdb_units(const std::string& path, const std::string& grid) {
  const std::optional<ReadReply> file = words_of(path);
  if (!file) return {};
  Units units;
  std::vector<const GridWords*> fields;
  for (const GridWords& words : file->words)
    if (words.name != "valid") fields.push_back(&words);
  // without a name: the first in the order of names
  const auto by_name = [](const GridWords* a, const GridWords* b) { return a->name < b->name; };
  const std::string name = grid.empty() && !fields.empty() ? (*std::ranges::min_element(fields, by_name))->name : grid;
  units = units_of_text(file->units, fields.size() == 1);
  if (is_unit(file->unit_length)) units.length = file->unit_length;
  for (const GridWords& words : file->words) {
    if (words.name != name) continue;
    if (is_unit(words.unit)) units.value = words.unit;
    if (is_unit(words.unit_length)) units.length = words.unit_length;
    units.level_set = words.level_set;
  }
  units.patient = units.value == "HU" || units.length == "mm";
  return units;
}

bool is_unit(const std::string& word) {
  if (word.empty() || word.size() > 24 || word == "none" || word == "unknown" || word == "0") return false;
  return std::ranges::all_of(word, [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
}

Units units_of_text(const std::string& text, bool one_field) {
  Units units;
  std::string other;
  int others = 0;
  std::stringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    constexpr std::string_view kLengths[] = {"m", "cm", "mm", "µm", "um", "nm", "km", "Å"};
    if (std::ranges::find(kLengths, part) != std::end(kLengths)) {
      units.length = part;
    } else {
      other = part;
      ++others;
    }
  }
  if (one_field && others == 1 && is_unit(other) && other.find_first_of(" ();=") == std::string::npos) units.value = other;
  return units;
}

Units units_of(const std::string& path, const std::string& grid) {
  struct Known {
    std::filesystem::file_time_type at;
    Units units;
  };
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, Known> known;
  std::error_code code;
  const auto at = std::filesystem::last_write_time(path, code);
  if (code) return {};
  const std::scoped_lock lock(mutex);
  const auto found = known.find({path, grid});
  if (found != known.end() && found->second.at == at) return found->second.units;
  constexpr std::size_t kMost = 256;
  if (known.size() >= kMost) known.clear();
  const FileFormat* format = format_of(path);
  Units units = format != nullptr && format->units != nullptr ? format->units(path, grid) : Units{};
  known[{path, grid}] = {at, units};
  return units;
}

}  // namespace catena::field
