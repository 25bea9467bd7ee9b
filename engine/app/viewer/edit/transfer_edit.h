/// From a volume as it is drawn to one whose transfer function stands in the scene as points, looking the same. What an edit then has to
/// write: single keys where the points are stated already, the whole volume where they came from a file, extinctions or the histogram.
///   alpha = 1 - exp(-sigma u), u the opacity unit; a volume without one gets that at which the thickest point has alpha 0.6
/// Pure, any thread.
#pragma once
#include "engine/app/viewer/edit/edit_text.h"

namespace catena::app {

/// What the editor holds of a volume while it edits.
struct TransferEdit {
  ColorPoints colors;
  OpacityPoints opacities;
  double unit = 0;         ///< world length, > 0
  std::string map;         ///< the colours' name, if they have one; `colors` are its points
  bool has_range = false;  ///< the named map's range is stated
  bool stated = false;     ///< the scene states the opacities as points: single keys can be replaced
};

/// `transfer` as drawn: complete_transfer has filled it in. Empty where it has not.
std::optional<TransferEdit> transfer_edit(const scene::Volume& volume, double smallest_edge);

struct Write {
  std::string pointer, value;
};
/// What makes the document's volume look like the edit, in this order.
std::vector<Write> opacity_writes(const scene::Volume& volume, const TransferEdit& edit);
std::vector<Write> unit_writes(const scene::Volume& volume, const TransferEdit& edit);
/// Stated points; a name is given up.
std::vector<Write> color_writes(const scene::Volume& volume, const TransferEdit& edit);
/// Another name over the range that the colours have.
std::vector<Write> map_writes(const scene::Volume& volume, const TransferEdit& edit, const std::string& map);
/// All points over another range.
std::vector<Write> range_writes(const scene::Volume& volume, TransferEdit edit, double lo, double hi);

}  // namespace catena::app
