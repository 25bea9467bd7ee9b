// SPDX-License-Identifier: MIT
/// What the built programs hold: `catena` has no way to read a .vdb file itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/support.h"

namespace programs_test {

namespace test = catena::test;

/// "openvdb" in any case: in symbols, in their names, in the list of libraries.
bool names_openvdb(const std::string& program) {
  std::string bytes = test::read_file(test::binary_dir() + "/" + program);
  EXPECT_GT(bytes.size(), 10000u) << program;
  std::transform(bytes.begin(), bytes.end(), bytes.begin(), [](unsigned char c) { return static_cast<char>(c | 0x20); });
  return bytes.find("openvdb") != std::string::npos;
}

TEST(LinkedLibraries, OnlyTheHelpersHoldOpenVdb) {
  EXPECT_TRUE(names_openvdb("catena-read"));
  EXPECT_TRUE(names_openvdb("catena-write"));
  EXPECT_FALSE(names_openvdb("catena"));
}

}  // namespace programs_test
