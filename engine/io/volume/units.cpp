// SPDX-License-Identifier: MIT
#include "engine/io/volume/units.h"

#include <nifti1_io.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>

#include "engine/io/client.h"
#include "engine/io/formats.h"

namespace catena::field {

Units read_nifti_units(const std::string& path, const std::string&) {
  nifti_set_debug_level(0);
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(nifti_read_header(path.c_str(), &swapped, 0), &std::free);
  if (!header) return {};
  Units units;
  const int code = XYZT_TO_SPACE(header->xyzt_units);
  units.length = code == NIFTI_UNITS_METER ? "m" : code == NIFTI_UNITS_MM ? "mm" : code == NIFTI_UNITS_MICRON ? "µm" : "";
  units.is_patient_space = header->sform_code > 0 || header->qform_code > 0;
  units.is_label_map = header->intent_code == NIFTI_INTENT_LABEL;
  return units;
}

Units read_vdb_units(const std::string& path, const std::string& grid) {
  const std::optional<ReadResponse> file = read_file_metadata(path);
  if (!file) return {};
  Units units;
  std::vector<const GridMetadata*> fields;
  for (const GridMetadata& words : file->grid_metadata)
    if (words.name != "valid") fields.push_back(&words);
  // an empty name means the first grid in alphabetical order
  const auto by_name = [](const GridMetadata* a, const GridMetadata* b) { return a->name < b->name; };
  const std::string name = grid.empty() && !fields.empty() ? (*std::ranges::min_element(fields, by_name))->name : grid;
  units = parse_units(file->units, fields.size() == 1);
  if (is_unit_name(file->unit_length)) units.length = file->unit_length;
  for (const GridMetadata& words : file->grid_metadata) {
    if (words.name != name) continue;
    if (is_unit_name(words.unit)) units.value = words.unit;
    if (is_unit_name(words.unit_length)) units.length = words.unit_length;
    units.is_level_set = words.is_level_set;
  }
  units.is_patient_space = units.value == "HU" || units.length == "mm";
  return units;
}

bool is_unit_name(const std::string& word) {
  if (word.empty() || word.size() > 24 || word == "none" || word == "unknown" || word == "0") return false;
  return std::ranges::all_of(word, [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; });
}

Units parse_units(const std::string& text, bool one_field) {
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
  if (one_field && others == 1 && is_unit_name(other) && other.find_first_of(" ();=") == std::string::npos) units.value = other;
  return units;
}

Units read_units(const std::string& path, const std::string& grid) {
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
  constexpr std::size_t kMaxCachedFiles = 256;
  if (known.size() >= kMaxCachedFiles) known.clear();
  const io::Format* format = io::find_reader(path, io::DataKind::volume);
  Units units = format != nullptr && format->volume.units != nullptr ? format->volume.units(path, grid) : Units{};
  known[{path, grid}] = {at, units};
  return units;
}

}  // namespace catena::field
