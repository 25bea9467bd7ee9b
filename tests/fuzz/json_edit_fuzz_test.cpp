// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/base/json_edit.h"
#include "tests/fuzz/mutate.h"

namespace catena::json_edit_fuzz_test {

const std::string kText =
    "\xEF\xBB\xBF// a scene\r\n{\r\n  \"fields\": {\"a/b\": {\"file\": \"x.vdb\"}, \"~\": [] }, // two\r\n"
    "  \"list\": [1, /* one */ [2, 3], {\"k\": null} // end\r\n  ], \"e\": {},\r\n  \"last\":true\r\n}\r\n";

constexpr std::string_view kPointers[] = {"",         "/fields", "/fields/a~1b/file", "/fields/~0/-", "/list/0",  "/list/1/1", "/list/2/k",
                                          "/list/-",  "/list/3", "/e/new/0/deep/-",   "/last",        "/nothing", "/e",        "/list/1/-",
                                          "/fields/", "/-",      "/list/00",          "/last/x",      "list",     "/~"};
constexpr std::string_view kValues[] = {"1", "[[0.2, 0], [0.7, 0.1]]", "{\"a\": {}}", "\"//\"", "null // no", "", "[", "/* */ {} ", "nan"};

/// Checks that the result is JSON or an error in one line with its position.
bool check(const Result<std::string>& edited, const std::string& text) {
  if (edited) {
    EXPECT_TRUE(json::parse(*edited, "f.json")) << *edited << "\nfrom\n" << text;
  } else {
    test::expect_error_line(edited.error().message, "f.json:", text, std::string::npos);
  }
  return static_cast<bool>(edited);
}

TEST(JsonEditFuzz, AnyTextPointerAndValue) {
  const auto [done, inputs] = test::fuzz(30000, 5, [](test::Random& random, std::uint64_t) {
    const std::string text = random.below(3) == 0 ? kText : test::mutate(kText, random);
    std::string pointer(kPointers[random.below(std::size(kPointers))]), value(kValues[random.below(std::size(kValues))]);
    if (random.below(4) == 0) pointer = test::mutate(pointer, random);
    if (random.below(4) == 0) value = test::mutate(value, random);
    check(json::insert_item(text, "f.json", pointer, value), text);
    check(json::remove_value(text, "f.json", pointer), text);
    return check(json::set_value(text, "f.json", pointer, value), text);
  });
  EXPECT_GT(done, inputs / 20);
}

TEST(JsonEditFuzz, ManyEditsOfOneText) {
  test::Random random{6};
  std::string text = kText;
  int done = 0;
  for (int i = 0; i < 5000 && !HasFailure(); ++i) {
    const std::string pointer(kPointers[1 + random.below(std::size(kPointers) - 1)]);
    const auto edited = random.below(2) == 0 ? json::remove_value(text, "f.json", pointer)
                                             : json::set_value(text, "f.json", pointer, kValues[random.below(4)]);
    if (!check(edited, text)) continue;
    ++done;
    text = edited->size() > 4000 ? kText : *edited;
  }
  EXPECT_GT(done, 1000);
}

}  // namespace catena::json_edit_fuzz_test
