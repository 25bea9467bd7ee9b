// SPDX-License-Identifier: MIT
/// Label tables: the numbers of a label map with their names and colors. The format is detected from the content:
///   FreeSurfer     `17 Left-Hippocampus 220 216 20 0`: number, name, red, green, blue and transparency from 0 to 255
///   ITK-SNAP       `17 220 216 20 1 1 1 "Left Hippocampus"`: number, red, green, blue (0 to 255), opacity, visible, in 3-D, name
///   names          `1 Precentral_L 2001`: number and name, optionally a number of another nomenclature; with a tab, a name may have spaces
///   table          a row of column names (index, id, label or value; name, label_name or region; r, g, b or red, green, blue), then rows,
///                  separated by commas, tabs or semicolons; colors are in 0..1 if none is greater than 1, else in 0..255
/// Lines that begin with # and empty lines are ignored; CRLF and a byte order mark are allowed. Of several rows for one number the first is
/// used. If a table without colors has a file of 768 bytes with the extension .lut beside it, that file holds the colors (256 each of red,
/// green and blue, 0 to 255; black: no color). Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena::scene {

/// Row of a label table.
struct LabelRow {
  double value = 0;              ///< Number of the label, an integer
  std::string name;              ///< Name of the label
  std::optional<Color> color{};  ///< Empty: the table has no color for it
  bool operator==(const LabelRow&) const = default;
};
/// Rows in order of rising values.
using LabelTable = std::vector<LabelRow>;

inline constexpr std::size_t kMaxLabelRows = 65536;  ///< Maximum number of rows; a table with more is an error
inline constexpr double kMaxLabelValue = 1 << 24;    ///< Maximum |value| of a label: floats represent integers exactly up to this value

/// Parses the text of a table; `file` is for messages. Error: "FILE:LINE: what; what was expected".
CATENA_EXPORT Result<LabelTable> parse_label_table(std::string_view text, const std::string& file);
/// Reads a table from a file.
CATENA_EXPORT Result<LabelTable> read_label_table(const std::string& path);

/// Returns the path of the label table beside a label map: the same name, with its extension replaced or followed by one of .txt, .ctbl,
/// .label, .csv, .tsv, .lut, if it can be read as a table. Empty: none.
CATENA_EXPORT std::string find_label_table(const std::string& path);

}  // namespace catena::scene
