// SPDX-License-Identifier: MIT
/// Libraries of the built programs: `catena` itself does not link OpenVDB.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/support.h"

namespace linked_libraries_test {

namespace test = catena::test;

/// True if a program contains "openvdb", case-insensitive, in its symbols or its list of libraries.
bool names_openvdb(const std::string& program) {
  std::string bytes = test::read_file(test::binary_dir() + "/" + program);
  EXPECT_GT(bytes.size(), 10000u) << program;
  std::transform(bytes.begin(), bytes.end(), bytes.begin(), [](unsigned char c) { return static_cast<char>(c | 0x20); });
  return bytes.find("openvdb") != std::string::npos;
}

TEST(LinkedLibraries, OnlyTheHelpersLinkOpenVdb) {
  EXPECT_TRUE(names_openvdb("catena-read"));
  EXPECT_TRUE(names_openvdb("catena-write"));
  EXPECT_FALSE(names_openvdb("catena"));
}

}  // namespace linked_libraries_test
