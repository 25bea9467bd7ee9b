// SPDX-License-Identifier: MIT
#include "engine/base/durable_append.h"

#include <gtest/gtest.h>

#include "tests/support/results.h"
#include "tests/support/support.h"

namespace durable_append_test {

using namespace catena;

TEST(DurableAppend, TheHeaderIsWrittenOnceBeforeTheRows) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "t.csv";
  ASSERT_TRUE(append_durably(path, "a,b\n", "1,2\n"));
  ASSERT_TRUE(append_durably(path, "a,b\n", "3,4\n"));
  EXPECT_EQ(test::read_file(path), "a,b\n1,2\n3,4\n");
}

TEST(DurableAppend, AWriteErrorIsOneLine) {
  const test::TemporaryFolder folder;
  for (const std::string& path : {std::string("/dev/full"), folder / "no/such.csv"})
    EXPECT_EQ(test::message_of(append_durably(path, "a\n", "1\n")).find(path + ": cannot write: "), 0u) << path;
}

}  // namespace durable_append_test
