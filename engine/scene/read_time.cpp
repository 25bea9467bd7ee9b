// SPDX-License-Identifier: MIT
/// Reads "time": the time step that a scene shows, and the playback rate.
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

const Table<TimeLine>& time_table() {
  static const auto table = [] {
    Table<TimeLine> t;
    t.bind(
        schema::integer("step", "",
                        "Time step of all data that have steps and do not specify their own; a step beyond the last one selects the last.",
                        0, 1'000'000),
        &TimeLine::step);
    t.bind(schema::vector("range", 2, "time", "Times of the first and the last step, of a scene without data that have steps."),
           &TimeLine::range);
    t.bind(schema::integer("steps", "", "Number of steps of `range`; the time is `t` in expressions.", 2, 1'000'000).with_default("none"),
           &TimeLine::steps);
    t.bind(schema::number("per_second", "1/s", "Playback rate in steps per second.").within(0.01, 1000), &TimeLine::steps_per_second);
    return t;
  }();
  return table;
}

}  // namespace

Outcome read_time(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "time"));
  return time_table().read(scene, node, scene.time);
}

Part time_part() {
  return {{"time", "Time step that is shown, and playback rate.", schema::Section::Layout::object, time_table().keys()}, nullptr};
}

}  // namespace catena::scene
