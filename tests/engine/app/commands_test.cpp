// SPDX-License-Identifier: MIT
// The table of commands: which stroke asks for what, and what menu and list of keys say of it.
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

TEST(Commands, AStrokeAsksForOneThing) {
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

TEST(Commands, OnlyAPressAndAQuestionMarkAsk) {
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

TEST(Commands, LettersThatFlyAreNoCommandsButShortcutsAre) {
  for (const int key : {int('A'), int('S'), int('W'), int('D'), int('E'), int('Q'), kLeft})
    EXPECT_FALSE(asked(key, false, false, true)) << key;
  EXPECT_EQ(asked('A', false, false, false), Action::fit_view);
  EXPECT_EQ(asked('S', true, false, true), Action::save);
  EXPECT_EQ(asked('V', false, false, true), Action::toggle_fly);
}

TEST(Commands, MenuAndKeysSayWhatTheTableSays) {
  EXPECT_STREQ(menu_label(Action::save_as), "Save as...");
  EXPECT_EQ(shortcut_label(Action::save_as), "Ctrl+Shift+S");
  EXPECT_EQ(shortcut_label(Action::view_along_minus_y), "Shift+2");
  EXPECT_EQ(shortcut_label(Action::fit_view), "A");
  EXPECT_EQ(shortcut_label(Action::save_window_image), "Shift+F12");
  EXPECT_EQ(shortcut_label(Action::redo), "Ctrl+Y");
}

TEST(Commands, TheListOfKeysNamesEachStrokeOnce) {
  std::set<std::string> keys;
  for (const KeyHelp& line : key_list()) {
    EXPECT_TRUE(keys.insert(line.keys).second) << line.keys;
    EXPECT_FALSE(line.section.empty() || line.keys.empty() || line.description.empty()) << line.keys;
  }
}

TEST(Commands, TheListOfKeysAsItIsPrinted) {
  EXPECT_EQ(key_help(), R"keys(left drag            orbit
middle, shift+left   pan
wheel                zoom
1, 2, 3              look along +x, +y, +z, at all that is drawn; with shift along -x, -y, -z
A, Home              all that is drawn into the picture, from the same direction
O                    orthographic or perspective
R                    the first view again
T                    turntable, until T or the mouse
V                    fly: W S A D or arrows, E up, Q down, shift faster, left drag looks about, wheel: pace; V or Esc ends it
right drag, control  move the hand in the picture's plane (wheel: depth)
H                    the mouse is the hand, on what is under the pointer; the wheel pushes, the left button is its button 1
space                the hand's button 1
F                    a haptic device's forces on and off (off at first)
G                    with a headset: touch three places, which says where a haptic device stands; again: not now
device button 1      takes hold of widgets, selects; what the scene's "active_when" says
Ctrl+O               open; a file can be dropped on the window as well
Ctrl+S, Ctrl+Shift+S save (with the view, if it was moved), save as
Ctrl+Z, Ctrl+Y       undo, redo
K                    play the steps in time, or stop
,, .                 the step before, and after
P                    the pulses along streamlines stand or run
Tab                  panels
F2                   the next stereo mode
F11                  full screen
F12, Shift+F12       write the picture, the window, as SCENE-001.png
F1, ?                these keys
Esc                  closes or cancels what is open, ends flying, hand mode, full screen
Ctrl+Q               quit
)keys");
}

}  // namespace commands_test
}  // namespace catena::app
