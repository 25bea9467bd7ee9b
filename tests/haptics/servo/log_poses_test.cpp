// SPDX-License-Identifier: MIT
/// Poses of head, hands and gaze in a recording: round trip, beside ticks, and damaged.
#include "haptics/servo/log/poses.h"
#include "tests/haptics/servo/log_fixture.h"

namespace catena::test::log_poses_test {

LogPoses some(int k) {
  LogPoses out;
  out.tick = static_cast<std::uint64_t>(10 * k);
  out.predicted_ns = 1'000'000'007LL * k - 5;
  for (std::size_t part = 0; part < kTrackedPartCount; ++part)
    if ((k >> part & 1) == 0)
      out.parts[part] = TrackedPose{{0.1 * k, -0.0, 1.7 + 0.1 * static_cast<double>(part)}, rotation_from_vector({0.1, 0.2, 0.3})};
  return out;
}

TEST(LogPoses, RoundTripThroughBytes) {
  std::vector<LogPoses> all;
  EXPECT_EQ(parse_poses(to_bytes(all)), all);
  for (int k = 0; k < 16; ++k) all.push_back(some(k));
  const std::string bytes = to_bytes(all);
  EXPECT_EQ(parse_poses(bytes), all);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) EXPECT_FALSE(parse_poses(bytes.substr(0, cut)));
  EXPECT_FALSE(parse_poses(bytes + "x"));
  all[3][TrackedPart::gaze] = TrackedPose{Vec3(NAN), kIdentityRotation};
  EXPECT_FALSE(parse_poses(to_bytes(all)));
  std::string parts = to_bytes({LogPoses{}});
  parts[4 + 16] = 16;
  EXPECT_FALSE(parse_poses(parts)) << "a fifth part";
}

TEST(LogPoses, AreRecordedBesideTicksWithoutChangingThem) {
  const test::TemporaryFolder folder;
  const std::vector<ProgramChange> changes{{1, test::make_level_program(1, {"a"}), {}}};
  std::vector<LogPoses> recorded;
  for (const bool with : {false, true}) {
    auto writer = LogWriter::open(folder / (with ? "with" : "without"), {}, {}, fast_flush());
    for (const ProgramChange& change : changes) (*writer)->add_program(*change.program, {});
    int k = 0;
    test::run_ticks(changes, test::adversarial_path(3000), [&](const ProbeSample& input, const HapticState& output) {
      (*writer)->put(input, output);
      if (!with || ++k % 11 != 0) return;
      recorded.push_back(some(k));
      EXPECT_TRUE((*writer)->add_poses(recorded.back()));
    });
    ASSERT_TRUE((*writer)->finish());
    EXPECT_FALSE((*writer)->add_poses({})) << "nothing is written any more";
  }

  std::vector<LogPoses> found;
  auto reader = LogReader::open(folder / "with");
  std::uint64_t ticks = 0;
  for (LogEvent e = reader->next(); e != LogEvent::done; e = reader->next()) {
    if (e == LogEvent::tick) ++ticks;
    if (e == LogEvent::poses) found.insert(found.end(), reader->poses().begin(), reader->poses().end());
  }
  EXPECT_EQ(ticks, 3000u);
  EXPECT_EQ(found, recorded);
  EXPECT_FALSE(reader->damaged());
  ASSERT_TRUE(reader->end());

  // both recordings have the same ticks, and the replay is bit-identical
  auto without = LogReader::open(folder / "without");
  while (without->next() != LogEvent::done) {
  }
  EXPECT_EQ(without->end()->state_hash, reader->end()->state_hash);
  const LogReplay replayed = replay_of(LogReader::open(folder / "with"), changes);
  EXPECT_EQ(replayed.stats.ticks, 3000u);
  EXPECT_EQ(replayed.differing, 0u);
}

TEST(LogPoses, AreWrittenAsCsv) {
  std::string line;
  append_poses_csv(line, some(13));  // mask 1101: only the left hand is present
  EXPECT_TRUE(line.starts_with("130,13000000086,,,,,,,,1.3,-0,1.8,")) << line;
  const auto columns = [](const std::string& row) { return std::count(row.begin(), row.end(), ','); };
  EXPECT_EQ(columns(line), columns(poses_csv_header()));
  EXPECT_TRUE(poses_csv_header().starts_with("tick,predicted_ns,head_x,head_y,head_z,head_qw"));
}

}  // namespace catena::test::log_poses_test
