// SPDX-License-Identifier: MIT
#include "engine/schema/renames.h"

#include <gtest/gtest.h>

namespace catena::schema {
namespace {

std::string upgraded(const std::string& text, FileKind kind = FileKind::scene) {
  const auto done = upgrade_names(text, "old.json", kind);
  return done ? done->text : done.error().message;
}

TEST(Renames, KeepsCommentsOrderAndLayout) {
  const std::string old = R"({ // a scene
  "chain": [ {"name": "a", "type": "point",
              /* leaving */ "indicate" /* how */ : {"cue":"detent", "at":0.2,
                "from": 0.5}, "on": {"button": 1}, "position": [0, 0, 0]},
             {"type": "gradient_force", "towards" : "low", "displacement": {"field": "f", "of": "gradient", "map": [[0, 1]]}} ],
  "indicator": {"field": "v", "ahead": true}, "meshes": [{"name": "on", "drawn": false}],
  "glyphs": [{"field": "v", "at": "tail", "on": {"box": {"lo": [0, 0, 0], "hi": [1, 1, 1]}}}], "labels": [{"at": [0, 0, 0]}] }
)";
  const std::string fresh = R"({ // a scene
  "chain": [ {"name": "a", "type": "point",
              /* leaving */ "release_cue" /* how */ : {"type":"detent", "distance":0.2,
                "onset": 0.5}, "active_when": {"button": 1}, "position": [0, 0, 0]},
             {"type": "gradient_force", "direction" : "down_gradient", "displacement": {"field": "f", "quantity": "gradient", "map": [[0, 1]]}} ],
  "indicator": {"field": "v", "anchor": "tail"}, "meshes": [{"name": "on", "visible": false}],
  "glyphs": [{"field": "v", "anchor": "tail", "on": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}], "labels": [{"at": [0, 0, 0]}] }
)";
  EXPECT_EQ(upgraded(old), fresh);
  EXPECT_EQ(upgraded(fresh), fresh);
}

TEST(Renames, DistributesAPlan) {
  EXPECT_EQ(upgraded(R"({ "plan": {"error": 2, "hand_time": 5}, "coupling": {"damping": 1} })"),
            R"({ "coupling": {"damping": 1, "max_tick_us": 5}, "quality": "error=2" })");
  EXPECT_EQ(upgraded(R"({"quality": "draft", "plan": {"time": 9, "hand_error": 1e-3}})"),
            R"({"quality": "draft", "coupling": {"max_proxy_error": 0.001}})");
  EXPECT_EQ(upgraded(R"({"plan": 7})"), "old.json:1: \"plan\" is 7; an object {...} was expected");
}

TEST(Renames, NestsColorScales) {
  EXPECT_EQ(upgraded(R"({"fields": {"arc_length": {}}, "meshes": [{"name": "m", "color_by": "speed", "transfer": "t.json"}],
  "streamlines": [{"color_by": "speed", "color": "magma", /* all */ "range": [0, 2], "field": "v"},
                  {"color_by": "arc_length"}, {"color_by": {"field": "s"}}]})"),
            R"({"fields": {"arc_length": {}}, "meshes": [{"name": "m", "color_by": {"field": "speed", "transfer": "t.json"}}],
  "streamlines": [{"color_by": {"quantity": "speed", "color": "magma", "range": [0, 2]}, /* all */ "field": "v"},
                  {"color_by": {"field": "arc_length"}}, {"color_by": {"field": "s"}}]})");
}

TEST(Renames, FindsScenesAndChainsInAStudy) {
  const auto study = [](const std::string& limit, const std::string& key, const std::string& link) {
    return R"({"tasks": [{"limits": {")" + limit + R"(": 1}, "scene": {"stereo": {")" + key + R"(": true}}}], "conditions": [{"chain": [)" +
           link + R"(]}, {"chain": {"t": [)" + link + "]}}]}";
  };
  EXPECT_EQ(upgraded(study("told_s", "swap", R"({"law": "printed", "on": {"button": 1}})"), FileKind::study),
            study("announced_limit_s", "swap_eyes", R"({"law": "as_published", "active_when": {"button": 1}})"));
}

TEST(Renames, RefusesAnOldNameInOneLineWithTheNewOne) {
  const auto root = json::parse("{\"fog\": {\"start\": 1,\n\"end\": 2}}", "fog.json");
  const Outcome names = check_names(*root, FileKind::scene);
  ASSERT_FALSE(names);
  EXPECT_EQ(names.error().message,
            "fog.json:1: \"start\" is now \"near\"; the new name was expected: `catena upgrade fog.json` replaces the old names");
  EXPECT_EQ(upgraded("{\"meshes\": [{\"drawn\": true,\n\"visible\": true}]}"),
            "old.json:1: \"drawn\" is now \"visible\", which is also present; one of them was expected");
  EXPECT_TRUE(check_names(*json::parse(R"({"labels": [{"at": 1}], "fields": {"on": {"file": "indicate"}}})", "a"), FileKind::scene));
}

TEST(Renames, KnowsOptions) {
  EXPECT_EQ(renamed_option("--full-screen"), "--fullscreen");
  EXPECT_EQ(renamed_option("--fullscreen"), "");
}

}  // namespace
}  // namespace catena::schema
