// SPDX-License-Identifier: MIT
/// Recordings: complete, truncated and damaged files, and their replay.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/hash.h"
#include "tests/haptics/servo/log_fixture.h"

namespace catena::test::log_test {

std::uint64_t fnv(const std::string& bytes, std::size_t at, std::size_t size) {
  Fnv1a hash;
  hash.add_bytes(bytes.data() + at, size);
  return hash.value;
}

struct Block {
  std::size_t at = 0;  ///< offset of the block's header
  BlockHeader head;
  std::size_t payload() const { return at + sizeof(BlockHeader); }
  std::size_t after() const { return payload() + head.length; }
};

// Parses the blocks by the format's description, independent of LogReader.
std::vector<Block> blocks_of(const std::string& bytes) {
  std::vector<Block> blocks;
  for (std::size_t at = kPreambleBytes; at < bytes.size();) {
    Block block;
    block.at = at;
    std::memcpy(&block.head, bytes.data() + at, sizeof block.head);
    EXPECT_EQ(block.head.magic, BlockHeader::kBlockMagic);
    EXPECT_EQ(block.head.sequence, blocks.size());
    EXPECT_EQ(block.head.payload_hash, fnv(bytes, block.payload(), block.head.length));
    EXPECT_EQ(block.head.header_hash, fnv(bytes, at, 32));
    blocks.push_back(block);
    at = block.after();
  }
  return blocks;
}

void seal(std::string& bytes, const Block& block) {
  BlockHeader head = block.head;
  head.payload_hash = fnv(bytes, block.payload(), block.head.length);
  std::memcpy(bytes.data() + block.at, &head, sizeof head);
  head.header_hash = fnv(bytes, block.at, 32);
  std::memcpy(bytes.data() + block.at, &head, sizeof head);
}

BlockType type_of(const Block& block) { return static_cast<BlockType>(block.head.type); }

/// Expects the given members of both to be equal.
template <class T, class... Member>
void expect_equal(const T& a, const T& b, Member T::*... members) {
  int member = 0;
  const auto compare = [&](const auto& left, const auto& right) { EXPECT_EQ(left, right) << "member " << member++; };
  (compare(a.*members, b.*members), ...);
}

TEST(Log, RecordsEveryTickBitForBit) {
  const test::TemporaryFolder folder;
  const std::vector<ProgramChange> changes{{1, test::make_level_program(7, {"a", "b"}), {}},
                                           {301, test::make_level_program(9, {"b", "c", "a"}), "text"}};
  const auto path = test::adversarial_path(900);
  const LogHeader header{"s.json", "/w", "scene", {"f=g"}, "falcon", "0.1.0", 2000, 77, "a trial"};
  std::uint64_t hash = 0;
  {
    auto writer = LogWriter::open(folder / "l.catlog", header);
    ASSERT_TRUE(writer) << writer.error().message;
    hash = test::record_ticks(**writer, changes, path);
    const Outcome done = (*writer)->finish();
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ((*writer)->status().ticks, 900u);
    EXPECT_EQ((*writer)->status().lost, 0u);
    EXPECT_EQ((*writer)->status().bytes, std::filesystem::file_size(folder / "l.catlog"));
  }
  auto reader = LogReader::open(folder / "l.catlog");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_equal(reader->header(), header, &LogHeader::scene_path, &LogHeader::working_folder, &LogHeader::scene_text, &LogHeader::fields,
               &LogHeader::device, &LogHeader::rate_hz, &LogHeader::started_unix_ns, &LogHeader::about);
  test::run_ticks(changes, path, [&](const ProbeSample& input, const HapticState& output) {
    LogEvent event = reader->next();
    if (output.tick == 1 || output.tick == 301) {
      ASSERT_EQ(event, LogEvent::program) << output.tick;
      EXPECT_EQ(reader->program().first_tick, output.tick);
      EXPECT_EQ(reader->program().epoch, output.program_epoch);
      EXPECT_EQ(reader->program().scene_text.value_or("none"), output.tick == 1 ? "none" : "text");
      event = reader->next();
    }
    ASSERT_EQ(event, LogEvent::tick);
    const LogTick& got = reader->tick();
    RecordWords wanted{}, is{};
    pack_tick(input, output, wanted.data());
    pack_tick(got.input, got.output, is.data());
    EXPECT_EQ(wanted, is) << output.tick;
    EXPECT_EQ(got.output.tick, output.tick);
    EXPECT_EQ(got.output.program_epoch, output.program_epoch);
    EXPECT_EQ(got.output.link_count, output.link_count);
    EXPECT_EQ(got.output.mode, output.mode);
  });
  EXPECT_EQ(reader->next(), LogEvent::done);
  ASSERT_TRUE(reader->end());
  EXPECT_EQ(reader->end()->state_hash, hash);
  EXPECT_EQ(reader->end()->ticks, 900u);
  EXPECT_EQ(reader->end_summary(), "ends cleanly with tick 900");
}

TEST(Log, EveryFieldOfARecordRoundTrips) {
  // all words differ, so that swapped fields are detected
  LogTick tick;
  HapticState& out = tick.output;
  double next = 1;
  const auto vector = [&](Vec3& v) {
    for (int a = 0; a < 3; ++a) v[a] = next++;
  };
  const auto turn = [&](Quat& q) {
    for (double* v : {&q.w, &q.x, &q.y, &q.z}) *v = next++;
  };
  tick.input.t_s = next++;
  vector(tick.input.position);
  turn(tick.input.orientation);
  tick.input.buttons = 0x80000001u;
  tick.input.condition = TickCondition::watchdog;
  tick.input.forces_on = false;
  out.force_state = ForceState::ramping_out;
  out.mode = 5;
  for (double* v : {&out.t_s, &out.energy_j, &out.dissipated_j}) *v = next++;
  for (Vec3* v : {&out.force_n, &out.coupling_force_n, &out.torque_nm}) vector(*v);
  out.missed_deadlines = ~std::uint64_t{0};
  for (double* v : {&out.period_us, &out.compute_us, &out.device_us}) *v = next++;
  out.link_count = kMaxLinks;
  for (LinkReport& link : out.links) {
    for (Vec3* v : {&link.proxy, &link.force_n, &link.torque_nm}) vector(*v);
    turn(link.orientation);
    for (double* v : {&link.residual, &link.weight, &link.stiffness_n_per_m, &link.gap, &link.accounted_j, &link.release_ratio})
      *v = next++;
    link.evaluations = -static_cast<std::int32_t>(next);
    link.status = LinkStatus::boundary;
    link.active = true;
    link.released = next > 100;
  }
  out.widget_count = kMaxWidgets;
  for (WidgetReport& widget : out.widgets) {
    for (Vec3& v : widget.pose.points) vector(v);
    turn(widget.pose.orientation);
    widget.value = next++;
    widget.revision = 0xf0000000u + static_cast<std::uint32_t>(next);
    widget.mode = WidgetMode::drag;
    widget.handle = static_cast<std::int8_t>(&widget - out.widgets.data() - 1);
    widget.active_planes = static_cast<std::uint8_t>(&widget - out.widgets.data());
  }
  RecordWords words{};
  ASSERT_EQ(pack_tick(tick.input, out, words.data()), kMaxRecordWords);
  LogTick got;
  ASSERT_TRUE(unpack_tick(words, record_layout(out), got));
  using P = ProbeSample;
  using H = HapticState;
  using L = LinkReport;
  using W = WidgetReport;
  expect_equal(got.input, tick.input, &P::t_s, &P::position, &P::orientation, &P::buttons, &P::condition, &P::forces_on);
  EXPECT_EQ(got.output.probe, tick.input.position);
  EXPECT_EQ(got.output.orientation, tick.input.orientation);
  expect_equal(got.output, out, &H::force_state, &H::mode, &H::t_s, &H::energy_j, &H::dissipated_j, &H::force_n, &H::coupling_force_n,
               &H::torque_nm, &H::missed_deadlines, &H::period_us, &H::compute_us, &H::device_us, &H::widget_count);
  for (std::size_t i = 0; i < kMaxLinks; ++i)
    expect_equal(got.output.links[i], out.links[i], &L::proxy, &L::force_n, &L::torque_nm, &L::orientation, &L::residual, &L::weight,
                 &L::stiffness_n_per_m, &L::gap, &L::accounted_j, &L::release_ratio, &L::evaluations, &L::status, &L::active, &L::released);
  for (std::size_t i = 0; i < kMaxWidgets; ++i)
    expect_equal(got.output.widgets[i], out.widgets[i], &W::pose, &W::value, &W::revision, &W::mode, &W::handle, &W::active_planes);
}

TEST(Log, ProgramsRoundTripWithAllTheirNumbers) {
  HapticProgram program = *test::make_level_program(42, {"a", "bee"});
  double next = 1;
  for (double* v : {&program.limits.max_stiffness_n_per_m, &program.limits.max_rotational_stiffness_nm_per_rad, &program.limits.max_force_n,
                    &program.limits.max_torque_nm, &program.limits.slew_n_per_s, &program.limits.ramp_in_s, &program.limits.ramp_out_s,
                    &program.limits.damping_ns_per_m, &program.coupling.stiffness_n_per_m, &program.coupling.damping_ns_per_m,
                    &program.coupling.max_force_n, &program.coupling.ramp_s, &program.meters_per_unit})
    *v = next++;
  program.limits.max_late_ticks = 11;
  program.limits.passivity_control = true;
  program.coupling.method = CouplingMethod::closest;
  program.workspace_origin = {21, 22, 23};
  program.workspace_rotation = Mat3(Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9));
  program.modes = {{"m", {0}, {}}, {"n", {1}, {}}};
  const std::string bytes = to_bytes(to_log_program(program, "text"));
  const auto got = parse_program(bytes);
  ASSERT_TRUE(got);
  EXPECT_EQ(to_bytes(*got), bytes);
  EXPECT_EQ(got->epoch, 42u);
  EXPECT_EQ(got->limits.max_rotational_stiffness_nm_per_rad, 2);
  EXPECT_EQ(got->limits.damping_ns_per_m, 8);
  EXPECT_EQ(got->limits.max_late_ticks, 11);
  EXPECT_TRUE(got->limits.passivity_control);
  EXPECT_EQ(got->coupling.stiffness_n_per_m, 9);
  EXPECT_EQ(got->coupling.ramp_s, 12);
  EXPECT_EQ(got->coupling.method, CouplingMethod::closest);
  EXPECT_EQ(got->meters_per_unit, 13);
  EXPECT_EQ(got->workspace_origin, program.workspace_origin);
  EXPECT_EQ(got->workspace_rotation, program.workspace_rotation);
  EXPECT_EQ(got->link_names(), (std::vector<std::string>{"a", "bee"}));
  EXPECT_EQ(got->links[1].spec_hash, 2u);
  EXPECT_EQ(got->modes, (std::vector<std::string>{"m", "n"}));
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(parse_program(std::string_view(bytes).substr(0, n))) << n;
}

TEST(Log, TruncatedAtAnyByteItKeepsAllCompleteBlocks) {
  const std::string bytes = test::make_small_log();
  const std::vector<Block> blocks = blocks_of(bytes);
  ASSERT_EQ(type_of(blocks.back()), BlockType::end);
  ASSERT_EQ(blocks.size(), 12u);
  // tick count by the format's description: at byte 16 of the payload
  const auto ticks_up_to = [&](std::size_t size) {
    std::uint64_t ticks = 0;
    for (const Block& block : blocks) {
      std::uint32_t count = 0;
      if (block.after() <= size && type_of(block) == BlockType::ticks) std::memcpy(&count, bytes.data() + block.payload() + 16, 4);
      ticks += count;
    }
    return ticks;
  };
  ASSERT_EQ(ticks_up_to(bytes.size()), 60u);
  std::size_t last_block_cuts = 0;
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    // a separate copy, so that sanitizers detect reads past the end
    const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const LogContents read = read_all({cut.data(), cut.size()});
    ASSERT_EQ(read.opened, size >= blocks[0].after()) << size;
    if (!read.opened) {
      EXPECT_NE(read.ending.find("x.catlog: "), std::string::npos);
      EXPECT_NE(read.ending.find("truncated"), std::string::npos) << read.ending;
      continue;
    }
    ASSERT_EQ(read.ticks.size(), ticks_up_to(size)) << size;
    ASSERT_TRUE(rising_from_one(read.ticks));
    ASSERT_FALSE(read.damaged) << size;
    ASSERT_EQ(read.clean, size == bytes.size()) << size;
    ASSERT_TRUE(read.gaps.empty());
    if (size > blocks[10].at) ++last_block_cuts;
  }
  EXPECT_EQ(last_block_cuts, bytes.size() - blocks[10].at);
}

TEST(Log, ADamagedBlockLosesOnlyItsOwnTicksAndNamesThem) {
  const std::string bytes = test::make_small_log();
  for (const Block& block : blocks_of(bytes)) {
    if (type_of(block) != BlockType::ticks) continue;
    std::uint64_t first = 0;
    std::uint32_t count = 0;
    std::memcpy(&first, bytes.data() + block.payload() + 8, 8);
    std::memcpy(&count, bytes.data() + block.payload() + 16, 4);
    // damage in the payload, the length, the magic number and the type
    for (const std::size_t at : {block.payload() + 30, block.at + 16, block.at, block.at + 4}) {
      std::string broken = bytes;
      broken[at] = static_cast<char>(broken[at] ^ 0x20);
      const LogContents read = read_all(broken);
      ASSERT_TRUE(read.opened);
      EXPECT_TRUE(read.damaged);
      EXPECT_TRUE(read.clean);
      ASSERT_EQ(read.gaps.size(), 1u) << first;
      EXPECT_EQ(read.gaps[0].first_tick, first);
      EXPECT_EQ(read.gaps[0].ticks, count);
      EXPECT_EQ(read.gaps[0].cause, LogGap::Cause::damaged);
      EXPECT_EQ(read.ticks.size(), 60 - count);
    }
  }
}

TEST(Log, ADamagedProgramIsUnknownAndStopsReplay) {
  std::string bytes = test::make_small_log();
  const std::vector<Block> blocks = blocks_of(bytes);
  const Block& second = blocks[3];
  ASSERT_EQ(type_of(second), BlockType::program);
  bytes[second.payload() + 3] ^= 1;
  const LogContents read = read_all(bytes);
  EXPECT_EQ(read.ticks.size(), 60u);
  EXPECT_TRUE(read.damaged);
  const LogReplay result = replay_of(LogReader::open(make_memory_source(bytes), "x.catlog"), {{1, test::make_level_program(1, {"a"}), {}}});
  EXPECT_EQ(result.stats.ticks, 10u);
  EXPECT_EQ(result.differing, 0u);
  EXPECT_NE(result.stop_reason.find("tick 11"), std::string::npos) << result.stop_reason;
}

TEST(Log, InvalidFilesAreRefusedWithWhatWasExpected) {
  std::string bytes = test::make_small_log();
  const auto message = [](const std::string& text) { return read_all(text).ending; };
  EXPECT_NE(message("").find("not a recording"), std::string::npos);
  EXPECT_NE(message("{\"chain\": []} and more").find(".catlog file was expected"), std::string::npos);
  std::string other = bytes;
  for (const int version : {1, 3}) {
    other[8] = static_cast<char>(version);
    EXPECT_NE(message(other).find("version " + std::to_string(version) + ", expected version 2"), std::string::npos);
  }
  other = bytes;
  std::swap(other[12], other[15]);
  EXPECT_NE(message(other).find("byte order"), std::string::npos);
  other = bytes;
  other[kPreambleBytes + sizeof(BlockHeader) + 5] ^= 1;
  EXPECT_NE(message(other).find("header of the recording is damaged"), std::string::npos);
  EXPECT_FALSE(LogReader::open("/nowhere/none.catlog"));
  EXPECT_FALSE(LogReader::open("/tmp"));
}

TEST(Log, ReplayIsExactOverEveryTickConditionAndProgramChange) {
  const test::TemporaryFolder folder;
  const std::vector<ProgramChange> changes{{1, test::make_level_program(1, {"a", "b"}), {}},
                                           {300, test::make_level_program(2, {"b", "a"}), {}},
                                           {301, test::make_level_program(3, {"c"}), {}},
                                           {1999, test::make_level_program(4, {}), {}},
                                           {2400, test::make_level_program(5, {"a", "b", "c", "d", "e", "f", "g", "h"}), {}}};
  auto writer = LogWriter::open(folder / "l.catlog", {});
  const std::uint64_t hash = test::record_ticks(**writer, changes, test::adversarial_path(3000));
  ASSERT_TRUE((*writer)->finish());
  const LogReplay result = replay_of(LogReader::open(folder / "l.catlog"), changes);
  EXPECT_EQ(result.stats.ticks, 3000u);
  EXPECT_TRUE(result.exact()) << result.difference << result.stop_reason;
  EXPECT_EQ(result.stats.state_hash, hash);
}

TEST(Log, AFlippedForceBitIsReportedAtItsTick) {
  const test::TemporaryFolder folder;
  auto program = test::make_level_program(1, {"a"});
  const std::vector<ProgramChange> changes{{1, program, {}}};
  auto writer = LogWriter::open(folder / "l.catlog", {});
  test::run_ticks(changes, test::adversarial_path(500), [&](const ProbeSample& input, const HapticState& output) {
    HapticState state = output;
    if (state.tick == 123) *reinterpret_cast<unsigned char*>(&state.force_n.z) ^= 1;
    if (state.tick == 1) (*writer)->add_program(*program);
    (*writer)->put(input, state);
  });
  ASSERT_TRUE((*writer)->finish());
  const LogReplay result = replay_of(LogReader::open(folder / "l.catlog"), changes);
  EXPECT_FALSE(result.exact());
  EXPECT_EQ(result.differing, 1u);
  EXPECT_EQ(result.first_differing, 123u);
  EXPECT_TRUE(result.difference.starts_with("force_z recorded ")) << result.difference;
  EXPECT_EQ(result.stats.ticks, 500u);
}

TEST(Log, AnyFlippedBitOfTheLastRecordIsDetected) {
  // bits are flipped in the file and the hashes recomputed: replay must report changed outputs, but not changed measured times
  const std::vector<ProgramChange> changes{{1, test::make_level_program(1, {"a"}), {}}};
  const test::TemporaryFolder folder;
  auto writer = LogWriter::open(folder / "l.catlog", {});
  test::record_ticks(**writer, changes, test::adversarial_path(3));
  ASSERT_TRUE((*writer)->finish());
  const std::string bytes = test::read_file(folder / "l.catlog");
  const std::vector<Block> blocks = blocks_of(bytes);
  const Block ticks = blocks[2];
  ASSERT_EQ(type_of(ticks), BlockType::ticks);
  // the first record: a mask of 6 bytes, then the words with a set bit
  const std::size_t mask_at = ticks.payload() + 28;
  std::size_t word_at = mask_at + 6;
  int found = 0, words = 0;
  for (int k = 0; k < record_word_count({1, 0}); ++k) {
    if ((bytes[mask_at + static_cast<std::size_t>(k) / 8] >> (k % 8) & 1) == 0) continue;
    std::string turned = bytes;
    turned[word_at] = static_cast<char>(turned[word_at] ^ 1);
    seal(turned, ticks);
    word_at += 8;
    const LogReplay result = replay_of(LogReader::open(make_memory_source(turned), "x.catlog"), changes);
    ASSERT_EQ(result.stats.ticks, 3u) << k;
    const bool measured = k >= 21 && k < 24, input = k < 9;
    if (measured) {
      EXPECT_TRUE(result.exact()) << k;
    } else if (!input) {
      EXPECT_EQ(result.first_differing, 1u) << k;
      ++words;
    }
    if (!result.exact()) ++found;
  }
  EXPECT_GE(words, 8);
  EXPECT_GE(found, words);
}

}  // namespace catena::test::log_test
