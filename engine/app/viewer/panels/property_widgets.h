/// These functions draw numbers, colours and choices of the scene as items of the interface; what the person makes of one is an edit of the
/// scene at `pointer`. While an item is dragged its edits are one step of undo. A new key that is a yes or no, a word, or a number between
/// two ends needs no line in its panel: edit_simple_keys draws whatever the component's description has. Another slider is one line:
///   edit_slider(context.edits, "radius", line.radius, 0, 5, pointer + "/radius");
/// Frame thread, between Gui::begin and end.
#pragma once
#include <string>
#include <vector>

#include "engine/app/viewer/edit/edits.h"

namespace catena::app {

/// A line with a box (seen or hidden), the name, a button that removes the item. Below it, if open, the rest is drawn: true.
/// False too where the item is not of the scene's text.
bool begin_item(Edits& edits, const json::Node& where, bool visible, const std::string& word, const std::string& name);
void end_item();

void edit_boolean(Edits& edits, const char* label, bool value, const std::string& pointer);
void edit_slider(Edits& edits, const char* label, double value, double lo, double hi, const std::string& pointer,
                 const char* format = "%.3g");
void edit_color(Edits& edits, const char* label, const Color& color, const std::string& pointer);

/// The keys of a part of the scene ("slices") that are a boolean, a word, or a number within two bounds, for one item of it, with their
/// sentences as tips. Those of `but` are drawn by the panel itself.
void edit_simple_keys(Edits& edits, const std::string& part, const json::Node& item, const std::vector<std::string_view>& but = {});

/// A number that is dragged or typed.
struct NumberItem {
  const char* label;
  std::string pointer;
  double value;
  double lo = 0, hi = 0;  ///< lo < hi: the item's range; the text may still say more
  double speed = 0;       ///< a pixel of drag; 0: by the value
  const char* format = "%.5g";
  std::vector<std::string> coupled_pointers{};  ///< pointers that get the same value in the same step
};
void edit_number(Edits& edits, const NumberItem& item);
/// Three numbers, [x, y, z].
void edit_vector(Edits& edits, const char* label, const std::string& pointer, const Vec3& value, double speed);

/// A number typed, taken at Enter; true: `value` is another now.
bool input_number(const char* label, double& value, const char* hint);
/// One of `words`; true: `chosen` is another now.
bool choose_from_list(const char* label, const std::vector<std::string>& words, std::string& chosen);

/// A text that appears while the item above is pointed at, in lines of a readable length; the same on one line.
void show_tooltip(const std::string& text);
void show_short_tooltip(const std::string& text);

}  // namespace catena::app
