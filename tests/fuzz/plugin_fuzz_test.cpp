// SPDX-License-Identifier: MIT
/// Hostile plug-in files, before any of their code runs: the stated properties, or an error in one line.
#include <gtest/gtest.h>

#include <cstring>

#include "haptics/plugin/plugin_file.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/support/support.h"

namespace catena::plugin_fuzz_test {

namespace plugin = haptics::plugin;

const std::string& seed() {
  static const std::string bytes = test::read_file(test::binary_dir() + "/level_ball.so");
  return bytes;
}

/// Checks that texts are terminated for any bytes.
bool check(const std::string& bytes) {
  const auto file = plugin::read_file(bytes);
  if (!file) {
    test::expect_error_line(file.error().message, "", {}, std::string::npos, "was expected");
    return false;
  }
  EXPECT_LT(std::strlen(file->abi_stamp.headers), sizeof file->abi_stamp.headers);
  EXPECT_LT(std::strlen(file->abi_stamp.compiler), sizeof file->abi_stamp.compiler);
  return true;
}

TEST(PluginFuzz, AFileForAnotherProcessorIsRefused) {
  std::string bytes = seed();
  EXPECT_TRUE(check(bytes));
  bytes[18] = static_cast<char>(bytes[18] + 1);  // e_machine
  EXPECT_FALSE(check(bytes));
}

TEST(PluginFuzz, EveryTruncationAndByteFlipOfHeaderAndSections) {
  constexpr std::size_t kHead = 64;
  for (std::size_t n = 0; n <= kHead; ++n) EXPECT_FALSE(check(seed().substr(0, n)));
  for (std::size_t cut = 1; cut <= seed().size(); cut += 64) check(seed().substr(0, seed().size() - cut));
  for (std::size_t at = 0; at < kHead; ++at)
    for (const int turned : {0x01, 0x80, 0xff}) {
      std::string bytes = seed();
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(turned));
      check(bytes);
    }
}

TEST(PluginFuzz, Mutations) {
  // the section table is at the end of the file
  std::uint64_t sections = 0;
  ASSERT_GT(seed().size(), 64u);
  std::memcpy(&sections, seed().data() + 40, sizeof sections);
  test::fuzz(5000, 23, [&](test::Random& random, std::uint64_t n) {
    const bool head = n % 3 == 0;
    return check(test::mutate_bytes(seed(), random, 3, head ? 0 : sections, head ? 64 : seed().size()));
  });
}

}  // namespace catena::plugin_fuzz_test
