// SPDX-License-Identifier: MIT
/// Latency T of a dependent load: the unit for comparing tick times between machines.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "engine/base/clock.h"

namespace catena::bench {

/// A pointer chase through 16 MB in lines of 64 bytes, each line once per round in random order. Median ns per load of nine rounds.
inline double load_latency_ns() {
  struct alignas(64) Line {
    std::uint32_t next;
  };
  constexpr std::size_t kLines = (16u << 20) / sizeof(Line);
  std::vector<std::uint32_t> order(kLines);
  std::iota(order.begin(), order.end(), 0u);
  std::uint64_t random = 1;
  for (std::size_t i = kLines - 1; i > 0; --i) {
    random = random * 6364136223846793005ull + 1442695040888963407ull;
    std::swap(order[i], order[(random >> 33) % (i + 1)]);
  }
  std::vector<Line> lines(kLines);
  for (std::size_t i = 0; i < kLines; ++i) lines[order[i]].next = order[(i + 1) % kLines];
  std::array<double, 9> rounds;
  volatile std::uint32_t end = 0;
  for (double& round : rounds) {
    const std::int64_t start = now_ns();
    std::uint32_t at = 0;
    for (std::size_t i = 0; i < kLines; ++i) at = lines[at].next;
    end = at;
    round = static_cast<double>(now_ns() - start) / kLines;
  }
  static_cast<void>(end);
  std::nth_element(rounds.begin(), rounds.begin() + 4, rounds.end());
  return rounds[4];
}

}  // namespace catena::bench
