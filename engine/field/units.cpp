#include "engine/field/units.h"

#include <nifti1_io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>

#include "engine/field/files.h"

namespace catena::field {
namespace {

Units nifti_units(const std::string& path) {
  nifti_set_debug_level(0);
  int swapped = 0;
  const std::unique_ptr<nifti_1_header, decltype(&std::free)> header(nifti_read_header(path.c_str(), &swapped, 0), &std::free);
  if (!header) return {};
  switch (XYZT_TO_SPACE(header->xyzt_units)) {
    case NIFTI_UNITS_METER:
      return {{}, "m"};
    case NIFTI_UNITS_MM:
      return {{}, "mm"};
    case NIFTI_UNITS_MICRON:
      return {{}, "µm"};
    default:
      return {};
  }
}

std::string word_of(const openvdb::MetaMap& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto text = map.getMetadata<openvdb::StringMetadata>(key); text && is_unit(text->value())) return text->value();
  return {};
}

Units vdb_units(const std::string& path, const std::string& grid) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/true);
  Units units;
  std::string name = grid;
  int fields = 0;
  for (auto it = file.beginName(); it != file.endName(); ++it) {
    if (*it == "valid") continue;
    if (name.empty()) name = *it;
    ++fields;
  }
  if (const auto map = file.getMetadata()) {
    if (const auto text = map->getMetadata<openvdb::StringMetadata>("units")) units = units_of_text(text->value(), fields == 1);
    if (const std::string length = word_of(*map, {"unit_length"}); !length.empty()) units.length = length;
  }
  if (file.hasGrid(name)) {
    const auto about = file.readGridMetadata(name);
    if (const std::string value = word_of(*about, {"unit", "units"}); !value.empty()) units.value = value;
    if (const std::string length = word_of(*about, {"unit_length"}); !length.empty()) units.length = length;
  }
  return units;
}

Units read_units(const std::string& path, const std::string& grid) {
  try {
    const std::string kind = extension_of(path);
    if (kind == ".nii" || kind == ".nii.gz") return nifti_units(path);
    if (kind == ".vdb") return vdb_units(path, grid);
  } catch (const std::exception&) {
    // loading the field says what is wrong with the file
  }
  return {};
}

}  // namespace

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
  Units units = read_units(path, grid);
  known[{path, grid}] = {at, units};
  return units;
}

}  // namespace catena::field
