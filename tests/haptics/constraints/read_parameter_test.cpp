// SPDX-License-Identifier: MIT
#include "haptics/constraints/common/link_schema.h"

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::read_parameter_test {

Fields fields() {
  Fields made = scalars({{"ball", sampled_field("sphere", 33)}});
  for (const char* name : {"plane", "constant", "gaussian"}) made.named[name].scalar = analytic_field(name);
  made.named["circle"].vector = field::make_analytic("circle")->vector;
  made.named["swirl"].vector = field::sample_on_grid(*made.named["circle"].vector, 9, -2, 2);
  return made;
}

Result<Parameter> read(const std::string& value, json::NumberRange range = json::NumberRange::positive) {
  static const Fields all = fields();
  const auto node = json::parse("{\"type\": \"x\",\n\"threshold\": " + value + "}", "scene.json");
  if (!node) return node.error();
  return get_parameter(*node, "threshold", 9.0, range, all.context());
}

double at(const std::string& value, const Vec3& place) {
  const auto parameter = read(value);
  if (!parameter) {
    ADD_FAILURE() << parameter.error().message;
    return 0;
  }
  field::Cursor cursor;
  std::int32_t evaluations = 0;
  return parameter->at(place, cursor, evaluations);
}

TEST(ReadParameter, AcceptsANumberOrAMap) {
  EXPECT_EQ(at("0.25", {1, 2, 3}), 0.25);
  EXPECT_TRUE(read("0.25")->is_constant());
  EXPECT_DOUBLE_EQ(at(R"({"field": "plane", "map": [[0, 1], [2, 3]]})", {0, 0, 0.5}), 1.5);
  EXPECT_DOUBLE_EQ(at(R"({"field": "plane", "quantity": "gradient", "map": [[0, 1], [2, 3]]})", {0, 0, 0.5}), 2);
  EXPECT_DOUBLE_EQ(at(R"({"field": "circle", "map": [[0, 1], [2, 3]]})", {0.5, 0, 3}), 1.5);
  EXPECT_DOUBLE_EQ(at(R"({"field": "circle", "quantity": "magnitude", "map": [[0, 1], [2, 3]]})", {0.5, 0, 3}), 1.5);
  const Fields none;
  const auto node = json::parse("{}", "scene.json");
  EXPECT_EQ(get_parameter(*node, "threshold", 9.0, json::NumberRange::positive, none.context())->min(), 9);
}

TEST(ReadParameter, NormalizesByTheFieldsRange) {
  // the sampled |x| on -2..2: 0 .. sqrt 12; its maximum gradient is 1 (nearly, in the cells' centres), the maximum |v| 2 sqrt 2
  EXPECT_NEAR(at(R"({"field": "ball", "normalise": true, "map": [[0, 1], [1, 3]]})", {1.5, 0, 0}), 1 + 2 * 1.5 / std::sqrt(12.0), 1e-6);
  EXPECT_NEAR(at(R"({"field": "ball", "quantity": "gradient", "normalise": true, "map": [[0, 1], [1, 3]]})", {1.5, 0.7, 0.3}), 3, 2e-3);
  EXPECT_NEAR(at(R"({"field": "swirl", "normalise": true, "map": [[0, 1], [1, 3]]})", {1, 0, 0}), 1 + 2 / std::sqrt(8.0), 1e-6);
  EXPECT_NEAR(at(R"({"field": "gaussian", "normalise": true, "map": [[0, 1], [1, 3]]})", {0, 0, 0}), 3, 1e-14);
  EXPECT_EQ(at(R"({"field": "constant", "normalise": true, "map": [[0, 1], [1, 3]]})", {0, 0, 0}), 1);
  EXPECT_EQ(at(R"({"field": "constant", "quantity": "gradient", "normalise": true, "map": [[0, 1], [1, 3]]})", {0, 0, 0}), 1);
}

TEST(ReadParameter, OutsideDefaultsToTheFirstOutput) {
  EXPECT_EQ(at(R"({"field": "ball", "map": [[0, 1], [1, 3]]})", {5, 0, 0}), 1);
  EXPECT_EQ(at(R"({"field": "ball", "map": [[0, 1], [1, 3]], "outside": 2.5})", {5, 0, 0}), 2.5);
}

TEST(ReadParameter, ErrorsNameTheirLine) {
  const auto fails = [](const std::string& value, int line, std::initializer_list<const char*> parts) {
    const auto made = read(value);
    ASSERT_FALSE(made) << value;
    const std::string& message = made.error().message;
    EXPECT_EQ(message.rfind("scene.json:" + std::to_string(line) + ":", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
  };
  fails("-1", 2, {"\"threshold\" is -1", "> 0"});
  fails("\"soft\"", 2, {"threshold"});
  fails("[1]", 2, {"threshold"});
  fails("null", 2, {"threshold"});
  fails("{}", 2, {"field"});
  fails(R"({"field": "plane"})", 2, {"\"threshold\" has no \"map\""});
  fails("{\"field\":\n\"nowhere\", \"map\": [[0, 1]]}", 3, {"nowhere"});
  fails("{\"field\": \"plane\",\n\"map\": []}", 3, {"empty"});
  fails("{\"field\": \"plane\",\n\"map\": [[0, 1, 2]]}", 3, {"map"});
  fails("{\"field\": \"plane\",\n\"map\": 1}", 3, {"map"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1],\n[0, 2]]}", 3, {"do not increase", "> 0"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1],\n[1, 0]]}", 3, {"\"threshold\" is 0", "> 0"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"outside\": 0}", 3, {"\"outside\" is 0"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"quantity\": \"magnitude\"}", 3, {"scalar field", "\"value\" or \"gradient\""});
  fails("{\"field\": \"circle\", \"map\": [[0, 1]],\n\"quantity\": \"value\"}", 3, {"vector field", "\"magnitude\""});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"quantity\": \"curl\"}", 3, {"quantity"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"normalise\": 1}", 3, {"normalise"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"normalise\": true}", 3, {"no finite range"});
  fails("{\"field\": \"plane\", \"map\": [[0, 1]],\n\"normalize\": true}", 3, {"unknown key \"normalize\"", "normalise"});
}

TEST(ReadParameter, AReleaseFollowsAField) {
  // release at 0.1 + 0.2 z, with z of the proxy
  const auto plane = build(R"({"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [1, 0, 0],
      "release": {"field": "plane", "map": [[0, 0.1], [1, 0.3]]}})",
                           fields());
  Rig rig(plane);
  EXPECT_EQ(rig.tick({0.19, 0, 0.5}).status, LinkStatus::ok);
  EXPECT_DOUBLE_EQ(rig.state.limit, 0.2);
  EXPECT_EQ(rig.state.evaluations, 2);  // one in start, one in advance
  EXPECT_EQ(rig.tick({0.21, 0, 0.5}).status, LinkStatus::released);
  EXPECT_EQ(rig.state.evaluations, 1);
  Rig higher(plane);
  EXPECT_EQ(higher.tick({0.29, 0, 1}).status, LinkStatus::ok);
}

}  // namespace catena::haptics::tests::read_parameter_test
