// SPDX-License-Identifier: MIT
/// The reader of recordings on arbitrary bytes: no crash, no large allocation, ticks in increasing order, complete blocks are read.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/fuzz/log_bytes.h"
#include "tests/support/recording_fixture.h"

namespace catena::log_fuzz_test {

using namespace haptics::log;

struct Counts {
  int opened = 0, clean = 0, damaged = 0, gaps = 0;
  std::uint64_t ticks = 0;
};

// Tick numbers are increasing and outside of reported gaps.
void read_through(std::string_view bytes, Counts& counts) {
  auto reader = LogReader::open(make_memory_source(bytes), "x.catlog");
  if (!reader) {
    test::expect_error_line(reader.error().message, "x.catlog: ", {}, std::string::npos, "");
    return;
  }
  ++counts.opened;
  std::uint64_t last = 0;
  std::size_t ticks = 0;
  for (LogEvent event = reader->next(); event != LogEvent::done; event = reader->next()) {
    if (event == LogEvent::gap) {
      EXPECT_EQ(reader->gap().first_tick, last + 1);
      EXPECT_GT(reader->gap().ticks, 0u);
      last += reader->gap().ticks;
      ++counts.gaps;
    }
    if (event == LogEvent::state) last = reader->state().tick;  // the recording begins mid-run
    EXPECT_LE(reader->program().links.size(), 8u);
    if (event != LogEvent::tick) continue;
    EXPECT_EQ(reader->tick().output.tick, ++last);
    EXPECT_EQ(static_cast<std::size_t>(reader->tick().output.link_count), reader->program().links.size());
    // the texts of a printed table
    EXPECT_NE(to_string(reader->tick().input.condition), nullptr);
    EXPECT_NE(to_string(reader->tick().output.force_state), nullptr);
    for (std::size_t i = 0; i < reader->program().links.size(); ++i) EXPECT_NE(to_string(reader->tick().output.links[i].status), nullptr);
    ++ticks;
  }
  EXPECT_EQ(reader->next(), LogEvent::done);
  EXPECT_EQ(reader->last_tick(), last);
  EXPECT_LE(ticks, bytes.size());
  EXPECT_FALSE(reader->end_summary().empty());
  counts.clean += reader->end().has_value();
  counts.damaged += reader->damaged();
  counts.ticks += ticks;
}

TEST(LogFuzz, TheSeedIsValid) {
  Counts counts;
  read_through(test::make_small_log(), counts);
  EXPECT_EQ(counts.clean, 1);
  EXPECT_EQ(counts.damaged, 0);
  EXPECT_EQ(counts.ticks, 60u);
}

TEST(LogFuzz, Mutations) {
  const std::string seed = test::make_small_log(52);
  test::FuzzInputs inputs(20000, 11);
  test::Random& random = inputs.random;
  Counts counts;
  while (inputs.next() && !HasFailure()) {
    std::string bytes = random.below(3) == 0 ? test::mutate(seed, random) : test::mutate_in_place(seed, random);
    if (random.below(2) == 0) test::rewrite_hashes(bytes);
    // a copy of the exact size, so that sanitizers detect reads past the end
    const std::vector<char> exact(bytes.begin(), bytes.end());
    read_through({exact.data(), exact.size()}, counts);
    if (HasFailure()) test::write_file("log_fuzz_failure.catlog", bytes);
  }
  const auto of_all = static_cast<std::int64_t>(inputs.count());
  EXPECT_GT(counts.opened, of_all / 4);
  EXPECT_LT(counts.opened, of_all);
  EXPECT_GT(counts.damaged, of_all / 20);
  EXPECT_GT(counts.clean, of_all / 20);
  EXPECT_GT(counts.gaps, 0);
}

TEST(LogFuzz, EveryByteFlip) {
  const std::string seed = test::make_small_log(45);
  Counts counts;
  for (std::size_t n = 0; n < seed.size() && !HasFailure(); ++n) {
    std::string bytes = seed;
    bytes[n] = static_cast<char>(bytes[n] ^ 0x41);
    if (n % 2 == 0) test::rewrite_hashes(bytes);
    read_through(bytes, counts);
  }
  EXPECT_GT(counts.damaged, 0);
}

TEST(LogFuzz, HostileLengthsAndMagicNumbersCostNoMoreThanTheFile) {
  const std::string seed = test::make_small_log();
  Counts counts;
  // magic numbers everywhere, each with valid hashes and the longest payload; then consecutive empty blocks
  for (const bool is_empty : {false, true}) {
    BlockHeader head;
    head.type = 3;
    head.length = is_empty ? 0 : kMaxPayload;
    if (is_empty) head.payload_hash = test::block_hash(nullptr, 0);
    std::string bytes = seed.substr(0, 400);
    for (std::uint64_t i = 0; i < 50000; ++i) {
      head.sequence = is_empty ? i : 1;
      head.header_hash = test::block_hash(reinterpret_cast<const char*>(&head), BlockHeader::kHashedBytes);
      bytes.append(reinterpret_cast<const char*>(&head), sizeof head);
    }
    read_through(bytes, counts);
  }
  std::string marks = seed.substr(0, 400);
  for (int i = 0; i < 300000; ++i) marks += "CBLK";
  read_through(marks, counts);
  EXPECT_EQ(counts.opened, 3);
  EXPECT_EQ(counts.clean, 0);
}

}  // namespace catena::log_fuzz_test
