// SPDX-License-Identifier: MIT
#include "engine/base/json.h"

#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::json::json_test {

using test::expect_error;

Result<Node> parsed(std::string_view text) { return parse(text, "scene.json"); }

Node object_of(std::string_view text) { return test::value_of(parsed(text)); }

TEST(Json, ReadsEveryKindWithItsLine) {
  const Node root = object_of("\xEF\xBB\xBF// a comment\r\n{\"z\": 1.5,\r\n \"a\": [true, null, \"x\\n\"], /* two\n lines */\n\"o\": {}}");
  ASSERT_EQ(root.kind, Kind::object);
  EXPECT_EQ(root.line, 2);
  ASSERT_EQ(root.members.size(), 3u);
  EXPECT_EQ(root.members[0].first, "z");
  EXPECT_EQ(root.members[1].first, "a");
  EXPECT_EQ(root.members[0].second.number, 1.5);
  EXPECT_EQ(root.members[1].second.line, 3);
  EXPECT_EQ(root.members[2].second.line, 5);
  EXPECT_EQ(root.find("a")->items[2].string, "x\n");
  EXPECT_EQ(root.find("a")->items[0].label, "a[0]");
  EXPECT_TRUE(root.find("a")->items[1].is_null());
  EXPECT_EQ(root.find("nothing"), nullptr);
}

TEST(Json, CommentsAreAllowedWhereverBlanksAre) {
  const Node root =
      object_of("{\"chain\": [ // \"none\": [1]\n ], \"o\": { /* ] */ }, \"a\" /* : 0, */ : [1 /* , 2 */], \"s\": \"// /* no\"}");
  EXPECT_TRUE(root.find("chain")->items.empty());
  EXPECT_EQ(root.find("a")->items.size(), 1u);
  EXPECT_EQ(root.find("a")->line, 2);
  EXPECT_EQ(root.find("s")->string, "// /* no");
  EXPECT_FALSE(parse("[1 /* without an end ]", "f"));
  EXPECT_FALSE(parse("[1 / 2]", "f"));
}

TEST(Json, NumbersAreReadExactly) {
  const Node root = object_of("[0.1, -0, 1e-320, 12345678901234567890, -9007199254740993, 1.7976931348623157e308]");
  EXPECT_EQ(root.items[0].number, 0.1);
  EXPECT_TRUE(std::signbit(root.items[1].number));
  EXPECT_EQ(root.items[2].number, 1e-320);
  EXPECT_EQ(root.items[3].number, 12345678901234567890.0);
  EXPECT_EQ(root.items[4].number, -9007199254740993.0);
  EXPECT_EQ(root.items[5].number, 1.7976931348623157e308);
}

TEST(Json, BadNumbersAreErrors) {
  for (const std::string bad : {"1e999", "-1e999", "01", "1.", "-", "1e", "1-2", "0x10"})
    EXPECT_EQ(test::message_of(parsed("{\n\"a\": " + bad + "\n}")).find("scene.json:2:"), 0u) << bad;
  expect_error(parsed("{\n\"a\": 1e999}"), {"scene.json:2:", "1e999", "finite number"});
  expect_error(parsed("{\n\"a\": NaN}"), {"scene.json:2:", "expected"});
}

TEST(Json, InvalidTextIsAnErrorWithALine) {
  expect_error(parsed(""), {"scene.json:1:", "expected"});
  expect_error(parsed("{\"a\": 1"), {"scene.json:1:", "expected"});
  expect_error(parsed("{\"a\": 1,\n}"), {"scene.json:2:", "expected"});
  expect_error(parsed("{}\n{}"), {"scene.json:2:", "expected"});
  expect_error(parsed("{\n'a': 1}"), {"scene.json:2:", "expected"});
  expect_error(parsed(std::string("{\n\"a\": \"") + '\0' + "\"}"), {"scene.json:2:", "zero byte"});
  expect_error(parsed("{\"a\": 1,\n \"b\": {\"c\": 1,\n\n \"c\": 2}}"), {"scene.json:4:", "duplicate key \"c\"", "expected once"});
}

TEST(Json, DepthIsLimited) {
  EXPECT_TRUE(parse(std::string(64, '[') + std::string(64, ']'), "f"));
  expect_error(parsed("\n" + std::string(65, '[') + std::string(65, ']')), {"scene.json:2:", "64"});
  expect_error(parsed(std::string(2000000, '[')), {"scene.json:1:", "64"});
  EXPECT_TRUE(parse("[\"" + std::string(100, '[') + "\"] //" + std::string(100, '['), "f"));
}

TEST(Json, UnknownKeysNameTheKnownOnes) {
  const Node root = object_of("{\"coupling\": {\"damping\": 1,\n \"stifness\": 2}}");
  EXPECT_EQ(test::message_of(check_known_keys(*root.find("coupling"), {"stiffness", "damping"})),
            "scene.json:2: unknown key \"stifness\" in \"coupling\"; known: stiffness, damping (did you mean \"stiffness\"?)");
  EXPECT_TRUE(check_known_keys(*root.find("coupling"), {"stifness", "damping"}));
  expect_error(check_known_keys(object_of("{\"a\\nb\": 1}"), {"x"}), {"scene.json:1:", "a?b"});  // one line
}

TEST(Json, ReadersCheckKindAndRange) {
  const Node root =
      object_of("{\"n\": -1,\n\"s\": \"x\",\n\"v\": [1, 2],\n\"w\": [1, null, 3], \"ok\": [1, 2, 3], \"rows\": [[1, 2], [3]], \"i\": 2.5}");
  EXPECT_EQ(*require_number(root, "n"), -1);
  expect_error(require_number(root, "n", NumberRange::non_negative), {"scene.json:1:", "\"n\" is -1", ">= 0 was expected"});
  expect_error(get_number(root, "s", 0), {"scene.json:2:", "\"x\"", "finite number was expected"});
  expect_error(require_number(root, "gone"), {"scene.json:1:", "\"gone\" is missing", "expected"});
  EXPECT_EQ(*get_number(root, "gone", 7), 7);
  EXPECT_FALSE(get_optional_number(root, "gone")->has_value());
  expect_error(require_vec3(root, "v"), {"scene.json:3:", "array of 2", "three finite numbers"});
  expect_error(require_vec3(root, "w"), {"scene.json:4:", "null", "three finite numbers"});
  EXPECT_EQ(require_vec3(root, "ok")->z, 3);
  expect_error(as_rows(*root.find("rows"), "rows", 2), {"scene.json:4:", "rows of 2"});
  expect_error(get_integer(root, "i", 0, 1, 32), {"scene.json:4:", "from 1 to 32"});
  expect_error(get_choice(root, "s", 0, {"line", "vector"}), {"scene.json:2:", "line, vector"});
  expect_error(get_boolean(root, "s", true), {"scene.json:2:", "true or false"});
}

TEST(Json, UnreadableFilesAreRefused) {
  const test::TemporaryFolder folder;
  expect_error(read(folder / "none.json"), {"none.json", "No such file", "expected"});
  expect_error(read(folder.path()), {"is a folder", "expected"});
  test::write_file(folder / "a.json", "{}");
  EXPECT_TRUE(read(folder / "a.json"));
}

class JsonMemory : public testing::Test {
 protected:
  JsonMemory() { set_memory_limit(1000000); }
  ~JsonMemory() override { set_memory_limit(std::nullopt); }
};

// The memory of many small values, a hundred times the length of the text, must be counted.
TEST_F(JsonMemory, TheMemoryOfManyValuesIsCheckedBeforeParsing) {
  for (const std::string item : {"[]", "{}", "1", "\"\"", "null"}) {
    std::string text = "{\"x\": [" + item;
    for (int i = 0; i < 20000; ++i) text += "," + item;
    EXPECT_TRUE(test::fails(parsed(text + "]}"), "MB of memory, expected at most 1 MB")) << item;
  }
}

TEST_F(JsonMemory, OrdinaryTextsAreParsedAtAnyLimit) {
  const MemoryReservation held(1000000);
  std::string text = "{ // a comment, with [brackets], words: and \"strings\"\n";
  for (int i = 0; i < 200; ++i) text += "\"key" + std::to_string(i) + "\": [1, 2.5, {\"name\": \"a, [b] {c}\"}], /* [[[ */\n";
  EXPECT_TRUE(parsed(text + "\"last\": null}"));
}

// The label of an item must not contain the whole key.
TEST(Json, ALongKeyIsNotRepeatedInEachItem) {
  const auto node = test::value_of(parse("{\"" + std::string(1000000, 'k') + "\": [[1, 2], 3]}", "scene.json"));
  const Node& list = node.members[0].second;
  EXPECT_EQ(list.label.size(), 1000000u);
  EXPECT_EQ(list.items[1].label, std::string(24, 'k') + "[1]");
  EXPECT_LT(list.items[0].items[1].label.size(), 31u);
}

Result<Mat3> rotation(const std::string& text) {
  auto node = json::parse(text, "scene.json");
  if (!node) return node.error();
  return json::as_rotation(*node, "rotation");
}

TEST(JsonRotation, ReadsRowsNineNumbersOrAxisAndAngle) {
  const Mat3 expected(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));  // columns
  for (const char* text :
       {"[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", "[0, -1, 0, 1, 0, 0, 0, 0, 1]", R"({"axis": [0, 0, 3], "angle_deg": 90})"}) {
    const Mat3 made = test::value_of(rotation(text));
    for (int i = 0; i < 3; ++i) EXPECT_LE(norm(made[i] - expected[i]), 1e-16) << text;
  }
}

TEST(JsonRotation, RefusesInvalidRotations) {
  for (const char* text :
       {"[1, 0, 0]", "3", "[[1, 0, 0], [0, 1, 0]]", "[1, 0, 0, 0, 1, 0, 0, 0, -1]", "[1, 0, 0, 0, 1, 0, 0, 0, 1.1]",
        R"({"axis": [0, 0, 0], "angle_deg": 1})", R"({"axis": [0, 0, 1]})", R"({"axis": [0, 0, 1], "angle_deg": 1, "x": 1})"}) {
    EXPECT_EQ(test::message_of(rotation(text)).find("scene.json:1:"), 0u) << text;
  }
}

}  // namespace catena::json::json_test
