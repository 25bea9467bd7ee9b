// SPDX-License-Identifier: MIT
// The table of commands: the action of each keystroke, and the labels in the menu and the list of keys.
#include "engine/app/viewer/input/commands.h"

#include <gtest/gtest.h>

#include <set>

namespace catena::app {
namespace commands_test {

constexpr int kEscape = 256, kTab = 258, kLeft = 263, kHome = 268, kF1 = 290, kF2 = 291, kF11 = 300, kF12 = 301;

std::optional<Action> asked(int key, bool control = false, bool shift = false, bool fly = false) {
  KeyEvent event;
  event.type = KeyEvent::Type::press;
  event.key = key;
  event.control = control;
  event.shift = shift;
  return find_action(event, fly);
}

TEST(Commands, EachKeystrokeHasOneAction) {
  const struct {
    int key;
    bool control, shift;
    std::optional<Action> action;
  } kStrokes[] = {
      {'O', true, false, Action::open},
      {'O', true, true, Action::open},
      {'O', false, false, Action::toggle_projection},
      {'O', false, true, Action::toggle_projection},
      {'S', true, false, Action::save},
      {'S', true, true, Action::save_as},
      {'S', false, false, {}},
      {'Q', true, false, Action::quit},
      {'Q', false, false, {}},
      {'Z', true, false, Action::undo},
      {'Z', true, true, Action::redo},
      {'Z', false, false, {}},
      {'Y', true, false, Action::redo},
      {'Y', true, true, Action::redo},
      {'1', false, false, Action::view_along_plus_x},
      {'2', false, false, Action::view_along_plus_y},
      {'3', false, true, Action::view_along_minus_z},
      {'1', true, false, {}},
      {'A', false, false, Action::fit_view},
      {kHome, false, false, Action::fit_view},
      {'A', true, false, {}},
      {'R', false, true, Action::reset_view},
      {'T', false, false, Action::toggle_turntable},
      {'T', true, false, {}},
      {'V', false, false, Action::toggle_fly},
      {'H', false, false, Action::toggle_probe_mode},
      {'F', false, false, Action::toggle_forces},
      {'P', false, false, Action::toggle_band_animation},
      {kF1, false, false, Action::toggle_help},
      {kF1, true, false, {}},
      {kF2, false, false, Action::next_stereo_mode},
      {kEscape, false, false, Action::dismiss},
      {kTab, true, false, Action::toggle_panels},
      {kTab, false, false, Action::toggle_panels},
      {kF11, true, true, Action::toggle_fullscreen},
      {kF12, false, false, Action::save_image},
      {kF12, true, true, Action::save_window_image},
      {'B', false, false, {}},
      {'?', false, false, {}},
  };
  for (const auto& stroke : kStrokes)
    EXPECT_TRUE(asked(stroke.key, stroke.control, stroke.shift) == stroke.action) << stroke.key << stroke.control << stroke.shift;
}

TEST(Commands, OnlyKeyPressesAndTheQuestionMarkHaveActions) {
  for (const auto what : {KeyEvent::Type::release, KeyEvent::Type::repeat}) {
    KeyEvent event;
    event.type = what;
    event.key = 'R';
    EXPECT_FALSE(find_action(event, false));
  }
  KeyEvent text;
  text.type = KeyEvent::Type::character;
  for (std::uint32_t c = 1; c < 512; ++c) {
    text.character = c;
    EXPECT_EQ(find_action(text, false).has_value(), c == U'?') << c;
  }
  text.character = U'?';
  EXPECT_EQ(find_action(text, true), Action::toggle_help);
}

TEST(Commands, FlyModeDisablesItsLetterKeysButNotShortcuts) {
  for (const int key : {int('A'), int('S'), int('W'), int('D'), int('E'), int('Q'), kLeft})
    EXPECT_FALSE(asked(key, false, false, true)) << key;
  EXPECT_EQ(asked('A', false, false, false), Action::fit_view);
  EXPECT_EQ(asked('S', true, false, true), Action::save);
  EXPECT_EQ(asked('V', false, false, true), Action::toggle_fly);
}

TEST(Commands, MenuAndShortcutLabelsComeFromTheTable) {
  EXPECT_STREQ(menu_label(Action::save_as), "Save as...");
  EXPECT_EQ(shortcut_label(Action::save_as), "Ctrl+Shift+S");
  EXPECT_EQ(shortcut_label(Action::view_along_minus_y), "Shift+2");
  EXPECT_EQ(shortcut_label(Action::fit_view), "A");
  EXPECT_EQ(shortcut_label(Action::save_window_image), "Shift+F12");
  EXPECT_EQ(shortcut_label(Action::redo), "Ctrl+Y");
}

TEST(Commands, TheListOfKeysHasEachKeystrokeOnce) {
  std::set<std::string> keys;
  for (const KeyHelp& line : key_list()) {
    EXPECT_TRUE(keys.insert(line.keys).second) << line.keys;
    EXPECT_FALSE(line.section.empty() || line.keys.empty() || line.description.empty()) << line.keys;
  }
}

TEST(Commands, ThePrintedListOfKeys) {
  EXPECT_EQ(key_help(), R"keys(left drag            orbit
middle, shift+left   pan
wheel                zoom
1, 2, 3              look along +x, +y, +z at the whole scene; with shift along -x, -y, -z
A, Home              fit the whole scene into the image, from the same direction
O                    orthographic or perspective
R                    return to the first view
T                    start the turntable; T or the mouse stops it
V                    fly: W S A D or arrows, E up, Q down, shift faster, left drag turns, wheel: speed; V or Esc ends flying
right drag, control  move the probe in the image plane (wheel: depth)
H                    probe mode: the mouse moves the probe on the object under the pointer; wheel: depth, left button: button 1
space                button 1 of the probe
F                    forces of a haptic device on or off (initially off)
G                    with a headset: register a haptic device in the room by touching three points; again: cancel
device button 1      grab widgets, select, or as stated by "active_when" in the scene
Ctrl+O               open a file; a file can also be dropped on the window
Ctrl+S, Ctrl+Shift+S save, including a changed view, save as
Ctrl+Z, Ctrl+Y       undo, redo
K                    play or stop the time steps
,, .                 previous time step, next time step
P                    start or stop the moving bands along streamlines
Tab                  show or hide the panels
F2                   next stereo mode
F11                  full screen on or off
F12, Shift+F12       save the image, save the window, as SCENE-001.png
F1, ?                show this list
Esc                  close or cancel an open dialog; end flying, probe mode, full screen
Ctrl+Q               quit
)keys");
}

}  // namespace commands_test
}  // namespace catena::app
