/// Numbers and choices of the scene as interface items: what the person does becomes an edit of the document. While an item is dragged
/// its edits are one step of undo. Between Gui::begin and end.
#pragma once
#include <string>
#include <vector>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

struct NumberItem {
  const char* label;
  std::string pointer;  ///< of the document
  double value;
  double lo = 0, hi = 0;  ///< lo < hi: the item's range; the text may still say more
  double speed = 0;       ///< a pixel of drag; 0: by the value
  const char* format = "%.5g";
  std::vector<std::string> along{};  ///< pointers that get the same value in the same step
};
/// True: edited.
bool edit_number(PanelContext& context, const NumberItem& item);
/// Three numbers, [x, y, z].
bool edit_vector(PanelContext& context, const char* label, const std::string& pointer, const Vec3& value, double speed);
/// One of `words`; true: `chosen` is another now.
bool choose(const char* label, const std::vector<std::string>& words, std::string& chosen);

/// A line that appears while the item above is pointed at.
void tip(const std::string& text);

}  // namespace catena::app
