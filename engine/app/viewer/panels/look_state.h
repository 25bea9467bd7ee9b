/// LookState is what the panels of the scene's look remember from frame to frame. Frame thread.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "engine/app/viewer/edit/field_values.h"
#include "engine/app/viewer/edit/transfer_edit.h"

namespace catena::app {

struct LookState {
  FieldValues values;
  int press = 0;  ///< counts presses of the pointer: names drags

  /// A drag in a plot: where the handle would be, by the pointer alone.
  double at_x = 0, at_y = 0;

  /// The transfer function being edited.
  struct Transfer {
    std::string volume;                         ///< its pointer
    std::optional<std::size_t> opacity, color;  ///< selected points
    std::optional<TransferEdit> before;         ///< as it was when the drag began
    std::optional<PlotFrame> frame;             ///< stands still while something is dragged
    bool whole_range = false;
  } transfer;

  std::map<std::string, std::string> switched_off;  ///< pointer to the text that stood there
};

}  // namespace catena::app
