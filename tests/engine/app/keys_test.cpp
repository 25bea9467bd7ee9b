// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/keys.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

namespace catena::app::keys_test {

using What = KeyEvent::Type;
constexpr int kA = 65, kB = 66, kEscape = 256, kEnter = 257, kBackspace = 259, kShift = 340, kControl = 341;

KeyEvent event(What what, int key, std::uint32_t character = 0) {
  KeyEvent e;
  e.type = what;
  e.key = key;
  e.character = character;
  return e;
}

/// A model of Dear ImGui 1.86: keys and modifiers have their state at the beginning of a frame, and text is read before keys.
struct Interface {
  KeyFrameScheduler frames;
  std::set<int> down, down_before;
  std::string pending_text, text_read, strokes_read;
  int mixed = 0;

  void frame() {
    // A keystroke is a key that was up in the frame before.
    strokes_read += pending_text;
    for (const int key : down)
      if (!down_before.contains(key)) strokes_read += "<" + std::to_string(key) + ">";
    text_read += pending_text;
    pending_text.clear();
    down_before = down;
    frames.end_frame();
  }
  void send(const KeyEvent& e) {
    if (!frames.fits_current_frame(e)) frame();
    EXPECT_TRUE(frames.fits_current_frame(e)) << "after a frame anything joins";
    frames.add(e);
    if (e.type == What::press) down.insert(e.key);
    if (e.type == What::release) down.erase(e.key);
    if (e.type == What::focus_lost) down.clear();
    if (e.type == What::character) pending_text += static_cast<char>(e.character);
  }
};

TEST(Keys, AShortKeystrokeIsPressedAndReleasedInDifferentFrames) {
  Interface ui;
  for (const What what : {What::press, What::release, What::press, What::release}) ui.send(event(what, kBackspace));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "<259><259>");
}

TEST(Keys, TextAndEditingKeysKeepTheirOrder) {
  Interface ui;
  for (const char c : std::string("ab")) ui.send(event(What::character, 0, static_cast<std::uint32_t>(c)));
  ui.send(event(What::press, kBackspace));
  ui.send(event(What::character, 0, 'c'));
  ui.send(event(What::press, kEnter));
  ui.send(event(What::character, 0, 'd'));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "ab<259>c<257>d");
}

TEST(Keys, BackspaceRepeatsAndReturnDoesNot) {
  const auto repeated = resolve_repeats(event(What::repeat, kBackspace));
  ASSERT_EQ(repeated.size(), 2u);
  EXPECT_EQ(repeated[0].type, What::release);
  EXPECT_EQ(repeated[1].type, What::press);
  for (const int key : {kEnter, kEscape, kA, kControl}) EXPECT_TRUE(resolve_repeats(event(What::repeat, key)).empty());
  Interface ui;
  ui.send(event(What::press, kBackspace));
  for (const KeyEvent& e : repeated) ui.send(e);
  ui.send(event(What::release, kBackspace));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "<259><259>");
}

TEST(Keys, NoInterleavingOfKeysRepeatsFocusAndFramesLosesInput) {
  std::mt19937 random(20240611);
  for (int run = 0; run < 3000; ++run) {
    Interface ui;
    std::set<int> down_keys;
    std::string expected_text, expected_strokes;
    const auto modifiers = [](const std::set<int>& keys) {
      std::set<int> some;
      for (const int key : keys)
        if (key == kShift || key == kControl) some.insert(key);
      return some;
    };
    // The text and keys of a frame are entered with the modifiers that the frame has.
    std::vector<std::set<int>> made_with;
    const auto check_frame = [&] {
      for (const std::set<int>& with : made_with)
        if (with != modifiers(ui.down)) ++ui.mixed;
      made_with.clear();
    };
    const auto send = [&](const KeyEvent& e) {
      if (!ui.frames.fits_current_frame(e)) check_frame();
      ui.send(e);
    };
    for (int step = 0; step < 60; ++step) {
      constexpr int kKeys[] = {kA, kB, kEscape, kBackspace, kShift, kControl};
      const int key = kKeys[random() % 6];
      const auto dice = random() % 20;
      const bool is_modifier = key == kShift || key == kControl;
      if (dice == 0) {
        // GLFW reports the loss of focus, then releases every key.
        send(event(What::focus_lost, 0));
        for (const int k : down_keys) send(event(What::release, k));
        down_keys.clear();
        send(event(What::focus_gained, 0));
      } else if (dice == 1) {
        check_frame();
        ui.frame();
      } else if (dice < 4 && down_keys.contains(key)) {
        for (const KeyEvent& e : resolve_repeats(event(What::repeat, key))) send(e);
        if (key == kBackspace) expected_strokes += "<259>";
      } else if (down_keys.erase(key) > 0) {
        send(event(What::release, key));
      } else {
        KeyEvent press = event(What::press, key);
        press.shift = down_keys.contains(kShift);
        press.control = down_keys.contains(kControl);
        send(press);
        down_keys.insert(key);
        if (!is_modifier) made_with.push_back(modifiers(down_keys));
        if (!is_modifier && key != kA && key != kB) expected_strokes += "<" + std::to_string(key) + ">";
        if ((key == kA || key == kB) && !press.control) {
          const char c = static_cast<char>(press.shift ? key : key + 32);
          send(event(What::character, 0, static_cast<std::uint32_t>(c)));
          made_with.push_back(modifiers(down_keys));
          expected_text += c;
          expected_strokes += c;
        }
      }
    }
    check_frame();
    ui.frame();
    ASSERT_EQ(ui.text_read, expected_text) << "run " << run;
    ASSERT_EQ(ui.mixed, 0) << "run " << run << ": a modifier changed between a stroke and its frame";
    ASSERT_EQ(ui.down, down_keys) << "run " << run;
    // Letter and modifier keys have no effect on text input; each other key is read exactly once, in order with the text.
    std::string strokes = ui.strokes_read;
    for (const int key : {kA, kB, kShift, kControl})
      for (const std::string word = "<" + std::to_string(key) + ">"; strokes.find(word) != std::string::npos;)
        strokes.erase(strokes.find(word), word.size());
    ASSERT_EQ(strokes, expected_strokes) << "run " << run;
  }
}

}  // namespace catena::app::keys_test
