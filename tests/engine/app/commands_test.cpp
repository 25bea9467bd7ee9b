// SPDX-License-Identifier: MIT
// The table of commands: the action of each keystroke, and the labels in the menu and the list of keys.
#include "engine/app/viewer/input/commands.h"

#include <gtest/gtest.h>

#include <set>

namespace catena::app::commands_test {

constexpr int kEscape = 256, kTab = 258, kLeft = 263, kHome = 268, kF1 = 290, kF2 = 291, kF11 = 300, kF12 = 301;

enum Modifiers { kPlain = 0, kControl = 1, kShift = 2, kBoth = 3 };

std::optional<Action> asked(int key, bool control = false, bool shift = false, bool fly = false) {
  KeyEvent event;
  event.type = KeyEvent::Type::press;
  event.key = key;
  event.control = control;
  event.shift = shift;
  return find_action(event, fly);
}

TEST(Commands, EachKeystrokeHasOneAction) {
  using enum Action;
  using Strokes = std::vector<std::pair<int, Modifiers>>;
  const std::pair<Action, Strokes> kActions[] = {{open, {{'O', kControl}}},
                                                 {add, {{'O', kBoth}}},
                                                 {toggle_ortho_views, {{'4', kPlain}}},
                                                 {toggle_projection, {{'O', kPlain}, {'O', kShift}}},
                                                 {save, {{'S', kControl}}},
                                                 {save_as, {{'S', kBoth}}},
                                                 {quit, {{'Q', kControl}}},
                                                 {undo, {{'Z', kControl}}},
                                                 {redo, {{'Z', kBoth}, {'Y', kControl}, {'Y', kBoth}}},
                                                 {view_along_plus_x, {{'1', kPlain}}},
                                                 {view_along_plus_y, {{'2', kPlain}}},
                                                 {view_along_minus_z, {{'3', kShift}}},
                                                 {fit_view, {{'A', kPlain}, {kHome, kPlain}}},
                                                 {reset_view, {{'R', kShift}}},
                                                 {toggle_turntable, {{'T', kPlain}}},
                                                 {toggle_fly, {{'V', kPlain}}},
                                                 {toggle_probe_mode, {{'H', kPlain}}},
                                                 {toggle_forces, {{'F', kPlain}}},
                                                 {toggle_band_animation, {{'P', kPlain}}},
                                                 {toggle_help, {{kF1, kPlain}}},
                                                 {next_stereo_mode, {{kF2, kPlain}}},
                                                 {dismiss, {{kEscape, kPlain}}},
                                                 {toggle_panels, {{kTab, kControl}, {kTab, kPlain}}},
                                                 {toggle_fullscreen, {{kF11, kBoth}}},
                                                 {save_image, {{kF12, kPlain}}},
                                                 {save_window_image, {{kF12, kBoth}}}};
  const auto found = [](const std::pair<int, Modifiers>& stroke) {
    return asked(stroke.first, (stroke.second & kControl) != 0, (stroke.second & kShift) != 0);
  };
  for (const auto& [action, strokes] : kActions)
    for (const auto& stroke : strokes) EXPECT_TRUE(found(stroke) == action) << stroke.first << " " << stroke.second;
  for (const auto& stroke : Strokes({{'S', kPlain},
                                     {'Q', kPlain},
                                     {'Z', kPlain},
                                     {'1', kControl},
                                     {'A', kControl},
                                     {'T', kControl},
                                     {kF1, kControl},
                                     {'B', kPlain},
                                     {'?', kPlain}}))
    EXPECT_FALSE(found(stroke)) << stroke.first << " " << stroke.second;
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
  EXPECT_EQ(key_help(), R"keys(left drag            orbit, or move the widget under the pointer
middle, shift+left   pan
wheel                zoom
ctrl+shift+left      window and level of the first volume or slice
1, 2, 3              look along +x, +y, +z at the whole scene; with shift along -x, -y, -z
A, Home              fit the whole scene into the image, from the same direction
O                    orthographic or perspective
4                    orthogonal views; in them, left drag: cross-hair, wheel: next voxel (control: zoom), middle drag: pan, right drag: window and level
R                    return to the first view
T                    start the turntable; T or the mouse stops it
V                    fly: W S A D or arrows, E up, Q down, shift faster, left drag turns, wheel: speed; V or Esc ends flying
right drag, control  move the probe in the image plane (wheel: depth)
H                    probe mode: the mouse moves the probe on the object under the pointer; wheel: depth, left button: button 1
space                button 1 of the probe
F                    forces of a haptic device on or off (initially off)
G                    with a headset: register a haptic device in the room by touching three points; again: cancel
device button 1      grab widgets, select, or as stated by "active_when" in the scene
Ctrl+O, Ctrl+Shift+O open a file; a file can also be dropped on the window, add a file to the scene
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

}  // namespace catena::app::commands_test
