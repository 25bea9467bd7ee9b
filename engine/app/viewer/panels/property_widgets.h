// SPDX-License-Identifier: MIT
/// Widgets for numbers, colors and choices of the scene; a change by the user becomes an edit of the scene at `pointer`. The edits of one
/// drag form one undo step. A new key that is a boolean, a choice, or a number within a range needs no line in its panel: edit_simple_keys
/// draws everything in the component's schema. Another slider is one line:
///   edit_slider(context.edits, "radius", line.radius, 0, 5, pointer + "/radius");
/// Frame thread, between Gui::begin and end.
#pragma once
#include <string>
#include <vector>

#include "engine/app/viewer/edit/edits.h"

namespace catena::app {

/// Draws the header of an item: visibility checkbox, name, "Feel" if it can be bound, and a button to remove it. Returns whether it is
/// open, so that its contents are to be drawn; false if the item is not in the scene's text. Always call end_item() afterwards.
bool begin_item(Edits& edits, const json::Node& where, bool visible, const std::string& word, const std::string& name);
void end_item();

/// Widgets for a boolean, a number in the range lo..hi, and a color.
void edit_boolean(Edits& edits, const char* label, bool value, const std::string& pointer);
void edit_slider(Edits& edits, const char* label, double value, double lo, double hi, const std::string& pointer,
                 const char* format = "%.3g");
void edit_color(Edits& edits, const char* label, const Color& color, const std::string& pointer);

/// Draws widgets for the keys of a scene section ("slices") that are a boolean, a choice, or a number within a range, for one item, with
/// their descriptions as tooltips. Keys in `but` are omitted; the panel draws them itself.
void edit_simple_keys(Edits& edits, const std::string& part, const json::Node& item, const std::vector<std::string_view>& but = {});

/// A number edited by dragging or typing.
struct NumberItem {
  const char* label;
  std::string pointer;
  double value;
  double lo = 0, hi = 0;  ///< If lo < hi: range of the widget; the text may state other values.
  double speed = 0;       ///< Change per pixel of drag; 0: chosen from the value.
  const char* format = "%.5g";
  std::vector<std::string> coupled_pointers{};  ///< Pointers that receive the same value in the same step.
};
/// Draws the widget of a number.
void edit_number(Edits& edits, const NumberItem& item);
/// Draws the widget of a vector, [x, y, z]; `speed` per pixel of drag.
void edit_vector(Edits& edits, const char* label, const std::string& pointer, const Vec3& value, double speed);

/// Draws a text field for a number, accepted at Enter. Returns true if `value` has changed.
bool input_number(const char* label, double& value, const char* hint);
/// Draws a list of `words`. Returns true if `chosen` has changed.
bool choose_from_list(const char* label, const std::vector<std::string>& words, std::string& chosen);

/// Shows a tooltip while the pointer is over the widget above: wrapped to a readable width, or on one line.
void show_tooltip(const std::string& text);
void show_short_tooltip(const std::string& text);

}  // namespace catena::app
