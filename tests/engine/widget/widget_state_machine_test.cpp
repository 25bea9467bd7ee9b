// SPDX-License-Identifier: MIT
#include "engine/widget/state_machine.h"

#include <gtest/gtest.h>

namespace catena::widget::widget_state_machine_test {

constexpr Mode kModes[] = {Mode::idle, Mode::explore, Mode::translate, Mode::rotate, Mode::turn, Mode::hover, Mode::drag};

struct Row {
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

void expect_rows(Kind kind, Mode from, const std::vector<Row>& rows) {
  for (const Row& row : rows)
    EXPECT_EQ(to_string(next_mode(kind, from, row.facts)), std::string(to_string(row.to)))
        << "from " << to_string(from) << " with " << word(row.facts);
}

TEST(WidgetMachine, EveryTransitionOfACuttingPlane) {
  using enum Mode;
  const TransitionInput nothing, plane{.near_plane = true}, sphere{.near_sphere = true}, both{.near_sphere = true, .near_plane = true};
  const auto press = [](TransitionInput f) {
    f.button_pressed = f.button_down = true;
    return f;
  };
  const auto grip = [](TransitionInput f) {
    f.button_down = f.is_gripped = true;
    return f;
  };
  const auto touch = [](TransitionInput f) {
    f.rotate_on_contact = true;
    return f;
  };
  const Kind kind = Kind::cutting_plane;
  expect_rows(kind, idle, {{nothing, idle}, {plane, explore}, {sphere, rotate}, {both, rotate}});
  expect_rows(kind, explore, {{plane, explore}, {nothing, idle}, {both, rotate}, {press(plane), translate}, {press(both), translate}});
  expect_rows(kind, translate, {{grip(nothing), translate}, {grip(both), translate}, {plane, explore}, {both, rotate}, {nothing, idle}});
  expect_rows(kind, rotate, {{sphere, rotate}, {plane, explore}, {nothing, idle}, {press(sphere), turn}});
  expect_rows(kind, turn, {{grip(nothing), turn}, {sphere, rotate}, {plane, explore}, {nothing, idle}});
  // the arrow comes first
  const TransitionInput arrow{.near_handle = true, .near_sphere = true, .near_plane = true};
  expect_rows(kind, idle, {{arrow, hover}, {press(arrow), hover}});
  expect_rows(kind, explore, {{arrow, hover}, {press(arrow), translate}});
  expect_rows(kind, rotate, {{arrow, hover}, {press(arrow), turn}});
  expect_rows(kind, hover, {{arrow, hover}, {press(arrow), drag}, {sphere, rotate}, {plane, explore}, {nothing, idle}});
  expect_rows(kind, drag, {{grip(nothing), drag}, {arrow, hover}, {both, rotate}, {nothing, idle}});
  // rotation on contact
  expect_rows(kind, idle, {{touch(sphere), turn}});
  expect_rows(kind, explore, {{touch(both), turn}});
  expect_rows(kind, turn, {{touch(sphere), turn}, {touch(plane), explore}, {touch(nothing), idle}});
  expect_rows(kind, turn, {{touch(press(sphere)), turn}, {touch(grip(nothing)), turn}});
  expect_rows(kind, translate, {{touch(sphere), turn}});
}

TEST(WidgetMachine, EveryTransitionOfHandles) {
  using enum Mode;
  const TransitionInput nothing, near{.near_handle = true};
  TransitionInput press = near, held{.button_down = true, .is_gripped = true}, down = near;
  press.button_pressed = press.button_down = down.button_down = true;
  for (const Kind kind : {Kind::seed, Kind::rake, Kind::isolevel, Kind::box, Kind::ruler}) {
    expect_rows(kind, idle, {{nothing, idle}, {near, hover}});
    expect_rows(kind, hover, {{near, hover}, {nothing, idle}, {press, drag}});
    expect_rows(kind, drag, {{held, drag}, {near, hover}, {nothing, idle}});
    // no drag without a press event, or without hover before
    expect_rows(kind, idle, {{press, hover}, {down, hover}});
    expect_rows(kind, hover, {{down, hover}});
  }
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
      implies(plane == Mode::drag, (from == Mode::hover && f.button_pressed) || (from == Mode::drag && f.button_down));
      implies(plane == Mode::hover, f.near_handle);
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
  std::string modes_at(const Vec3& probe, std::uint32_t buttons = 0, bool back = false) {
    step(probe, buttons, back);
    return modes();
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

TEST(WidgetMachine, TheArrowMovesThePlaneAlongItsNormalOnly) {
  Machine m({plane_spec()});
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.07}), "explore") << "the plane comes first";
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.55}), "rotate") << "and the sphere";
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.81}), "away") << "beyond the tip";
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.3}), "hover") << "inside the sphere";
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.6}), "hover");
  const ChainRequest line = plan_chain(m.specs[0], m.states[0], {0.03, -0.02, 0.6});
  ASSERT_EQ(line.count, 2);
  EXPECT_EQ(line.shapes[0].normal, Vec3(1, 0, 0));
  EXPECT_EQ(line.shapes[1].normal, Vec3(0, 1, 0));
  EXPECT_EQ(m.modes_at({0.03, -0.02, 0.6}, 1), "drag");
  EXPECT_EQ(m.modes_at({0.5, 0.4, 0.9}, 1), "drag");
  const ChainRequest drag = plan_chain(m.specs[0], m.states[0], {0.5, 0.4, 0.9});
  ASSERT_EQ(drag.count, 2);
  EXPECT_TRUE(drag.disables_scene_links);
  EXPECT_EQ(drag.shapes[0].origin, Vec3(0.03, -0.02, 0.6));
  update_pose(m.specs[0], m.states[0], {0.03, -0.02, 0.9});
  EXPECT_EQ(m.states[0].pose.points[0].x, 0);
  EXPECT_EQ(m.states[0].pose.points[0].y, 0);
  EXPECT_NEAR(m.states[0].pose.points[0].z, 0.3, 1e-15);
  EXPECT_EQ(m.states[0].pose.orientation, kIdentityRotation);
}

TEST(WidgetMachine, OnlyOneWidgetIsEngagedAndHandlesPrecedeSpheresAndPlanes) {
  Machine m({plane_spec(), seed_spec({0.5, 0, 0}), seed_spec({2, 0, 0}), seed_spec({2.1, 0, 0})});
  EXPECT_EQ(m.modes_at({1, 0, 0}), "explore away away away");
  EXPECT_EQ(m.modes_at({0, 0.5, 0}), "rotate away away away");
  EXPECT_EQ(m.modes_at({0.5, 0, 0}), "away hover away away");
  // Of two handles, the engaged one keeps the probe.
  EXPECT_EQ(m.modes_at({2, 0, 0}), "away away hover away");
  EXPECT_EQ(m.modes_at({2.08, 0, 0}), "away away hover away");
  EXPECT_EQ(m.modes_at({2.12, 0, 0}), "away away away hover");
  // Of handles that are newly in range, the nearest is engaged.
  m.step({9, 9, 9});
  EXPECT_EQ(m.modes_at({2.06, 0, 0}), "away away away hover");
}

TEST(WidgetMachine, AGrabExcludesAllOtherWidgets) {
  Machine m({plane_spec(), seed_spec({1, 0, 0})});
  m.step({2, 0, 0});
  EXPECT_EQ(m.modes_at({2, 0, 0}, 1), "translate away");
  EXPECT_EQ(m.modes_at({1, 0, 0}, 1), "translate away");
  EXPECT_EQ(m.modes_at({1, 0, 0}, 0), "away hover");
}

TEST(WidgetMachine, APressCountsOnlyAsAnEventOfTheWidgetsButtonInTheMode) {
  Spec spec = plane_spec();
  spec.button = 32;
  const std::uint32_t bit = 1u << 31;
  Machine m({spec});
  m.step({2, 0, 1}, bit);
  EXPECT_EQ(m.modes_at({2, 0, 0}, bit), "explore");  // pressed before entering
  EXPECT_EQ(m.modes_at({2, 0, 0}, bit), "explore");
  EXPECT_EQ(m.modes_at({2, 0, 0}, 1), "explore");  // another button
  EXPECT_EQ(m.modes_at({2, 0, 0}, bit | 1), "translate");
  EXPECT_EQ(m.modes_at({2, 0, 0}, bit), "translate");
  EXPECT_EQ(m.modes_at({2, 0, 0}, 1), "explore");
}

TEST(WidgetMachine, APressOnTheReturnOfTheProbeDoesNotCount) {
  Machine m({plane_spec()});
  m.step({2, 0, 0});
  EXPECT_EQ(m.modes_at({2, 0, 0}, 1, true), "explore");
  m.step({2, 0, 0}, 0);
  EXPECT_EQ(m.modes_at({2, 0, 0}, 1), "translate");
  EXPECT_EQ(m.modes_at({5, 5, 5}, 1, true), "translate");
  EXPECT_EQ(m.states[0].grip.grab_point, Vec3(5, 5, 5));
  EXPECT_EQ(m.modes_at({5, 5, 5}, 0, true), "away");
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

}  // namespace catena::widget::widget_state_machine_test
