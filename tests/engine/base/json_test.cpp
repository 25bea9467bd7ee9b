// SPDX-License-Identifier: MIT
#include "engine/base/json.h"

#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "tests/support/support.h"

namespace catena::json {
namespace json_test {

std::string error_of(std::string_view text) {
  const auto result = parse(text, "scene.json");
  return result ? std::string("no error") : result.error().message;
}

Node object_of(std::string_view text) {
  auto result = parse(text, "scene.json");
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : Node{};
}

void expect_parts(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

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
  for (const char* bad : {"1e999", "-1e999", "01", "1.", "-", "1e", "1-2", "0x10"})
    EXPECT_EQ(error_of(std::string("{\n\"a\": ") + bad + "\n}").substr(0, 13), "scene.json:2:")
        << bad << " " << error_of(std::string("{\n\"a\": ") + bad + "\n}");
  expect_parts(error_of("{\n\"a\": 1e999}"), {"scene.json:2:", "1e999", "finite number"});
  expect_parts(error_of("{\n\"a\": NaN}"), {"scene.json:2:", "expected"});
}

TEST(Json, DuplicateKeysNameTheLineOfTheSecond) {
  expect_parts(error_of("{\"a\": 1,\n \"b\": {\"c\": 1,\n\n \"c\": 2}}"), {"scene.json:4:", "duplicate key \"c\"", "expected once"});
}

TEST(Json, InvalidTextIsAnErrorWithALine) {
  expect_parts(error_of(""), {"scene.json:1:", "expected"});
  expect_parts(error_of("{\"a\": 1"), {"scene.json:1:", "expected"});
  expect_parts(error_of("{\"a\": 1,\n}"), {"scene.json:2:", "expected"});
  expect_parts(error_of("{}\n{}"), {"scene.json:2:", "expected"});
  expect_parts(error_of("{\n'a': 1}"), {"scene.json:2:", "expected"});
  expect_parts(error_of(std::string("{\n\"a\": \"") + '\0' + "\"}"), {"scene.json:2:", "zero byte"});
}

TEST(Json, DepthIsLimited) {
  EXPECT_TRUE(parse(std::string(64, '[') + std::string(64, ']'), "f"));
  expect_parts(error_of("\n" + std::string(65, '[') + std::string(65, ']')), {"scene.json:2:", "64"});
  expect_parts(error_of(std::string(2000000, '[')), {"scene.json:1:", "64"});
  EXPECT_TRUE(parse("[\"" + std::string(100, '[') + "\"] //" + std::string(100, '['), "f"));
}

TEST(Json, UnknownKeysNameTheKnownOnes) {
  const Node root = object_of("{\"coupling\": {\"damping\": 1,\n \"stifness\": 2}}");
  const auto outcome = check_known_keys(*root.find("coupling"), {"stiffness", "damping"});
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().message,
            "scene.json:2: unknown key \"stifness\" in \"coupling\"; known: stiffness, damping (did you mean \"stiffness\"?)");
  EXPECT_TRUE(check_known_keys(*root.find("coupling"), {"stifness", "damping"}));
}

TEST(Json, MessagesStayOneLine) {
  const Node root = object_of("{\"a\\nb\": 1}");
  expect_parts(check_known_keys(root, {"x"}).error().message, {"scene.json:1:", "a?b"});
}

TEST(Json, ReadersCheckKindAndRange) {
  const Node root =
      object_of("{\"n\": -1,\n\"s\": \"x\",\n\"v\": [1, 2],\n\"w\": [1, null, 3], \"ok\": [1, 2, 3], \"rows\": [[1, 2], [3]], \"i\": 2.5}");
  EXPECT_EQ(*require_number(root, "n"), -1);
  expect_parts(require_number(root, "n", NumberRange::non_negative).error().message, {"scene.json:1:", "\"n\" is -1", ">= 0 was expected"});
  expect_parts(get_number(root, "s", 0).error().message, {"scene.json:2:", "\"x\"", "finite number was expected"});
  expect_parts(require_number(root, "gone").error().message, {"scene.json:1:", "\"gone\" is missing", "expected"});
  EXPECT_EQ(*get_number(root, "gone", 7), 7);
  EXPECT_FALSE(get_optional_number(root, "gone")->has_value());
  expect_parts(require_vec3(root, "v").error().message, {"scene.json:3:", "array of 2", "three finite numbers"});
  expect_parts(require_vec3(root, "w").error().message, {"scene.json:4:", "null", "three finite numbers"});
  EXPECT_EQ(require_vec3(root, "ok")->z, 3);
  expect_parts(as_rows(*root.find("rows"), "rows", 2).error().message, {"scene.json:4:", "rows of 2"});
  expect_parts(get_integer(root, "i", 0, 1, 32).error().message, {"scene.json:4:", "from 1 to 32"});
  expect_parts(get_choice(root, "s", 0, {"line", "vector"}).error().message, {"scene.json:2:", "line, vector"});
  expect_parts(get_boolean(root, "s", true).error().message, {"scene.json:2:", "true or false"});
}

TEST(Json, UnreadableFilesAreRefused) {
  const test::TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    const auto result = read(path);
    return result ? std::string() : result.error().message;
  };
  expect_parts(message(folder / "none.json"), {"none.json", "No such file", "expected"});
  expect_parts(message(folder.path()), {"is a folder", "expected"});
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
  for (const std::string& item : {std::string("[]"), std::string("{}"), std::string("1"), std::string("\"\""), std::string("null")}) {
    std::string text = "{\"x\": [" + item;
    for (int i = 0; i < 20000; ++i) text += "," + item;
    EXPECT_NE(error_of(text + "]}").find("MB of memory, expected at most 1 MB"), std::string::npos) << item;
  }
}

TEST_F(JsonMemory, OrdinaryTextsAreParsedAtAnyLimit) {
  const MemoryReservation held(1000000);
  std::string text = "{ // a comment, with [brackets], words: and \"strings\"\n";
  for (int i = 0; i < 200; ++i) text += "\"key" + std::to_string(i) + "\": [1, 2.5, {\"name\": \"a, [b] {c}\"}], /* [[[ */\n";
  EXPECT_EQ(error_of(text + "\"last\": null}"), "no error");
}

// The label of an item must not contain the whole key.
TEST(Json, ALongKeyIsNotRepeatedInEachItem) {
  const auto node = parse("{\"" + std::string(1000000, 'k') + "\": [[1, 2], 3]}", "scene.json");
  ASSERT_TRUE(node);
  const Node& list = node->members[0].second;
  EXPECT_EQ(list.label.size(), 1000000u);
  EXPECT_EQ(list.items[1].label, std::string(24, 'k') + "[1]");
  EXPECT_LT(list.items[0].items[1].label.size(), 31u);
}

}  // namespace json_test
}  // namespace catena::json
