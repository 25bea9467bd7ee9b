// SPDX-License-Identifier: MIT
/// Reads "time": the time step that a scene shows, and the playback rate.
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

const Table<TimeLine>& time_table() {
  static const auto table = [] {
    Table<TimeLine> t;
    t.bind(schema::integer("step", "", "Of all fields that have steps and state none of their own; beyond the last one the last.", 0,
                           1'000'000),
           &TimeLine::step);
    t.bind(schema::number("per_second", "1/s", "Steps that go by while they are played.").within(0.01, 1000), &TimeLine::steps_per_second);
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
  return {{"time", "Steps in time, of fields that have them.", schema::Section::Layout::object, time_table().keys()}, nullptr};
}

}  // namespace catena::scene
