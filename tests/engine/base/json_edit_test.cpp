// SPDX-License-Identifier: MIT
#include "engine/base/json_edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "tests/support/results.h"

namespace catena::json::json_edit_test {

std::string text_of(const Result<std::string>& edited) { return edited ? *edited : edited.error().message; }
std::string set(std::string_view text, std::string_view pointer, std::string_view value) {
  return text_of(set_value(text, "f.json", pointer, value));
}
std::string insert(std::string_view text, std::string_view pointer, std::string_view value) {
  return text_of(insert_item(text, "f.json", pointer, value));
}
std::string removed(std::string_view text, std::string_view pointer) { return text_of(remove_value(text, "f.json", pointer)); }

TEST(JsonOffsets, AreTheByteRangesOfValues) {
  const std::string text =
      "\xEF\xBB\xBF// caf\xc3\xa9 /* \r\n{ /* \"no\" */ \"k\xc3\xa9y\": \"\xe2\x82\xac\\\"x\" , // {\r\n\"a\":[1e-3 /* ] */ ,-2, {} , "
      "true],\"n\"  :null}";
  const auto root = test::value_of(parse(text, "f"));
  const auto bytes = [&](const Node& node) { return text.substr(node.begin, node.end - node.begin); };
  EXPECT_EQ(root.end, text.size());
  EXPECT_EQ(text[root.begin], '{');
  EXPECT_EQ(bytes(root.members[0].second), "\"\xe2\x82\xac\\\"x\"");
  const Node& array = root.members[1].second;
  EXPECT_EQ(bytes(array), "[1e-3 /* ] */ ,-2, {} , true]");
  EXPECT_EQ(bytes(array.items[0]), "1e-3");
  EXPECT_EQ(bytes(array.items[1]), "-2");
  EXPECT_EQ(bytes(array.items[2]), "{}");
  EXPECT_EQ(bytes(array.items[3]), "true");
  EXPECT_EQ(bytes(root.members[2].second), "null");
}

TEST(JsonSet, ReplacesTheValueOnly) {
  EXPECT_EQ(set("{\"a\": 1, // one\n \"b\" : [ 1,2 ,3 ]}", "/b/1", "[4]"), "{\"a\": 1, // one\n \"b\" : [ 1,[4] ,3 ]}");
  EXPECT_EQ(set("\xEF\xBB\xBF{\"a\":\r\n  /* was */ \"x\" /* is */ }", "/a", "null"), "\xEF\xBB\xBF{\"a\":\r\n  /* was */ null /* is */ }");
  EXPECT_EQ(set("// c\n[1] // d", "", "{}"), "// c\n{} // d");
  EXPECT_EQ(set("{\"a/b\": {\"m~n\": 1}, \"\": 2}", "/a~1b/m~0n", "3"), "{\"a/b\": {\"m~n\": 3}, \"\": 2}");
  EXPECT_EQ(set("{\"\": 2}", "/", "3"), "{\"\": 3}");
  EXPECT_EQ(set("{\"0\": 2}", "/0", "3"), "{\"0\": 3}");
  EXPECT_EQ(set("{\"a\\u0062\\\"\": 2}", "/ab\"", "3"), "{\"a\\u0062\\\"\": 3}");
}

TEST(JsonSet, DropsCommentsAroundANewValue) {
  EXPECT_EQ(set("[1, 2]", "/0", " /* a */ 7 // b"), "[7, 2]");
  EXPECT_EQ(set("[1, 2]", "/0", "\xEF\xBB\xBF[8 /* kept */]\n"), "[[8 /* kept */], 2]");
}

TEST(JsonSet, AddsInTheExistingLayout) {
  EXPECT_EQ(set("{\"a\": 1}", "/b", "2"), "{\"a\": 1, \"b\": 2}");
  EXPECT_EQ(set("{\"a\":1,\"b\":2}", "/c", "3"), "{\"a\":1,\"b\":2,\"c\":3}");
  EXPECT_EQ(set("{ \"a\" : 1 }", "/b", "2"), "{ \"a\" : 1, \"b\" : 2 }");
  EXPECT_EQ(set("{\n  \"a\": 1\n}\n", "/b", "2"), "{\n  \"a\": 1,\n  \"b\": 2\n}\n");
  EXPECT_EQ(set("{\r\n\t\"a\": 1\r\n}", "/b", "2"), "{\r\n\t\"a\": 1,\r\n\t\"b\": 2\r\n}");
  EXPECT_EQ(set("{\r  \"a\": 1\r}", "/b", "2"), "{\r  \"a\": 1,\r  \"b\": 2\r}");
  EXPECT_EQ(set("{\"a\": 1,\n \"b\": 2}", "/c", "3"), "{\"a\": 1,\n \"b\": 2,\n \"c\": 3}");
  EXPECT_EQ(set("{\n  \"a\": [\n    1\n  ] }", "/b", "2"), "{\n  \"a\": [\n    1\n  ],\n  \"b\": 2 }");
  EXPECT_EQ(set("{\n \"a\" :\n  1\n}", "/b", "2"), "{\n \"a\" :\n  1,\n \"b\": 2\n}");
  EXPECT_EQ(set("[1,\n 2, 3]", "/-", "4"), "[1,\n 2, 3, 4]");
  EXPECT_EQ(set("[1,2]", "/2", "3"), "[1,2,3]");
  EXPECT_EQ(set("[[1], [2]]", "/1/-", "3"), "[[1], [2, 3]]");
}

TEST(JsonSet, AddsAfterTheCommentsOfTheLastLine) {
  EXPECT_EQ(set("{\n  \"a\": 1 // one\n  // end\n}", "/b", "2"), "{\n  \"a\": 1, // one\n  \"b\": 2\n  // end\n}");
  EXPECT_EQ(set("{\n  \"a\": 1 /* one */ // eins\n}", "/b", "2"), "{\n  \"a\": 1, /* one */ // eins\n  \"b\": 2\n}");
  EXPECT_EQ(set("[1 // one\n]", "/-", "2"), "[1, 2 // one\n]");
  EXPECT_EQ(set("[\n 1 /* a\n b */\n]", "/-", "2"), "[\n 1, /* a\n b */\n 2\n]");
}

TEST(JsonSet, AddsToEmptyContainers) {
  EXPECT_EQ(set("{}", "/a", "1"), "{\"a\": 1}");
  EXPECT_EQ(set("{ }", "/a", "1"), "{ \"a\": 1 }");
  EXPECT_EQ(set("[]", "/-", "1"), "[1]");
  EXPECT_EQ(set("[]", "/0", "1"), "[1]");
  EXPECT_EQ(set("{ /* none */ }", "/a", "1"), "{ /* none */ \"a\": 1 }");
  EXPECT_EQ(set("{ // none\n}", "/a", "1"), "{ // none\n  \"a\": 1\n}");
  EXPECT_EQ(set("[ // none\n]", "/-", "1"), "[ // none\n  1\n]");
  EXPECT_EQ(set("{\r\n}", "/a", "1"), "{\r\n  \"a\": 1\r\n}");
  EXPECT_EQ(set("{\n   \"w\": [\n   ]\n}", "/w/-", "1"), "{\n   \"w\": [\n      1\n   ]\n}");
}

TEST(JsonSet, AddsMissingParents) {
  EXPECT_EQ(set("{\n  \"a\": 1\n}", "/camera/position", "[1, 2, 3]"), "{\n  \"a\": 1,\n  \"camera\": {\"position\": [1, 2, 3]}\n}");
  EXPECT_EQ(set("{}", "/widgets/-", "{\"name\": \"w\"}"), "{\"widgets\": [{\"name\": \"w\"}]}");
  EXPECT_EQ(set("{}", "/a~1b/0/c\"d", "1"), "{\"a/b\": [{\"c\\\"d\": 1}]}");
  EXPECT_EQ(set("[[]]", "/0/-/x/-/-", "true"), "[[{\"x\": [[true]]}]]");
}

TEST(JsonInsert, PutsAnItemBeforeAnother) {
  EXPECT_EQ(insert("[1, 2]", "/0", "0"), "[0, 1, 2]");
  EXPECT_EQ(insert("[1, 2]", "/1", "0"), "[1, 0, 2]");
  EXPECT_EQ(insert("[1, 2]", "/2", "3"), "[1, 2, 3]");
  EXPECT_EQ(insert("[]", "/-", "3"), "[3]");
  EXPECT_EQ(insert("{\"a\": [\r\n    1, // one\r\n    2\r\n]}", "/a/1", "0"), "{\"a\": [\r\n    1, // one\r\n    0,\r\n    2\r\n]}");
  EXPECT_TRUE(test::has(insert("{\"a\": 1}", "/a", "0"), "f.json:1: \"/a\" is no item of an array"));
  EXPECT_TRUE(test::has(insert("{\"a\": 1}", "/b", "0"), "is no item of an array"));
}

TEST(JsonRemove, RemovesTheComma) {
  EXPECT_EQ(removed("[1, 2, 3]", "/0"), "[2, 3]");
  EXPECT_EQ(removed("[1, 2, 3]", "/1"), "[1, 3]");
  EXPECT_EQ(removed("[1, 2, 3]", "/2"), "[1, 2]");
  EXPECT_EQ(removed("[ 1 , 2 ]", "/0"), "[ 2 ]");
  EXPECT_EQ(removed("[ 1 , 2 ]", "/1"), "[ 1  ]");
  EXPECT_EQ(removed("{\"a\":1,\"b\":2}", "/a"), "{\"b\":2}");
  EXPECT_EQ(removed("{\"a\":1,\"b\":2}", "/b"), "{\"a\":1}");
  EXPECT_EQ(removed("{\"a\": {\"b\": 1}}", "/a/b"), "{\"a\": {}}");
  EXPECT_EQ(removed("[ [ 1 ] ]", "/0/0"), "[ [] ]");
  EXPECT_EQ(removed("{\n  \"a\": 1\n}", "/a"), "{}");
}

TEST(JsonRemove, RemovesTheLine) {
  const std::string text = "{\n  \"a\": 1,\n  \"b\": [\n    2\n  ],\n  \"c\": 3\n}\n";
  EXPECT_EQ(removed(text, "/a"), "{\n  \"b\": [\n    2\n  ],\n  \"c\": 3\n}\n");
  EXPECT_EQ(removed(text, "/b"), "{\n  \"a\": 1,\n  \"c\": 3\n}\n");
  EXPECT_EQ(removed(text, "/c"), "{\n  \"a\": 1,\n  \"b\": [\n    2\n  ]\n}\n");
  EXPECT_EQ(removed("[\r\n  1,\r\n  2\r\n]", "/0"), "[\r\n  2\r\n]");
  EXPECT_EQ(removed("[1, 2,\n 3]", "/1"), "[1,\n 3]");
  EXPECT_EQ(removed("[\n 1, 2,\n 3]", "/0"), "[\n 2,\n 3]");
  EXPECT_EQ(removed("{\"a\": 1,\n \"b\": 2}", "/a"), "{\"b\": 2}");
}

TEST(JsonRemove, KeepsTheCommentsAroundTheValue) {
  const std::string text = "{\n  // first\n  \"a\": 1, // one\n  \"b\": 2 /* two */, // zwei\n  \"c\": 3 // three\n}";
  EXPECT_EQ(removed(text, "/a"), "{\n  // first\n  // one\n  \"b\": 2 /* two */, // zwei\n  \"c\": 3 // three\n}");
  EXPECT_EQ(removed(text, "/b"), "{\n  // first\n  \"a\": 1, // one\n  /* two */ // zwei\n  \"c\": 3 // three\n}");
  EXPECT_EQ(removed(text, "/c"), "{\n  // first\n  \"a\": 1, // one\n  \"b\": 2 /* two */ // zwei\n  // three\n}");
  EXPECT_EQ(removed("{ // none\n  \"a\": 1\n}", "/a"), "{ // none\n}");
  EXPECT_EQ(removed("[/* x */ 1 /* y */]", "/0"), "[/* x */ /* y */]");
  EXPECT_EQ(removed("[ // none\n  1\n]", "/0"), "[ // none\n]");
  EXPECT_EQ(removed("[1 // one\n, 2]", "/1"), "[1 // one\n]");
  EXPECT_EQ(removed("[1 // one\n, 2]", "/0"), "[// one\n 2]");
}

TEST(JsonEdit, ErrorsNameThePositionAndTheExpectation) {
  const std::string text = "{\n \"a\": [1],\n \"b\": 2}";
  const auto refused = [](const std::string& message, const char* start, const char* part) {
    EXPECT_TRUE(message.starts_with(start)) << message;
    for (const char* words : {part, "expected"}) EXPECT_TRUE(test::has(message, words));
  };
  refused(set(text, "/b/c", "1"), "f.json:3: ", "holds nothing");
  refused(set(text, "/a/2", "1"), "f.json:2: ", "\"2\" is no item");
  refused(set(text, "/a/01", "1"), "f.json:2: ", "\"01\" is no item");
  refused(set(text, "/a/x", "1"), "f.json:2: ", "\"x\" is no item");
  refused(set(text, "/a/99999999999999999999", "1"), "f.json:2: ", "is no item");
  refused(set(text, "b", "1"), "f.json:1: ", "is no place");
  refused(set(text, "/b~2", "1"), "f.json:1: ", "is no place");
  refused(set(text, "/b~", "1"), "f.json:1: ", "is no place");
  for (const char* bad : {"", "1 2", "{", "nan", "1, \"c\": 2", "// 1", "1]"}) refused(set(text, "/b", bad), "f.json:1: ", "is not JSON");
  refused(set("{", "/b", "1"), "f.json:1: ", "is not valid JSON");
  refused(removed(text, "/c"), "f.json:1: ", "is not there");
  refused(removed(text, "/a/-"), "f.json:2: ", "is not there");
  refused(removed(text, ""), "f.json:1: ", "is not there");
  refused(set("[" + std::string(62, '[') + std::string(62, ']') + "]", "/-", "[[" + std::string(62, '[') + std::string(62, ']') + "]]"),
          "f.json:1: ", "nests too deep");
}

TEST(JsonText, WrittenValuesReadBackExactly) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const auto read = parse(serialize_number(value), "f");
    ASSERT_TRUE(read) << serialize_number(value);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read->number), std::bit_cast<std::uint64_t>(value)) << serialize_number(value);
  }
  EXPECT_EQ(serialize_number(0.1), "0.1");
  EXPECT_EQ(serialize_number(3), "3");
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  const auto read = test::value_of(parse(serialize_string(all), "f"));
  EXPECT_EQ(read.string, all);
}

// Random edits of any layout: the text changes as the tree does.
using Random = std::mt19937_64;
std::size_t below(Random& random, std::size_t n) { return static_cast<std::size_t>(random() % n); }

Node random_tree(Random& random, int depth) {
  Node node;
  const std::size_t kind = below(random, depth > 0 ? 6 : 4);
  node.kind = std::array{Kind::null, Kind::boolean, Kind::number, Kind::string, Kind::array, Kind::object}[kind];
  if (node.kind == Kind::boolean) node.boolean = below(random, 2) != 0;
  if (node.kind == Kind::number) node.number = static_cast<double>(below(random, 2000)) / 8 - 100;
  if (node.kind == Kind::string) node.string = std::array{"", "a", "// no", "\"]},", "\xe2\x82\xac/*"}[below(random, 5)];
  const std::size_t children = below(random, 4);
  for (std::size_t i = 0; node.kind == Kind::array && i < children; ++i) node.items.push_back(random_tree(random, depth - 1));
  for (std::size_t i = 0; node.kind == Kind::object && i < children; ++i)
    node.members.emplace_back(std::array{"a", "b/c", "~", "\"", ""}[below(random, 5)] + std::to_string(i), random_tree(random, depth - 1));
  return node;
}

/// Random blanks, line ends and comments.
std::string random_space(Random& random, bool comments, const std::string& line_end) {
  std::string out;
  for (std::size_t i = below(random, 3); i > 0; --i) {
    const std::size_t kind = below(random, comments ? 7 : 4);
    const std::string number = kind < 4 ? "" : "#" + std::to_string(random() % 1000000);
    const std::string comment[] = {"// , ] \" " + number + line_end, "/* } " + number + " */", "/* " + number + line_end + " ** */ "};
    out += kind == 0 ? line_end + "  " : kind == 1 ? line_end : kind < 4 ? " " : comment[kind - 4];
  }
  return out;
}

std::string random_text(const Node& node, Random& random, const std::string& line_end) {
  const auto space = [&](bool comments = true) { return random_space(random, comments, line_end); };
  if (node.kind == Kind::null) return "null";
  if (node.kind == Kind::boolean) return node.boolean ? "true" : "false";
  if (node.kind == Kind::number) return serialize_number(node.number);
  if (node.kind == Kind::string) return serialize_string(node.string);
  const bool list = node.kind == Kind::array;
  std::string out = list ? "[" : "{";
  if (node.items.empty() && node.members.empty()) out += space();
  for (const Node& item : node.items) out += (out.size() == 1 ? "" : ",") + space() + random_text(item, random, line_end) + space();
  for (const auto& [key, member] : node.members)
    out += (out.size() == 1 ? "" : ",") + space() + serialize_string(key) + space(false) + ":" + space() +
           random_text(member, random, line_end) + space();
  return out + (list ? "]" : "}");
}

/// The pointers to all values except the root.
void all_places(const Node& node, std::string pointer, std::vector<std::string>& places) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    places.push_back(pointer + "/" + std::to_string(i));
    all_places(node.items[i], places.back(), places);
  }
  for (const auto& [key, member] : node.members) {
    places.push_back(pointer + "/" + escape_pointer_token(key));
    all_places(member, places.back(), places);
  }
}

Node* found(Node& root, const std::string& pointer) { return const_cast<Node*>(find_value(root, pointer)); }

void erase(Node& root, const std::string& pointer) {
  Node& parent = *found(root, pointer.substr(0, pointer.rfind('/')));
  Node* child = found(root, pointer);
  std::erase_if(parent.members, [&](const auto& m) { return &m.second == child; });
  if (!parent.items.empty()) parent.items.erase(parent.items.begin() + (child - parent.items.data()));
}

/// The text without blanks, line ends and commas.
std::string bare(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::string_view(" \t\r\n,").find(c) == std::string_view::npos) out += c;
  return out;
}

class JsonLayout : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(JsonEdit, JsonLayout, testing::Values("\n", "\r\n", "\r"));

TEST_P(JsonLayout, EditsOfTheTextEqualEditsOfTheTree) {
  Random random(11);
  int sets = 0, adds = 0, removals = 0;
  for (int round = 0; round < 3000 && !HasFailure(); ++round) {
    Node tree;
    while (tree.items.empty() && tree.members.empty()) tree = random_tree(random, 4);
    const std::string bom = below(random, 4) == 0 ? "\xEF\xBB\xBF" : "";
    const std::string text =
        bom + random_space(random, true, GetParam()) + random_text(tree, random, GetParam()) + random_space(random, true, GetParam());
    ASSERT_TRUE(parse(text, "f")) << parse(text, "f").error().message << "\n" << text;
    ASSERT_TRUE(is_equal_value(*parse(text, "f"), tree)) << text;
    std::vector<std::string> places;
    all_places(tree, "", places);
    const Node value = random_tree(random, 2);
    const std::string put = random_text(value, random, GetParam());
    const std::string place = places[below(random, places.size())];
    const auto before = *parse(text, "f");
    const Node& at = *find_value(before, place);
    const std::size_t action = below(random, 3);
    if (action == 1 && at.kind != Kind::array && at.kind != Kind::object) continue;
    const auto edited = action == 0   ? set_value(text, "f", place, put)
                        : action == 1 ? set_value(text, "f", place + (at.kind == Kind::array ? "/-" : "/new~1key"), put)
                                      : remove_value(text, "f", place);
    ASSERT_TRUE(edited) << edited.error().message << "\n" << text;
    if (action == 0) {
      EXPECT_EQ(*edited, text.substr(0, at.begin) + put + text.substr(at.end));
      *found(tree, place) = value;
      ++sets;
    } else if (action == 1) {
      if (at.kind == Kind::array)
        found(tree, place)->items.push_back(value);
      else
        found(tree, place)->members.emplace_back("new/key", value);
      // The text of the container with an inserted value.
      EXPECT_EQ(edited->substr(0, at.begin), text.substr(0, at.begin));
      EXPECT_TRUE(edited->ends_with(text.substr(at.end - 1)));
      ASSERT_NE(edited->find(put, at.begin), std::string::npos);
      ++adds;
    } else {
      const Node& parent = *find_value(before, place.substr(0, place.rfind('/')));
      erase(tree, place);
      EXPECT_EQ(edited->substr(0, parent.begin), text.substr(0, parent.begin));
      EXPECT_TRUE(edited->ends_with(text.substr(parent.end)));
      if (parent.items.size() != 1) {
        // Only the member is removed, with blanks and commas.
        const std::string left = bare(*edited), tail = bare(text.substr(at.end)), head = bare(text.substr(0, at.begin));
        ASSERT_TRUE(left.ends_with(tail)) << text << "\n---\n" << *edited;
        const std::string head_left = left.substr(0, left.size() - tail.size());
        ASSERT_TRUE(head.starts_with(head_left)) << text << "\n---\n" << *edited;
        const auto member = std::ranges::find_if(parent.members, [&](const auto& m) { return &m.second == &at; });
        const std::string gone = member == parent.members.end() ? "" : bare(serialize_string(member->first)) + ":";
        EXPECT_TRUE(gone.empty() ? head_left == head : head.substr(head_left.size()).starts_with(gone)) << text << "\n---\n" << *edited;
      }
      ++removals;
    }
    const auto after = parse(*edited, "f");
    ASSERT_TRUE(after) << after.error().message << "\n" << *edited;
    EXPECT_TRUE(is_equal_value(*after, tree)) << place << "\n" << text << "\n---\n" << *edited;
  }
  EXPECT_GT(sets, 300);
  EXPECT_GT(adds, 100);
  EXPECT_GT(removals, 300);
}

}  // namespace catena::json::json_edit_test
