// SPDX-License-Identifier: MIT
/// Meaning of the numbers in a file: the unit of a grid's values and of world lengths, as short names ("m/s", "mm"), and the kind of data.
/// Any thread.
///   NIfTI: xyz_units of the header (m, mm, µm); values: none, the format cannot store their unit
///   VDB: text metadata "unit" or "units" of the grid; "length_unit" of the grid or the file. "units" of the file is free text ("HU, mm"):
///   a comma-separated part that is a length unit applies to lengths, a single other word to the values of a file's only field
///   patient     NIfTI with a qform or an sform: +x is to the right of a patient, an animal or a template, +y to the front, +z to the head;
///               VDB in HU or mm is assumed to be the same
///   labels      NIfTI with the intent NIFTI_INTENT_LABEL (1002): integers that stand for labels
///   level set   VDB: the class of the grid is "level set", values are distances from a surface at 0
#pragma once
#include <string>

namespace catena::field {

/// Units and kind of a grid.
struct Units {
  std::string value{}, length{};  ///< Units of values and of lengths; empty: not specified by the file.
  bool is_patient_space = false, is_level_set = false, is_label_map = false;
};

/// Returns whether a text can be a unit: at most 24 bytes without control characters; "none", "unknown" and the like are not units.
bool is_unit_name(const std::string& word);

/// Parses the free text of a file. `one_field`: the file has only one field, to which a unit of values applies.
Units parse_units(const std::string& text, bool one_field);

/// Reads the units from the header only; cached while the file is unchanged. Empty when the file cannot be read.
Units read_units(const std::string& path, const std::string& grid);

}  // namespace catena::field
