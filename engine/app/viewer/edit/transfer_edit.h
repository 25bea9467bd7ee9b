/// This file leads from a volume as it is drawn to one whose transfer function stands in the scene as points and looks the same, and has
/// the edits of the scene's text that make it what the hand wants. Where the points came from a file, extinctions or the histogram, the
/// first edit states them all.
///   alpha = 1 - exp(-sigma u), u the opacity unit; a volume without opacities gets that at which the thickest point has alpha 0.6
/// Pure, any thread.
#pragma once
#include "engine/app/viewer/edit/pointers.h"
#include "engine/app/viewer/edit/transfer_points.h"

namespace catena::app {

/// What the editor holds of a volume while it edits.
struct TransferEdit {
  ColorPoints colors;
  OpacityPoints opacities;
  double unit = 0;         ///< world length, > 0
  std::string map;         ///< the colours' name, if they have one; `colors` are its points
  bool has_range = false;  ///< the named map's range is stated
};

/// `volume.transfer` as drawn: complete_transfer has filled it in. Empty where it has not.
std::optional<TransferEdit> transfer_edit(const scene::Volume& volume, double smallest_edge);

/// What makes the text's volume look like the edit.
TextEdits opacity_edits(const scene::Volume& volume, TransferEdit edit);
TextEdits unit_edits(const scene::Volume& volume, const TransferEdit& edit);
/// Stated points; a name is given up.
TextEdits color_edits(const scene::Volume& volume, TransferEdit edit);
/// Another name over the range that the colours have.
TextEdits map_edits(const scene::Volume& volume, TransferEdit edit, const std::string& map);
/// All points over another range; empty where they cannot lie in it.
TextEdits range_edits(const scene::Volume& volume, TransferEdit edit, double lo, double hi);

}  // namespace catena::app
