// SPDX-License-Identifier: MIT
#include "engine/base/text.h"

#include <gtest/gtest.h>

namespace catena {
namespace sanitize_for_terminal_test {

TEST(Printable, KeepsReadableText) {
  for (const char* text : {"", "density", "v [m/s]", "Druck \xc3\xa4\xc3\xb6", "\xe6\xb8\xa9\xe5\xba\xa6", "\xf0\x9f\xab\x80"})
    EXPECT_EQ(sanitize_for_terminal(text), text);
}

TEST(Printable, ReplacesControlCharacters) {
  EXPECT_EQ(sanitize_for_terminal("a\033[31mb"), "a?[31mb");
  EXPECT_EQ(sanitize_for_terminal("\033]0;title\007"), "?]0;title?");
  EXPECT_EQ(sanitize_for_terminal("a\r\nb\tc\x7f"), "a??b?c?");
  EXPECT_EQ(sanitize_for_terminal(std::string_view("a\0b", 3)), "a?b");
  // The same escape sequences as C1 control characters, and marks of bidirectional text.
  EXPECT_EQ(sanitize_for_terminal("\xc2\x9b"
                                  "31m"),
            "?31m");
  EXPECT_EQ(sanitize_for_terminal("a\xe2\x80\xae"
                                  "b"),
            "a?b");
  EXPECT_EQ(sanitize_for_terminal("\xe2\x80\xa8"), "?");
}

TEST(Printable, ReplacesInvalidUtf8) {
  EXPECT_EQ(sanitize_for_terminal("\x9b"
                                  "31m"),
            "?31m");
  EXPECT_EQ(sanitize_for_terminal("a\xc3"), "a?");
  EXPECT_EQ(sanitize_for_terminal("\xc0\x9b"), "??");            // an overlong encoding of an escape character
  EXPECT_EQ(sanitize_for_terminal("\xed\xa0\x80"), "???");       // a lone surrogate
  EXPECT_EQ(sanitize_for_terminal("\xf4\x90\x80\x80"), "????");  // beyond the last code point
  EXPECT_EQ(sanitize_for_terminal("\xff\xfe"), "??");
}

}  // namespace sanitize_for_terminal_test
}  // namespace catena
