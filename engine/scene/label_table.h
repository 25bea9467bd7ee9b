/// Tables of labels: the numbers of a label map with their names and colours, as the field writes them. Told apart by what stands in them:
///   FreeSurfer     `17 Left-Hippocampus 220 216 20 0`: number, name, red, green, blue and transparency from 0 to 255
///   ITK-SNAP       `17 220 216 20 1 1 1 "Left Hippocampus"`: number, red, green, blue (0 to 255), opacity, visible, in 3-D, name
///   names          `1 Precentral_L 2001`: number and name, perhaps a number of another nomenclature; a tab lets a name have blanks
///   table          a row of column names (index, id, label or value; name or surface_label_name; r, g, b or red, green, blue), then
///                  rows, separated by commas, tabs or semicolons; colours from 0 to 1 where none is greater, else to 255
/// Lines that begin with # and empty ones say nothing; CRLF and a byte order mark are fine. Of two rows for one number the first counts.
/// Where a file of 768 bytes with the ending .lut stands beside a table without colours, it holds them (red, green, blue of 0 to 255; black
/// is none). Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/result.h"

namespace catena::scene {

/// One row of a table.
struct LabelRow {
  double value = 0;              ///< a whole number
  std::string name;              ///< empty: none
  std::optional<Color> color{};  ///< none: the table has no colours
  bool operator==(const LabelRow&) const = default;
};
/// Values rising.
using LabelTable = std::vector<LabelRow>;

inline constexpr std::size_t kMaxLabelRows = 65536;  ///< More are refused.
inline constexpr double kMaxLabelValue = 1 << 24;    ///< in size: floats hold no greater ones apart

/// Errors: "FILE:LINE: what; what was expected".
Result<LabelTable> parse_label_table(std::string_view text, const std::string& file);
/// Reads the file of a table.
Result<LabelTable> read_label_table(const std::string& path);

/// The table that stands beside a label map: of the same name, its ending replaced by, or followed by, one of .txt, .ctbl, .label, .csv,
/// .tsv, .lut, that can be read as one. Empty: none.
std::string find_label_table(const std::string& path);

}  // namespace catena::scene
