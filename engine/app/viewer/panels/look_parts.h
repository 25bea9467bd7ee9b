/// What the panels of the scene's look have in common. Panels draw the scene as it is and note their edits; the edits are done when
/// nothing refers to the scene's parts any more: each of them reads the scene again. Frame thread.
#pragma once
#include <imgui.h>

#include <functional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/pointers.h"
#include "engine/app/viewer/edit/transfer_edit.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/scene/write_values.h"

namespace catena::app {

/// The edits of one panel in one frame, in order.
class Edits {
 public:
  explicit Edits(PanelContext& context) : context_(context) {}
  ~Edits();
  Edits(const Edits&) = delete;
  Edits& operator=(const Edits&) = delete;

  /// A step of undo of its own.
  void set(std::string pointer, std::string value, std::string what);
  /// All that one press of the pointer (or one text being typed) does is one step of undo.
  void drag(std::string pointer, std::string value, std::string what);
  void set(const TextEdits& edits, const std::string& what);
  void drag(const TextEdits& edits, const std::string& what);
  void remove(std::string pointer, std::string what);
  void later(std::function<void(PanelContext&)> action) { actions_.push_back(std::move(action)); }

 private:
  PanelContext& context_;
  std::vector<std::function<void(PanelContext&)>> actions_;
};

/// A line with a box (seen or hidden), the name, a button that removes the item. Below it, if open, the rest is drawn: true.
/// False too where the item is not of the scene's text.
bool begin_item(Edits& edits, const json::Node& where, bool visible, const std::string& word, const std::string& name);
void end_item();

/// Widgets of one value: what the person makes of it is written to `pointer`.
void edit_boolean(Edits& edits, const char* label, bool value, const std::string& pointer);
void edit_share(Edits& edits, const char* label, double value, const std::string& pointer);  ///< 0..1
void edit_color(Edits& edits, const char* label, const scene::Rgb& color, const std::string& pointer);
/// A number typed, taken at Enter.
bool typed_number(const char* label, double& value, const char* tip);

/// The colours of an item that colours by values: a map's name, reversed or not, its range.
void edit_color_scale(Edits& edits, const json::Node& item, const std::vector<scene::TransferFunction::ColorPoint>& table,
                      const scene::NamedColors& named, std::string_view fallback);
/// A combo of the maps' names. The name chosen, "_r" with it.
std::optional<std::string> choose_map(const std::string& now, const char* otherwise);

/// Grey bars of how often values occur.
void draw_bars(const PlotFrame& frame, const SortedValues& values, ImU32 color);
/// A histogram with a line at the value, which the pointer moves; with Ctrl finely. True while it moves.
bool histogram_slider(PanelContext& context, const char* id, const SortedValues& values, double lo, double hi, const scene::Rgb& color,
                      double& value);

void tip(const char* text);
inline ImU32 packed(const scene::Rgb& c, float alpha = 1) { return ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, alpha)); }

}  // namespace catena::app
