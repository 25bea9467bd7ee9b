// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/commands.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>

namespace catena::app {

namespace {

enum class Held : std::uint8_t { no, yes, any };

struct KeyChord {
  int key = 0;  ///< GLFW key number, or kQuestionMark; 0: none
  Held control = Held::no, shift = Held::any;
  bool is_listed = true;  ///< shown in the list of keys
};
/// Matched by the character, not by a key: keyboard layouts place it differently.
constexpr int kQuestionMark = '?';

struct CommandRow {
  std::optional<Action> action{};  ///< none: the row describes the pointer or the device
  const char* menu = nullptr;      ///< nullptr: in no menu; for an axis view, the axis in the format of render::axis_view
  KeyChord stroke{}, other{};      ///< either triggers the action
  const char* section = nullptr;   ///< section of the list of keys; nullptr: same line as the row above
  const char* does = nullptr;      ///< description; nullptr: the row is not in the list
  const char* by = nullptr;        ///< input shown in the list if it is not a key
};

constexpr const char *kEye = "Camera", *kHand = "Probe", *kScene = "Scene", *kWindow = "Window";
constexpr KeyChord kNoChord{};

constexpr CommandRow by_pointer(const char* section, const char* by, const char* does) {
  return {.section = section, .does = does, .by = by};
}
constexpr KeyChord with_control(int key, Held shift = Held::any, bool is_listed = true) { return {key, Held::yes, shift, is_listed}; }
constexpr KeyChord with_shift(int key) { return {key, Held::no, Held::yes}; }
constexpr KeyChord alone(int key) { return {key, Held::no, Held::no}; }

// in the order of the list of keys
constexpr CommandRow kCommandRows[] = {
    by_pointer(kEye, "left drag", "orbit, or move the widget under the pointer"),
    by_pointer(kEye, "middle, shift+left", "pan"),
    by_pointer(kEye, "wheel", "zoom"),
    by_pointer(kEye, "ctrl+shift+left", "window and level of the first volume or slice"),
    {Action::view_along_plus_x, "+x", alone(GLFW_KEY_1), kNoChord, kEye, "look along +x"},
    {Action::view_along_plus_y, "+y", alone(GLFW_KEY_2), kNoChord, nullptr, "+y"},
    {Action::view_along_plus_z, "+z", alone(GLFW_KEY_3), kNoChord, nullptr, "+z at the whole scene; with shift along -x, -y, -z"},
    {Action::view_along_minus_x, "-x", with_shift(GLFW_KEY_1)},
    {Action::view_along_minus_y, "-y", with_shift(GLFW_KEY_2)},
    {Action::view_along_minus_z, "-z", with_shift(GLFW_KEY_3)},
    {Action::fit_view,
     "Show everything",
     {GLFW_KEY_A},
     {GLFW_KEY_HOME},
     kEye,
     "fit the whole scene into the image, from the same direction"},
    {Action::toggle_projection, "Orthographic", {GLFW_KEY_O}, kNoChord, kEye, "orthographic or perspective"},
    {Action::toggle_ortho_views, "Orthogonal views", alone(GLFW_KEY_4), kNoChord, kEye,
     "orthogonal views; in them, left drag: cross-hair, wheel: next voxel (control: zoom), middle drag: pan, right drag: window and level"},
    {Action::reset_view, "First view", {GLFW_KEY_R}, kNoChord, kEye, "return to the first view"},
    {Action::toggle_turntable, "Turntable", {GLFW_KEY_T}, kNoChord, kEye, "start the turntable; T or the mouse stops it"},
    {Action::toggle_fly,
     "Fly",
     {GLFW_KEY_V},
     kNoChord,
     kEye,
     "fly: W S A D or arrows, E up, Q down, shift faster, left drag turns, wheel: speed; V or Esc ends flying"},

    by_pointer(kHand, "right drag, control", "move the probe in the image plane (wheel: depth)"),
    {Action::toggle_probe_mode,
     "Probe mode",
     {GLFW_KEY_H},
     kNoChord,
     kHand,
     "probe mode: the mouse moves the probe on the object under the pointer; wheel: depth, left button: button 1"},
    by_pointer(kHand, "space", "button 1 of the probe"),
    {Action::toggle_forces, "Forces", {GLFW_KEY_F}, kNoChord, kHand, "forces of a haptic device on or off (initially off)"},
    {Action::register_device,
     "Register in the room",
     {GLFW_KEY_G},
     kNoChord,
     kHand,
     "with a headset: register a haptic device in the room by touching three points; again: cancel"},
    by_pointer(kHand, "device button 1", "grab widgets, select, or as stated by \"active_when\" in the scene"),

    {Action::open, "Open...", with_control(GLFW_KEY_O, Held::no), kNoChord, kScene,
     "open a file; a file can also be dropped on the window"},
    {Action::add, "Add...", with_control(GLFW_KEY_O, Held::yes), kNoChord, nullptr, "add a file to the scene"},
    {Action::save, "Save", with_control(GLFW_KEY_S, Held::no), kNoChord, kScene, "save, including a changed view"},
    {Action::save_as, "Save as...", with_control(GLFW_KEY_S, Held::yes), kNoChord, nullptr, "save as"},
    {Action::undo, "Undo", with_control(GLFW_KEY_Z, Held::no), kNoChord, kScene, "undo"},
    {Action::redo, "Redo", with_control(GLFW_KEY_Y), with_control(GLFW_KEY_Z, Held::yes, false), nullptr, "redo"},
    {Action::play_time_steps, nullptr, {GLFW_KEY_K}, kNoChord, kScene, "play or stop the time steps"},
    {Action::previous_time_step, nullptr, {GLFW_KEY_COMMA}, kNoChord, kScene, "previous time step"},
    {Action::next_time_step, nullptr, {GLFW_KEY_PERIOD}, kNoChord, nullptr, "next time step"},
    {Action::toggle_band_animation, nullptr, {GLFW_KEY_P}, kNoChord, kScene, "start or stop the moving bands along streamlines"},

    {Action::toggle_panels, "Panels", {GLFW_KEY_TAB, Held::any}, kNoChord, kWindow, "show or hide the panels"},
    {Action::next_stereo_mode, nullptr, {GLFW_KEY_F2}, kNoChord, kWindow, "next stereo mode"},
    {Action::toggle_fullscreen, "Full screen", {GLFW_KEY_F11, Held::any}, kNoChord, kWindow, "full screen on or off"},
    {Action::save_image, "Save image as PNG", {GLFW_KEY_F12, Held::any, Held::no}, kNoChord, kWindow, "save the image"},
    {Action::save_window_image,
     "Save window as PNG",
     {GLFW_KEY_F12, Held::any, Held::yes},
     kNoChord,
     nullptr,
     "save the window, as SCENE-001.png"},
    {Action::toggle_help, "Keys and buttons", {GLFW_KEY_F1}, {kQuestionMark}, kWindow, "show this list"},
    {Action::dismiss, nullptr, {GLFW_KEY_ESCAPE}, kNoChord, kWindow, "close or cancel an open dialog; end flying, probe mode, full screen"},
    {Action::quit, "Quit", with_control(GLFW_KEY_Q), kNoChord, kWindow, "quit"},
};

constexpr bool may_meet(Held a, Held b) { return a == b || a == Held::any || b == Held::any; }
constexpr bool may_meet(const KeyChord& a, const KeyChord& b) {
  return a.key != 0 && a.key == b.key && may_meet(a.control, b.control) && may_meet(a.shift, b.shift);
}
/// Returns whether every action has exactly one row and every key press triggers at most one action.
constexpr bool is_sound() {
  for (int i = 0; i <= static_cast<int>(Action::toggle_forces); ++i)
    if (std::ranges::count(kCommandRows, std::optional(static_cast<Action>(i)), &CommandRow::action) != 1) return false;
  for (const CommandRow& a : kCommandRows)
    for (const CommandRow& b : kCommandRows)
      if (&a != &b && (may_meet(a.stroke, b.stroke) || may_meet(a.stroke, b.other) || may_meet(a.other, b.other))) return false;
  return true;
}
static_assert(is_sound());

const CommandRow& row_of(Action action) { return *std::ranges::find(kCommandRows, std::optional(action), &CommandRow::action); }

bool is(const KeyChord& stroke, const KeyEvent& event) {
  const auto fits = [](Held wanted, bool held) { return wanted == Held::any || held == (wanted == Held::yes); };
  if (event.type == KeyEvent::Type::character) return stroke.key == kQuestionMark && event.character == U'?';
  return stroke.key == event.key && stroke.key != kQuestionMark && fits(stroke.control, event.control) && fits(stroke.shift, event.shift);
}

bool is_fly_key(int key) {
  constexpr int kKeys[] = {GLFW_KEY_W, GLFW_KEY_A,    GLFW_KEY_S,     GLFW_KEY_D,  GLFW_KEY_E,
                           GLFW_KEY_Q, GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_UP, GLFW_KEY_DOWN};
  return std::ranges::find(kKeys, key) != std::end(kKeys);
}

std::string stroke_words(const KeyChord& stroke) {
  std::string text = stroke.control == Held::yes ? "Ctrl+" : "";
  if (stroke.shift == Held::yes) text += "Shift+";
  if (stroke.key >= GLFW_KEY_F1 && stroke.key <= GLFW_KEY_F12) return text + "F" + std::to_string(stroke.key - GLFW_KEY_F1 + 1);
  switch (stroke.key) {
    case GLFW_KEY_TAB:
      return text + "Tab";
    case GLFW_KEY_HOME:
      return text + "Home";
    case GLFW_KEY_ESCAPE:
      return text + "Esc";
    default:
      return text + static_cast<char>(stroke.key);  // letters, digits and "?" equal their key numbers
  }
}

std::string listed_keys(const CommandRow& row) {
  if (row.by != nullptr) return row.by;
  return stroke_words(row.stroke) + (row.other.key != 0 && row.other.is_listed ? ", " + stroke_words(row.other) : "");
}

}  // namespace

std::optional<Action> find_action(const KeyEvent& event, bool fly) {
  const bool counts = event.type == KeyEvent::Type::press || event.type == KeyEvent::Type::character;
  if (!counts || (fly && !event.control && is_fly_key(event.key))) return std::nullopt;
  for (const CommandRow& row : kCommandRows)
    if (row.action && (is(row.stroke, event) || (row.other.key != 0 && is(row.other, event)))) return row.action;
  return std::nullopt;
}

const char* menu_label(Action action) { return row_of(action).menu; }

std::string shortcut_label(Action action) { return stroke_words(row_of(action).stroke); }

const std::vector<KeyHelp>& key_list() {
  static const std::vector<KeyHelp> list = [] {
    std::vector<KeyHelp> lines;
    for (const CommandRow& row : kCommandRows) {
      if (row.does == nullptr) continue;
      if (row.section != nullptr) {
        lines.push_back({row.section, listed_keys(row), row.does});
      } else {
        lines.back().keys += ", " + listed_keys(row);
        lines.back().description += std::string(", ") + row.does;
      }
    }
    return lines;
  }();
  return list;
}

std::string key_help() {
  std::string text;
  for (const KeyHelp& key : key_list())
    text += key.keys + std::string(key.keys.size() < 21 ? 21 - key.keys.size() : 1, ' ') + key.description + "\n";
  return text;
}

}  // namespace catena::app
