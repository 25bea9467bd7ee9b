// SPDX-License-Identifier: MIT
// Recordings that begin and end while the servo runs.
#include <algorithm>

#include "tests/haptics/servo/log_fixture.h"

namespace catena::test::sink_swap_test {

std::uint64_t ticks_of(const Servo& servo) { return servo.stats().ticks; }

void run_to(PathDevice& device, const Servo& servo, std::uint64_t ticks) {
  device.allowed = ticks;
  while (ticks_of(servo) < ticks) std::this_thread::yield();
}

/// Swaps the sink while the servo runs on until the swap is done.
bool swap(PathDevice& device, Servo& servo, TickSink* sink) {
  std::atomic<bool> done{false};
  std::thread leader([&] {
    while (!done) {
      device.allowed.fetch_add(1);
      std::this_thread::yield();
    }
  });
  const bool free = servo.set_sink(sink, 20);
  done = true;
  leader.join();
  return free;
}

TEST(SinkSwap, ARecordingStartedMidRunReplaysExactly) {
  const test::TemporaryFolder folder;
  PathDevice device(test::adversarial_path(1000));
  std::uint64_t epoch = 1;
  std::shared_ptr<const HapticProgram> program = make_numbered_program(epoch);
  Servo servo(device, program, {.paced = false});
  EXPECT_TRUE(servo.start());
  for (int round = 0; round < 4; ++round) {
    run_to(device, servo, ticks_of(servo) + 700 + static_cast<std::uint64_t>(round));
    const std::string path = folder / "l.catlog";
    {
      auto writer = LogWriter::open(path, {}, {}, fast_flush());
      ASSERT_TRUE(writer) << writer.error().message;
      (*writer)->add_program(*program);
      ASSERT_TRUE(swap(device, servo, writer->get()));
      // program changes during the recording
      for (int k = 0; k < 3; ++k) {
        run_to(device, servo, ticks_of(servo) + 300);
        program = make_numbered_program(++epoch);
        (*writer)->add_program(*program);
        servo.set_program(program);
      }
      run_to(device, servo, ticks_of(servo) + 300);
      ASSERT_TRUE(swap(device, servo, nullptr));
      ASSERT_TRUE((*writer)->finish());
      EXPECT_EQ((*writer)->status().lost, 0u);
    }  // the writer is destroyed while the servo runs
    auto reader = LogReader::open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_GE(replay_numbered(*reader).stats.ticks, 1200u);
    EXPECT_GE(reader->state().tick, 700u);
    EXPECT_FALSE(reader->damaged()) << reader->end_summary();
    ASSERT_TRUE(reader->end());
  }
  device.allowed = ~std::uint64_t{0} >> 1;
  servo.stop();
}

TEST(SinkSwap, SwappingTimesOutWhenTheServoStandsStill) {
  struct Count final : TickSink {
    void put(const ProbeSample&, const HapticState&) noexcept override { ++ticks; }
    std::atomic<int> ticks{0};
  } first, second;
  PathDevice device(test::adversarial_path(10));
  Servo servo(device, make_numbered_program(1), {.paced = false, .sink = &first});
  EXPECT_TRUE(servo.start());
  run_to(device, servo, 5);
  // the servo blocks in its device after it may have checked the sink: one swap can succeed, a second one cannot
  EXPECT_FALSE(servo.set_sink(&second, 0.01) && servo.set_sink(&first, 0.01));
  run_to(device, servo, 50);
  device.allowed = ~std::uint64_t{0} >> 1;
  EXPECT_TRUE(servo.set_sink(nullptr, 20));
  const int seen = first.ticks + second.ticks;
  EXPECT_GE(seen, 50);
  servo.stop();
  EXPECT_EQ(first.ticks + second.ticks, seen);
  EXPECT_TRUE(servo.set_sink(&first)) << "nothing runs: at once";
}

TEST(SinkSwap, AStateOfAnotherLayoutIsReportedAndATruncatedOneIsDamaged) {
  ChainState state;
  state.ticks = 12;
  const std::string good = to_bytes(state);
  ASSERT_TRUE(parse_state(good));
  EXPECT_EQ(parse_state(good)->tick, 12u);
  EXPECT_TRUE(parse_state(good)->chain);
  std::string other = good;
  other[9] = static_cast<char>(other[9] ^ 1);  // in the layout hash
  ASSERT_TRUE(parse_state(other));
  EXPECT_FALSE(parse_state(other)->chain);
  EXPECT_FALSE(parse_state(good.substr(0, good.size() - 1)));
  state.ticks = 0;
  EXPECT_FALSE(parse_state(to_bytes(state))) << "the servo's beginning has no block";
}

TEST(SinkSwap, AnotherServoResumesFromTheChainState) {
  PathDevice device(test::adversarial_path(1000), 101);
  const auto program = make_numbered_program(1), next = make_numbered_program(4);
  Servo first(device, program, {.paced = false, .max_ticks = 100});
  run_to_end(first);
  Servo second(device, next, {.paced = false, .max_ticks = 1});
  second.resume_from(first);
  run_to_end(second);
  HapticState seen;
  ASSERT_TRUE(second.receive(seen));
  EXPECT_EQ(seen.tick, 101u);
  EXPECT_EQ(seen.program_epoch, 4u);
}

}  // namespace catena::test::sink_swap_test
