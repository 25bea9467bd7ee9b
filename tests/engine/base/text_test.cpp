// SPDX-License-Identifier: MIT
#include "engine/base/text.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::text_test {

std::uint64_t peak_bytes() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<std::uint64_t>(used.ru_maxrss) << 10;
}

std::string why_not(const std::string& path, std::uint64_t most = kMaxTextBytes) {
  const auto text = read_text_file(path, "a list", most);
  return text ? "read" : text.error().message;
}

TEST(ReadText, ReadsRegularFilesAndLinksToThem) {
  const test::TemporaryFolder folder;
  std::string text(200000, 'x');
  text[1] = '\0';
  test::write_file(folder / "a", text);
  std::filesystem::create_symlink("a", folder / "link");
  EXPECT_EQ(read_text_file(folder / "a", "a list").value(), text);
  EXPECT_EQ(read_text_file(folder / "link", "a list").value(), text);
  test::write_file(folder / "empty", "");
  EXPECT_EQ(read_text_file(folder / "empty", "a list").value(), "");
  // A reported size of 0 is not trusted.
  EXPECT_TRUE(test::has(read_text_file("/proc/self/status", "a list").value(), "Pid:"));
}

TEST(ReadText, RefusesPipesDevicesSocketsAndFoldersWithoutBlocking) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder / "zero");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  (folder / "socket").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  for (const auto& [path, why] : {std::pair{folder / "pipe", "is a pipe"},
                                  {folder / "zero", "is a device"},
                                  {"/dev/zero", "is a device"},
                                  {folder / "socket", "is a socket or a device"},
                                  {folder.path(), "is a folder"},
                                  {folder / "none", "cannot be read: No such file or directory"}})
    EXPECT_EQ(why_not(path), path + ": " + why + "; a list was expected");
  ::close(socket);
}

TEST(ReadText, ASizeBeyondTheLimitIsRefusedBeforeAllocation) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "sparse";
  test::write_file(path, "x");
  ASSERT_EQ(::truncate(path.c_str(), off_t{1} << 40), 0);
  const std::uint64_t before = peak_bytes();
  EXPECT_EQ(why_not(path), path + ": is 1048576 MiB large; a list of at most 1024 MiB was expected");
  EXPECT_EQ(why_not(path, kMaxJsonBytes), path + ": is 1048576 MiB large; a list of at most 128 MiB was expected");
  EXPECT_LT(peak_bytes() - before, 64u << 20);
  test::write_file(folder / "short", "0123456789");
  EXPECT_EQ(why_not(folder / "short", 10), "read");
  EXPECT_EQ(why_not(folder / "short", 9), (folder / "short") + ": is 0 KiB large; a list of at most 0 KiB was expected");
}

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

}  // namespace catena::text_test
