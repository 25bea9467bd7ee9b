// SPDX-License-Identifier: MIT
#include "engine/widget/state_machine.h"

#include <gtest/gtest.h>

namespace catena::widget {
namespace widget_state_machine_test {

constexpr Mode kModes[] = {Mode::idle, Mode::explore, Mode::translate, Mode::rotate, Mode::turn, Mode::hover, Mode::drag};

struct Row {
  Mode from;
  TransitionInput facts;
  Mode to;
};

std::string word(const TransitionInput& f) {
  std::string out;
  for (const auto& [is, name] : {std::pair{f.near_handle, "handle "},
                                 {f.near_sphere, "sphere "},
                                 {f.near_plane, "plane "},
                                 {f.button_pressed, "pressed "},
                                 {f.button_down, "down "},
                                 {f.rotate_on_contact, "touch "},
                                 {f.is_gripped, "gripped "}})
    if (is) out += name;
  return out;
}

void expect_rows(Kind kind, std::initializer_list<Row> rows) {
  for (const Row& row : rows)
    EXPECT_EQ(to_string(next_mode(kind, row.from, row.facts)), std::string(to_string(row.to)))
        << "from " << to_string(row.from) << " with " << word(row.facts);
}

TEST(WidgetMachine, EveryTransitionOfACuttingPlane) {
  const TransitionInput nothing, plane{.near_plane = true}, sphere{.near_sphere = true}, both{.near_sphere = true, .near_plane = true};
  const auto with = [](TransitionInput f, bool pressed, bool down, bool touch = false, bool gripped = false) {
    f.button_pressed = pressed, f.button_down = down, f.rotate_on_contact = touch, f.is_gripped = gripped;
    return f;
  };
  expect_rows(Kind::cutting_plane, {{Mode::idle, nothing, Mode::idle},
                                    {Mode::idle, plane, Mode::explore},
                                    {Mode::idle, sphere, Mode::rotate},
                                    {Mode::idle, both, Mode::rotate},
                                    {Mode::explore, plane, Mode::explore},
                                    {Mode::explore, nothing, Mode::idle},
                                    {Mode::explore, both, Mode::rotate},
                                    {Mode::explore, with(plane, true, true), Mode::translate},
                                    {Mode::explore, with(both, true, true), Mode::translate},
                                    {Mode::translate, with(nothing, false, true, false, true), Mode::translate},
                                    {Mode::translate, with(both, false, true, false, true), Mode::translate},
                                    {Mode::translate, plane, Mode::explore},
                                    {Mode::translate, both, Mode::rotate},
                                    {Mode::translate, nothing, Mode::idle},
                                    {Mode::rotate, sphere, Mode::rotate},
                                    {Mode::rotate, plane, Mode::explore},
                                    {Mode::rotate, nothing, Mode::idle},
                                    {Mode::rotate, with(sphere, true, true), Mode::turn},
                                    {Mode::turn, with(nothing, false, true, false, true), Mode::turn},
                                    {Mode::turn, sphere, Mode::rotate},
                                    {Mode::turn, plane, Mode::explore},
                                    {Mode::turn, nothing, Mode::idle},
                                    // rotation on contact
                                    {Mode::idle, with(sphere, false, false, true), Mode::turn},
                                    {Mode::explore, with(both, false, false, true), Mode::turn},
                                    {Mode::turn, with(sphere, false, false, true), Mode::turn},
                                    {Mode::turn, with(plane, false, false, true), Mode::explore},
                                    {Mode::turn, with(nothing, false, false, true), Mode::idle},
                                    {Mode::turn, with(sphere, true, true, true), Mode::turn},
                                    {Mode::turn, with(nothing, false, true, true, true), Mode::turn},
                                    {Mode::translate, with(sphere, false, false, true), Mode::turn}});
}

TEST(WidgetMachine, EveryTransitionOfHandles) {
  const TransitionInput nothing, handle{.near_handle = true};
  TransitionInput press = handle, held{.button_down = true, .is_gripped = true}, down = handle;
  press.button_pressed = press.button_down = down.button_down = true;
  for (const Kind kind : {Kind::seed, Kind::rake, Kind::isolevel, Kind::box, Kind::ruler})
    expect_rows(kind, {{Mode::idle, nothing, Mode::idle},
                       {Mode::idle, handle, Mode::hover},
                       {Mode::hover, handle, Mode::hover},
                       {Mode::hover, nothing, Mode::idle},
                       {Mode::hover, press, Mode::drag},
                       {Mode::drag, held, Mode::drag},
                       {Mode::drag, handle, Mode::hover},
                       {Mode::drag, nothing, Mode::idle},
                       // no drag without a press event, or without hover before
                       {Mode::idle, press, Mode::hover},
                       {Mode::idle, down, Mode::hover},
                       {Mode::hover, down, Mode::hover}});
}

// Forbidden transitions, over all combinations of inputs.
TEST(WidgetMachine, ThereAreNoOtherTransitions) {
  for (unsigned bits = 0; bits < 128; ++bits) {
    const auto bit = [&](unsigned k) { return (bits >> k & 1) != 0; };
    const TransitionInput f{bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6)};
    if (f.button_pressed && !f.button_down) continue;
    for (const Mode from : kModes) {
      const Mode plane = next_mode(Kind::cutting_plane, from, f), seed = next_mode(Kind::seed, from, f);
      const auto implies = [](bool is, bool then) { EXPECT_TRUE(!is || then); };
      SCOPED_TRACE(word(f) + " from " + to_string(from));
      EXPECT_TRUE(plane != Mode::hover && plane != Mode::drag);
      EXPECT_TRUE(seed == Mode::idle || seed == Mode::hover || seed == Mode::drag);
      // A grab begins from its preceding mode, at a press.
      implies(plane == Mode::translate, (from == Mode::explore && f.button_pressed) || (from == Mode::translate && f.button_down));
      implies(plane == Mode::turn && !f.rotate_on_contact, (from == Mode::rotate || from == Mode::turn) && f.button_down);
      implies(plane == Mode::turn && !f.button_pressed && !f.is_gripped, f.rotate_on_contact && f.near_sphere);
      implies(seed == Mode::drag, (from == Mode::hover && f.button_pressed) || (from == Mode::drag && f.button_down));
      // A widget that is not near is not engaged.
      implies(plane == Mode::explore, f.near_plane && !f.near_sphere);
      implies(plane == Mode::rotate, f.near_sphere && !f.rotate_on_contact);
      implies(seed == Mode::hover, f.near_handle);
    }
  }
}

Spec plane_spec() {
  Spec spec;
  spec.radius = 0.5;
  spec.snap = spec.grab_distance = spec.step = 0.08;
  spec.release = 0.2;
  return spec;
}
Spec seed_spec(const Vec3& at) {
  Spec spec;
  spec.kind = Kind::seed;
  spec.pose.points[0] = at;
  spec.grab_distance = 0.1;
  spec.step = 0.05;
  return spec;
}

struct Machine {
  std::vector<Spec> specs;
  std::vector<State> states;
  TickInput input;
  explicit Machine(std::vector<Spec> s) : specs(std::move(s)), states(specs.size()) {}
  int step(const Vec3& probe, std::uint32_t buttons = 0, bool back = false) {
    input.last_probe = input.probe;
    input.last_buttons = input.buttons;
    input.probe = probe;
    input.buttons = buttons;
    input.probe_returned = back;
    return step_modes(specs, states, input);
  }
  std::string modes() const {
    std::string out;
    for (const State& s : states) out += std::string(out.empty() ? "" : " ") + to_string(s.mode);
    return out;
  }
};

TEST(WidgetMachine, ExploreBeginsAtSnapAndEndsAtRelease) {
  Machine m({plane_spec()});
  EXPECT_EQ(m.step({2, 0, 0.0801}), -1);
  EXPECT_EQ(m.step({2, 0, 0.0799}), 0);
  EXPECT_EQ(m.modes(), "explore");
  EXPECT_EQ(m.step({2, 0, 0.1999}), 0);
  EXPECT_EQ(m.step({2, 0, 0.2001}), -1);
  EXPECT_EQ(m.step({2, 0, 0.1999}), -1);
}

TEST(WidgetMachine, OnlyOneWidgetIsEngagedAndHandlesPrecedeSpheresAndPlanes) {
  Machine m({plane_spec(), seed_spec({0.5, 0, 0}), seed_spec({2, 0, 0}), seed_spec({2.1, 0, 0})});
  m.step({1, 0, 0});
  EXPECT_EQ(m.modes(), "explore away away away");
  m.step({0, 0.5, 0});
  EXPECT_EQ(m.modes(), "rotate away away away");
  m.step({0.5, 0, 0});
  EXPECT_EQ(m.modes(), "away hover away away");
  // Of two handles, the engaged one keeps the probe.
  m.step({2, 0, 0});
  EXPECT_EQ(m.modes(), "away away hover away");
  m.step({2.08, 0, 0});
  EXPECT_EQ(m.modes(), "away away hover away");
  m.step({2.12, 0, 0});
  EXPECT_EQ(m.modes(), "away away away hover");
  // Of handles that are newly in range, the nearest is engaged.
  m.step({9, 9, 9});
  m.step({2.06, 0, 0});
  EXPECT_EQ(m.modes(), "away away away hover");
}

TEST(WidgetMachine, AGrabExcludesAllOtherWidgets) {
  Machine m({plane_spec(), seed_spec({1, 0, 0})});
  m.step({2, 0, 0});
  m.step({2, 0, 0}, 1);
  EXPECT_EQ(m.modes(), "translate away");
  m.step({1, 0, 0}, 1);
  EXPECT_EQ(m.modes(), "translate away");
  m.step({1, 0, 0}, 0);
  EXPECT_EQ(m.modes(), "away hover");
}

TEST(WidgetMachine, APressCountsOnlyAsAnEventOfTheWidgetsButtonInTheMode) {
  Spec spec = plane_spec();
  spec.button = 32;
  const std::uint32_t bit = 1u << 31;
  Machine m({spec});
  m.step({2, 0, 1}, bit);
  m.step({2, 0, 0}, bit);  // pressed before entering
  EXPECT_EQ(m.modes(), "explore");
  m.step({2, 0, 0}, bit);
  EXPECT_EQ(m.modes(), "explore");
  m.step({2, 0, 0}, 1);  // another button
  EXPECT_EQ(m.modes(), "explore");
  m.step({2, 0, 0}, bit | 1);
  EXPECT_EQ(m.modes(), "translate");
  m.step({2, 0, 0}, bit);
  EXPECT_EQ(m.modes(), "translate");
  m.step({2, 0, 0}, 1);
  EXPECT_EQ(m.modes(), "explore");
}

TEST(WidgetMachine, APressOnTheReturnOfTheProbeDoesNotCount) {
  Machine m({plane_spec()});
  m.step({2, 0, 0});
  m.step({2, 0, 0}, 1, true);
  EXPECT_EQ(m.modes(), "explore");
  m.step({2, 0, 0}, 0);
  m.step({2, 0, 0}, 1);
  EXPECT_EQ(m.modes(), "translate");
  m.step({5, 5, 5}, 1, true);
  EXPECT_EQ(m.modes(), "translate");
  EXPECT_EQ(m.states[0].grip.grab_point, Vec3(5, 5, 5));
  m.step({5, 5, 5}, 0, true);
  EXPECT_EQ(m.modes(), "away");
}

TEST(WidgetMachine, StartsWithTheExactPoseAndRevision) {
  Spec spec = plane_spec();
  spec.revision = 7;
  spec.pose.orientation = normalized(Quat(0.3, -0.5, 0.2, 0.9));
  spec.pose.points[0] = {0.1, 0.2, 0.3};
  State state;
  reset_state(spec, state);
  EXPECT_EQ(make_report(state).pose, spec.pose);
  EXPECT_EQ(make_report(state).revision, 7u);
  spec.pose.orientation = Quat(0, 0, 0, 0);
  reset_state(spec, state);
  EXPECT_EQ(state.pose.orientation, kIdentityRotation);
}

}  // namespace widget_state_machine_test
}  // namespace catena::widget
