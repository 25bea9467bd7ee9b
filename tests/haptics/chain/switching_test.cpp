// SPDX-License-Identifier: MIT
#include "haptics/chain/switching.h"

#include "tests/haptics/chain/plane_links.h"

namespace catena::haptics::switching_test {

using test::ChainDriver;
using test::hold_plane;

std::string word(const LinkOrder& order) {
  std::string out;
  for (int k = 0; k < order.count; ++k) out += static_cast<char>('a' + order.links[static_cast<std::size_t>(k)]);
  return out;
}

HapticProgram with(const ActivationSwitch& on) {
  HapticProgram program;
  program.links = {hold_plane("a", {0, 0, 1}, 0)};
  program.links[0].active_when = on;
  return program;
}

TEST(Switching, WithoutSwitchesAllLinksRunAsListed) {
  HapticProgram program = test::make_order_program(0);
  program.modes.clear();
  for (Link& link : program.links) link.active_when = {};
  SwitchState state;
  EXPECT_EQ(word(step_switches(program, 0, 0, state)), "abcd");
  EXPECT_EQ(step_switches(program, ~0u, 99, state).mode, -1);
  program.links.clear();
  EXPECT_EQ(word(step_switches(program, 0, 0, state)), "");
}

TEST(Switching, EachOf32ButtonsSwitchesWhileHeld) {
  for (int button = 1; button <= 32; ++button) {
    const HapticProgram program = with({.button = button});
    SwitchState state;
    const std::uint32_t bit = 1u << (button - 1);
    for (const auto& [buttons, on] : {std::pair{~bit, 0}, {bit, 1}, {bit, 1}, {0u, 0}})
      EXPECT_EQ(step_switches(program, buttons, 0, state).count, on) << buttons;
  }
}

TEST(Switching, AToggleFlipsOnEachPress) {
  const HapticProgram program = with({.button = 2, .toggle = true});
  SwitchState state;
  const std::pair<std::uint32_t, int> steps[] = {{0, 0}, {2, 1}, {2, 1}, {3, 1}, {1, 1}, {0, 1},
                                                 {2, 0}, {2, 0}, {0, 0}, {1, 0}, {3, 1}, {0, 1}};
  for (const auto& [buttons, on] : steps) EXPECT_EQ(step_switches(program, buttons, 0, state).count, on) << buttons;
}

TEST(Switching, AForceSwitchesWithHysteresis) {
  const HapticProgram program = with({.force_above_n = 3, .force_below_n = 1});
  SwitchState state;
  const std::pair<double, int> steps[] = {{0, 0}, {3, 0}, {3.001, 1}, {2, 1}, {1.001, 1}, {1, 0}, {2.9, 0}, {8, 1}, {0, 0}};
  for (const auto& [force, on] : steps) EXPECT_EQ(step_switches(program, 0, force, state).count, on) << force;
  const HapticProgram same = with({.force_above_n = 3, .force_below_n = 3});
  SwitchState other;
  EXPECT_EQ(step_switches(same, 0, 3.1, other).count, 1);
  EXPECT_EQ(step_switches(same, 0, 3, other).count, 0);
}

TEST(Switching, ModesOrderTheLinksAndTheFirstActiveModeWins) {
  const HapticProgram program = test::make_order_program(0);
  SwitchState state;
  // a link's own switch counts in a mode, too
  const std::tuple<std::uint32_t, const char*, int> steps[] = {{0, "ac", -1},    {3, "abcd", -1},  {4 + 3, "dcba", 0}, {4, "ca", 0},
                                                               {8 + 3, "ca", 1}, {8 + 4, "ca", 0}, {0, "ac", -1}};
  for (const auto& [buttons, order, mode] : steps) {
    const LinkOrder now = step_switches(program, buttons, 0, state);
    EXPECT_EQ(word(now), order) << buttons;
    EXPECT_EQ(now.mode, mode) << buttons;
  }
}

TEST(Switching, AModeByForceAndAModeByToggle) {
  HapticProgram program = test::make_order_program(0);
  program.modes[0].active_when = {.force_above_n = 2, .force_below_n = 1};
  program.modes[1].active_when = {.button = 4, .toggle = true};
  SwitchState state;
  EXPECT_EQ(step_switches(program, 0, 2.5, state).mode, 0);
  EXPECT_EQ(step_switches(program, 8, 1.5, state).mode, 0);
  EXPECT_EQ(step_switches(program, 0, 0.5, state).mode, 1) << "the toggle was pressed meanwhile";
  EXPECT_EQ(step_switches(program, 8, 0.5, state).mode, -1);
}

TEST(Switching, EightLinksAndEightModes) {
  HapticProgram program;
  for (int i = 0; i < kMaxSceneLinks; ++i)
    program.links.push_back(hold_plane(std::string(1, static_cast<char>('a' + i)), {0, 1, i + 1.0}, 0));
  for (int m = 0; m < kMaxModes; ++m) program.modes.push_back({"m" + std::to_string(m), {7 - m, m}, {.button = m + 1}});
  program.modes[4].links = {7, 6, 5, 4, 3, 2, 1, 0};
  SwitchState state;
  EXPECT_EQ(word(step_switches(program, 0, 0, state)), "abcdefgh");
  EXPECT_EQ(word(step_switches(program, 1u << 4, 0, state)), "hgfedcba");
  EXPECT_EQ(word(step_switches(program, 1u << 7, 0, state)), "ah");
}

TEST(Switching, TheChainRunsInTheModesOrder) {
  HapticProgram program = test::make_order_program(0);
  ChainDriver hand(program);
  const Vec3 probe(0.3, 0.4, 0.5);
  hand.step(probe, 3 + 4);
  EXPECT_EQ(hand.out.mode, 0);
  // each proxy is on its own plane, projected from the one before it in the mode's order
  Vec3 before = probe;
  for (const int i : {3, 2, 1, 0}) {
    LinkState alone;
    LinkScratch scratch;
    program.links[static_cast<std::size_t>(i)].constraint->advance(before, alone, scratch);
    EXPECT_EQ(hand.out.links[static_cast<std::size_t>(i)].proxy, alone.proxy) << i;
    before = alone.proxy;
  }
  // links that are not in the mode are off and pass the probe through
  hand.step(probe, 3 + 8);
  EXPECT_FALSE(hand.out.links[1].active);
  EXPECT_EQ(hand.out.links[1].proxy, probe);
  EXPECT_EQ(hand.out.links[1].weight, 0);
}

TEST(Switching, RebindKeepsTogglesOfLinksAndModesByName) {
  HapticProgram program = test::make_order_program(0);
  program.links[1].active_when = {.button = 1, .toggle = true};
  program.modes[1].active_when = {.button = 4, .toggle = true};
  ChainDriver hand(program);
  const Vec3 probe(0.3, 0.4, 0.5);
  hand.step(probe, 1);
  hand.step(probe, 8);
  EXPECT_EQ(hand.out.mode, 1);
  HapticProgram next = program;
  std::swap(next.links[0], next.links[1]);
  std::swap(next.modes[0], next.modes[1]);
  for (Mode& mode : next.modes)
    for (int& i : mode.links) i = i < 2 ? 1 - i : i;
  hand.replace(next);
  hand.step(probe, 0);
  EXPECT_EQ(hand.out.mode, 0);
  hand.step(probe, 8);
  EXPECT_EQ(hand.out.mode, -1);
  EXPECT_TRUE(hand.out.links[0].active) << "b was toggled on";
}

}  // namespace catena::haptics::switching_test
