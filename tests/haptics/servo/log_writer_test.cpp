// SPDX-License-Identifier: MIT
/// LogWriter with a slow or full disk, and with all its threads running.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "engine/base/memory_limit.h"
#include "tests/haptics/servo/log_fixture.h"

namespace catena::test::log_writer_test {

TEST(LogWriter, AFullRingLeavesAReportedGapThatStopsReplay) {
  const test::TemporaryFolder folder;
  const std::vector<ProgramChange> changes{{1, test::make_level_program(1, {"a"}), {}}};
  LogOptions options;
  options.ring_bytes = 32768;  // 87 ticks of one link
  options.flush_s = 1000;
  auto writer = LogWriter::open(folder / "l.catlog", {}, {}, options);
  test::record_ticks(**writer, changes, test::adversarial_path(1000));
  const LogStatus status = (*writer)->status();
  EXPECT_EQ(status.lost, 1000u - 87u);
  ASSERT_TRUE((*writer)->finish());
  const LogContents read = read_all(test::read_file(folder / "l.catlog"));
  ASSERT_EQ(read.gaps.size(), 1u);
  EXPECT_EQ(read.gaps[0].first_tick, 88u);
  EXPECT_EQ(read.gaps[0].ticks, 913u);
  EXPECT_EQ(read.gaps[0].cause, LogGap::Cause::overrun);
  EXPECT_TRUE(read.clean);
  EXPECT_FALSE(read.damaged);
  const LogReplay result = replay_of(LogReader::open(folder / "l.catlog"), changes);
  EXPECT_EQ(result.stats.ticks, 87u);
  EXPECT_EQ(result.differing, 0u);
  EXPECT_EQ(result.stop_reason, "ticks 88 to 1000 are lost: the disk was too slow");
}

// Simulates a full disk by a limit on the file size.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : ignored_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, ignored_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*ignored_)(int);
};

TEST(LogWriter, AFullDiskIsReportedInTheStatusAndOneErrorLine) {
  EXPECT_FALSE(LogWriter::open("/dev/full", {})) << "the header cannot be written";
  EXPECT_FALSE(LogWriter::open("/nowhere/at/all.catlog", {}));
  EXPECT_FALSE(LogWriter::open("", {}));
  const test::TemporaryFolder folder;
  {
    const SmallDisk disk(20000);
    auto writer = LogWriter::open(folder / "l.catlog", {}, {}, fast_flush());
    ASSERT_TRUE(writer);
    const std::vector<ProgramChange> changes{{1, test::make_level_program(1, {"a"}), {}}};
    (*writer)->add_program(*changes[0].program);
    test::run_ticks(changes, test::adversarial_path(400), [&](const ProbeSample& input, const HapticState& output) {
      (*writer)->put(input, output);
      if (output.tick % 20 != 0) return;
      while (!(*writer)->status().failed && (*writer)->status().ticks < output.tick) std::this_thread::yield();
    });
    const LogStatus status = (*writer)->status();
    EXPECT_TRUE(status.failed);
    EXPECT_GT(status.ticks, 0u);
    EXPECT_EQ(status.ticks + status.lost, 400u);
    expect_error((*writer)->finish(),
                 {"l.catlog: cannot write: File too large", "; the recording ends with tick " + std::to_string(status.ticks) + " of 400"});
  }
  // complete blocks can be read
  const LogContents read = read_all(test::read_file(folder / "l.catlog"));
  EXPECT_GE(read.ticks.size(), 20u);
  EXPECT_LT(read.ticks.size(), 400u);
  EXPECT_TRUE(rising_from_one(read.ticks));
  EXPECT_FALSE(read.clean);
}

TEST(LogWriter, WithoutRoomForTheHeaderNoFileIsLeft) {
  const test::TemporaryFolder folder;
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{8}, rlim_t{16}, rlim_t{60}}) {
    const SmallDisk disk(bytes);
    EXPECT_FALSE(LogWriter::open(folder / "l.catlog", {}));
    EXPECT_FALSE(test::exists(folder / "l.catlog")) << bytes;
  }
  EXPECT_TRUE(test::exists("/dev/full")) << "a device is not removed";
}

TEST(LogWriter, ReplacesAFileUnlessItIsAnInputOrBeingRecorded) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "l.catlog", std::string(100000, 'x'));
  auto first = LogWriter::open(folder / "l.catlog", {});
  ASSERT_TRUE(first);
  EXPECT_TRUE(fails(LogWriter::open(folder / "l.catlog", {}), "another program is recording"));
  test::record_ticks(**first, {{1, test::make_level_program(1, {"a"}), {}}}, test::adversarial_path(10));
  ASSERT_TRUE((*first)->finish());
  EXPECT_TRUE(read_all(test::read_file(folder / "l.catlog")).clean);
  test::write_file(folder / "scene.json", "{}");
  EXPECT_FALSE(LogWriter::open(folder / "scene.json", {}, {folder / "scene.json"}));
  EXPECT_EQ(test::read_file(folder / "scene.json"), "{}");
}

TEST(LogWriter, PutAllocatesNothing) {
  const test::TemporaryFolder folder;
  auto writer = LogWriter::open(folder / "l.catlog", {});
  const auto program = test::make_level_program(1, {"a", "b"});
  (*writer)->add_program(*program);
  std::uint64_t allocations = 0;
  test::run_ticks({{1, program, {}}}, test::adversarial_path(100), [&](const ProbeSample& input, const HapticState& output) {
    const AllocationCounter guard;
    (*writer)->put(input, output);
    allocations += guard.count();
  });
  EXPECT_EQ(allocations, 0u);
}

TEST(LogWriter, AProgramThatWasNotAddedIsReportedAsUnknown) {
  const test::TemporaryFolder folder;
  {
    auto writer = LogWriter::open(folder / "l.catlog", {});
    test::run_ticks({{1, test::make_level_program(8, {"a", "b"}), {}}}, test::adversarial_path(5),
                    [&](const ProbeSample& input, const HapticState& output) { (*writer)->put(input, output); });
  }
  auto reader = LogReader::open(folder / "l.catlog");
  EXPECT_EQ(reader->next(), LogEvent::program);
  EXPECT_FALSE(reader->program().is_known);
  EXPECT_EQ(reader->program().link_names(), (std::vector<std::string>{"link_1", "link_2"}));
  EXPECT_EQ(reader->next(), LogEvent::tick);
  EXPECT_FALSE(reader->damaged());
}

// Three threads change programs, read the status, and record and write ticks.
TEST(LogSoak, ServoProgramChangesAndWriterRunTogether) {
  const test::TemporaryFolder folder;
#ifdef CATENA_THREAD_SANITIZER
  constexpr std::uint64_t kTicks = 40000;
#else
  constexpr std::uint64_t kTicks = 100000;
#endif
  auto writer = LogWriter::open(folder / "l.catlog", {}, {}, fast_flush());
  PathDevice device(test::adversarial_path(1000), kTicks + 1, writer->get());
  const auto first = make_numbered_program(1);
  (*writer)->add_program(*first);
  Servo servo(device, first, {.rate_hz = 1000, .paced = false, .max_ticks = kTicks, .sink = writer->get()});
  EXPECT_TRUE(servo.start());
  HapticState seen;
  for (std::uint64_t epoch = 2; servo.running(); ++epoch) {
    const auto program = make_numbered_program(epoch);
    (*writer)->add_program(*program);
    servo.set_program(program);
    while (seen.program_epoch != epoch && servo.running()) {
      servo.receive(seen);
      std::this_thread::yield();
    }
  }
  servo.stop();
  ASSERT_TRUE((*writer)->finish());
  EXPECT_EQ((*writer)->status().lost, 0u);
  auto reader = LogReader::open(folder / "l.catlog");
  EXPECT_EQ(replay_numbered(*reader).stats.ticks, kTicks);
  ASSERT_TRUE(reader->end());
  EXPECT_EQ(reader->end()->state_hash, servo.state_hash());
}

}  // namespace catena::test::log_writer_test
