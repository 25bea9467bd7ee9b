/// What a file says of its numbers: the unit of a grid's values and of the world's lengths, as short words ("m/s", "mm"), and what they
/// stand for. Any thread.
///   NIfTI: xyz_units of the header (m, mm, µm); values: none, the format has no place for them
///   VDB: text metadata "unit" or "units" of the grid; "length_unit" of the grid or the file. "units" of the file is free text ("HU, mm"):
///   a part between commas that is a length is taken for lengths, a single word for the values of a file's only field
///   patient     NIfTI with a qform or an sform: +x is to the right of a patient, an animal or a template, +y to the front, +z to the head;
///               VDB in HU or mm is taken for the same
///   labels      NIfTI with the intent NIFTI_INTENT_LABEL (1002): whole numbers that are names
///   level set   VDB: the grid's class is "level set", values are distances from a surface at 0
#pragma once
#include <string>

namespace catena::field {

struct Units {
  std::string value{}, length{};  ///< empty: the file does not say
  bool is_patient_space = false, is_level_set = false, is_label_map = false;
};

/// A word that a unit can be: one line of at most 24 bytes without control characters; "none", "unknown" and the like are no unit.
bool is_unit_name(const std::string& word);

/// What the free text of a file means.
Units parse_units(const std::string& text, bool one_field);

/// Reads the header only, once for each state of the file. A file that cannot be read says nothing.
Units read_units(const std::string& path, const std::string& grid);

}  // namespace catena::field
