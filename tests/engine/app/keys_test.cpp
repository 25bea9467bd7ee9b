// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/keys.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

namespace catena::app {
namespace keys_test {

using What = KeyEvent::Type;
constexpr int kA = 65, kB = 66, kEscape = 256, kEnter = 257, kBackspace = 259, kShift = 340, kControl = 341;

KeyEvent event(What what, int key, std::uint32_t character = 0) {
  KeyEvent e;
  e.type = what;
  e.key = key;
  e.character = character;
  return e;
}

/// An interface as Dear ImGui 1.86 is one: keys and modifiers as they are when a frame begins, text before keys within a frame.
struct Interface {
  KeyFrameScheduler frames;
  std::set<int> down, down_before;
  std::string text_told, text_read, strokes_read;
  int mixed = 0;

  void frame() {
    // a stroke is a key that was up in the frame before
    strokes_read += text_told;
    for (const int key : down)
      if (!down_before.contains(key)) strokes_read += "<" + std::to_string(key) + ">";
    text_read += text_told;
    text_told.clear();
    down_before = down;
    frames.end_frame();
  }
  void tell(const KeyEvent& e) {
    if (!frames.fits_current_frame(e)) frame();
    EXPECT_TRUE(frames.fits_current_frame(e)) << "after a frame anything joins";
    frames.add(e);
    if (e.type == What::press) down.insert(e.key);
    if (e.type == What::release) down.erase(e.key);
    if (e.type == What::focus_lost) down.clear();
    if (e.type == What::character) text_told += static_cast<char>(e.character);
  }
};

TEST(Keys, AShortStrokeIsDownInOneFrameAndUpInALaterOne) {
  Interface ui;
  ui.tell(event(What::press, kBackspace));
  ui.tell(event(What::release, kBackspace));
  ui.tell(event(What::press, kBackspace));
  ui.tell(event(What::release, kBackspace));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "<259><259>");
}

TEST(Keys, TextAndEditingKeysKeepTheirOrder) {
  Interface ui;
  for (const char c : std::string("ab")) ui.tell(event(What::character, 0, static_cast<std::uint32_t>(c)));
  ui.tell(event(What::press, kBackspace));
  ui.tell(event(What::character, 0, 'c'));
  ui.tell(event(What::press, kEnter));
  ui.tell(event(What::character, 0, 'd'));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "ab<259>c<257>d");
}

TEST(Keys, AHeldBackspaceRepeatsAndAHeldReturnDoesNot) {
  const auto repeated = resolve_repeats(event(What::repeat, kBackspace));
  ASSERT_EQ(repeated.size(), 2u);
  EXPECT_EQ(repeated[0].type, What::release);
  EXPECT_EQ(repeated[1].type, What::press);
  for (const int key : {kEnter, kEscape, kA, kControl}) EXPECT_TRUE(resolve_repeats(event(What::repeat, key)).empty());
  Interface ui;
  ui.tell(event(What::press, kBackspace));
  for (const KeyEvent& e : repeated) ui.tell(e);
  ui.tell(event(What::release, kBackspace));
  ui.frame();
  EXPECT_EQ(ui.strokes_read, "<259><259>");
}

TEST(Keys, AnyInterleavingOfStrokesRepeatsFocusAndFramesLosesNothing) {
  std::mt19937 random(20240611);
  for (int run = 0; run < 3000; ++run) {
    Interface ui;
    std::set<int> held;  // by the person
    std::string expected_text, expected_strokes;
    const auto modifiers = [](const std::set<int>& keys) {
      std::set<int> some;
      for (const int key : keys)
        if (key == kShift || key == kControl) some.insert(key);
      return some;
    };
    // what a frame reads was made with the modifiers that the frame has
    std::vector<std::set<int>> made_with;
    const auto check_frame = [&] {
      for (const std::set<int>& with : made_with)
        if (with != modifiers(ui.down)) ++ui.mixed;
      made_with.clear();
    };
    const auto tell = [&](const KeyEvent& e) {
      if (!ui.frames.fits_current_frame(e)) check_frame();
      ui.tell(e);
    };
    for (int step = 0; step < 60; ++step) {
      constexpr int kKeys[] = {kA, kB, kEscape, kBackspace, kShift, kControl};
      const int key = kKeys[random() % 6];
      const auto dice = random() % 20;
      const bool is_modifier = key == kShift || key == kControl;
      if (dice == 0) {
        // GLFW tells the loss, then lets every key go
        tell(event(What::focus_lost, 0));
        for (const int k : held) tell(event(What::release, k));
        held.clear();
        tell(event(What::focus_gained, 0));
      } else if (dice == 1) {
        check_frame();
        ui.frame();
      } else if (dice < 4 && held.contains(key)) {
        for (const KeyEvent& e : resolve_repeats(event(What::repeat, key))) tell(e);
        if (key == kBackspace) expected_strokes += "<259>";
      } else if (held.erase(key) > 0) {
        tell(event(What::release, key));
      } else {
        KeyEvent press = event(What::press, key);
        press.shift = held.contains(kShift);
        press.control = held.contains(kControl);
        tell(press);
        held.insert(key);
        if (!is_modifier) made_with.push_back(modifiers(held));
        if (!is_modifier && key != kA && key != kB) expected_strokes += "<" + std::to_string(key) + ">";
        if ((key == kA || key == kB) && !press.control) {
          const char c = static_cast<char>(press.shift ? key : key + 32);
          tell(event(What::character, 0, static_cast<std::uint32_t>(c)));
          made_with.push_back(modifiers(held));
          expected_text += c;
          expected_strokes += c;
        }
      }
    }
    check_frame();
    ui.frame();
    ASSERT_EQ(ui.text_read, expected_text) << "run " << run;
    ASSERT_EQ(ui.mixed, 0) << "run " << run << ": a modifier changed between a stroke and its frame";
    ASSERT_EQ(ui.down, held) << "run " << run;
    // letters and modifiers themselves make no difference to who reads text; all else comes once each, in order with the text
    std::string strokes = ui.strokes_read;
    for (const int key : {kA, kB, kShift, kControl})
      for (const std::string word = "<" + std::to_string(key) + ">"; strokes.find(word) != std::string::npos;)
        strokes.erase(strokes.find(word), word.size());
    ASSERT_EQ(strokes, expected_strokes) << "run " << run;
  }
}

}  // namespace keys_test
}  // namespace catena::app
