// SPDX-License-Identifier: MIT
#include "engine/base/triple_buffer.h"

#include <gtest/gtest.h>

#include <thread>

namespace triple_buffer_test {

struct Pair {
  std::uint64_t a = 0, b = 0, c[30] = {};
};

TEST(TripleBuffer, DeliversTheNewestValueExactlyOnce) {
  catena::TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.acquire());
  buffer.publish(1);
  buffer.publish(2);
  EXPECT_TRUE(buffer.acquire());
  EXPECT_EQ(buffer.front(), 2);
  EXPECT_FALSE(buffer.acquire());
  EXPECT_EQ(buffer.front(), 2);
}

TEST(TripleBuffer, ValuesAreNeverTornAndNeverGoBack) {
  catena::TripleBuffer<Pair> buffer;
  constexpr std::uint64_t kCount = 200000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kCount; ++i) {
      Pair& p = buffer.back();
      p.a = i;
      for (auto& c : p.c) c = i;
      p.b = i;
      buffer.publish();
    }
  });
  std::uint64_t last = 0;
  bool whole = true, forward = true;
  while (last < kCount) {
    if (!buffer.acquire()) continue;
    const Pair& p = buffer.front();
    for (const auto c : p.c) whole = whole && c == p.a;
    whole = whole && p.a == p.b;
    forward = forward && p.a > last;
    last = p.a;
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(forward);
}

}  // namespace triple_buffer_test
