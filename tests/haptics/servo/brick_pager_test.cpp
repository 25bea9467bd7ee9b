// SPDX-License-Identifier: MIT
// The hand in data of which only some bricks are in memory.
#include "haptics/servo/brick_pager.h"

#include <gtest/gtest.h>

#include "engine/base/memory_limit.h"
#include "haptics/chain/offline_ticks.h"
#include "haptics/device/recorded_path.h"
#include "haptics/servo/brick_plan.h"
#include "haptics/servo/log/log_replay.h"
#include "haptics/servo/log/writer.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/formula_bricks.h"
#include "tests/support/support.h"

namespace catena::haptics::brick_pager_test {

using test::FormulaBricks;
using test::value_of;

constexpr double kVoxel = 0.03, kMiddle = 2.0, kMaxForce = 8;

/// A ball with bumps that the coarse level does not have: the level 30000 is at radius 1, roughly.
std::shared_ptr<FormulaBricks> bumpy_ball(const field::Index3& size = {136, 136, 136}) {
  return std::make_shared<FormulaBricks>(size, kVoxel, [](const Vec3& p) {
    const Vec3 q = p - Vec3(kMiddle);
    return std::clamp(60000 - 30000 * norm(q) + 360 * std::sin(50 * q.x) * std::sin(47 * q.y), 0.0, 65535.0);
  });
}

/// Presses an isosurface, with friction on it.
std::shared_ptr<HapticProgram> press(const field::ScalarFieldPtr& field, std::uint64_t epoch = 1) {
  const tests::Fields fields = tests::scalars({{"f", field}});
  auto program = std::make_shared<HapticProgram>();
  program->epoch = epoch;
  for (const char* text : {R"({"name": "a", "type": "isosurface", "field": "f", "level": 30000, "free": "below"})",
                           R"({"name": "b", "type": "drag", "surface": "f", "level": 30000, "threshold": 0.005})"}) {
    Link& link = program->links.emplace_back();
    link.constraint = tests::build(text, fields);
    link.name = program->links.size() == 1 ? "a" : "b";
  }
  program->coupling.max_force_n = kMaxForce;
  if (const auto paged = std::dynamic_pointer_cast<const field::PagedGrid>(field)) program->paged_grids = {paged};
  return program;
}

/// A path that presses into the ball while it goes around it, through many bricks.
std::vector<ProbeSample> around(int ticks, double turns) {
  std::vector<ProbeSample> path;
  for (int k = 0; k < ticks; ++k) {
    const double a = 2 * 3.14159265358979323846 * turns * k / ticks, press = 0.004 * std::sin(0.01 * k);
    path.push_back({1e-3 * k, Vec3(kMiddle) + Vec3(std::cos(a), std::sin(a), 0.3 * std::sin(2 * a)) * (0.98 + press), 0});
  }
  return path;
}

std::uint64_t hash_of(const HapticProgram& program, const std::vector<ProbeSample>& path) {
  return replay(program, path, [](const HapticState&) { return true; }).state_hash;
}

TEST(PagedHand, OffTheServoItFeelsTheGridInMemoryToTheBit) {
  const auto source = bumpy_ball();
  const auto path = around(3000, 1);
  EXPECT_EQ(hash_of(*press(test::make_paged(source)), path), hash_of(*press(source->whole(0)), path));
  EXPECT_GT(source->reads, 4);
}

/// Drives ticks with snapshots that the test chooses.
struct Hand {
  explicit Hand(std::shared_ptr<const HapticProgram> of) : program(std::move(of)) {}
  const HapticState& tick(const Vec3& probe, const field::BrickSnapshot* bricks) {
    ProbeSample input{1e-3 * static_cast<double>(state->ticks), probe, 0};
    input.bricks = bricks;
    haptics::tick(*program, input, *state, *scratch, out);
    hash.add(out);
    return out;
  }
  std::shared_ptr<const HapticProgram> program;
  std::unique_ptr<ChainState> state = std::make_unique<ChainState>();
  std::unique_ptr<ChainScratch> scratch = std::make_unique<ChainScratch>();
  HapticState out;
  StateHash hash;
};

/// Returns the bricks that ticks at a position may sample.
std::vector<field::Index3> bricks_near(const field::PagedGrid& grid, const Vec3& world, std::size_t count = 27) {
  std::vector<field::Index3> bricks;
  for (const field::BrickId& id : plan_bricks(grid, std::vector<WatchedPosition>{{world, Vec3(0.0)}}, {8, 0, count}))
    bricks.push_back(grid.brick_at(id.number));
  return bricks;
}

TEST(PagedHand, ABrickThatArrivesMovesTheForceGently) {
  const auto source = bumpy_ball();
  const auto paged = test::make_paged(source);
  const auto in_memory = source->whole(0);
  double largest_change = 0;
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0.6, 0.8, 0), Vec3(0, -0.8, 0.6), Vec3(-0.5, 0.5, 0.7)}) {
    const Vec3 probe = Vec3(kMiddle) + direction(way) * 0.99;
    const field::BrickSnapshot near = test::make_snapshot(*paged, bricks_near(*paged, probe));
    Hand hand(press(paged)), whole(press(in_memory));
    for (int k = 0; k < 300; ++k) hand.tick(probe, nullptr), whole.tick(probe, nullptr);
    EXPECT_EQ(hand.out.links[0].status, LinkStatus::coarse);
    Vec3 before = hand.out.force_n;
    const Vec3 coarse = before;
    for (const field::BrickSnapshot* bricks : {&near, static_cast<const field::BrickSnapshot*>(nullptr), &near})
      for (int k = 0; k < 200; ++k) {
        hand.tick(probe, bricks);
        ASSERT_LE(norm(hand.out.force_n - before), 0.05 * kMaxForce + 1e-9) << k;
        before = hand.out.force_n;
      }
    EXPECT_EQ(hand.out.links[0].status, LinkStatus::ok);
    EXPECT_NEAR(norm(hand.out.links[0].proxy - whole.out.links[0].proxy), 0, 0.5 * kVoxel);
    largest_change = std::max(largest_change, norm(hand.out.force_n - coarse));
  }
  EXPECT_GT(largest_change, 0.05 * kMaxForce) << "without a limit the steps would be larger";
}

TEST(PagedHand, TheSameBricksInAnotherSnapshotAreNoChange) {
  const auto paged = test::make_paged(bumpy_ball());
  const Vec3 start = Vec3(kMiddle) + Vec3(0.99, 0, 0);
  const std::vector<field::Index3> near = bricks_near(*paged, start, 4);
  const field::BrickSnapshot one = test::make_snapshot(*paged, near, 1);
  std::vector<field::StoredBrick> with_more(one.bricks().begin(), one.bricks().end());
  with_more.push_back({paged->brick_id({2, 2, 2}), value_of(paged->read({2, 2, 2}))});
  const field::BrickSnapshot two(2, with_more);
  Hand steady(press(paged)), changing(press(paged));
  for (int k = 0; k < 500; ++k) {
    const Vec3 probe = start + Vec3(0, 1e-4 * k, 0);
    steady.tick(probe, &one);
    changing.tick(probe, k % 3 == 0 ? &one : &two);
    ASSERT_EQ(steady.hash.value(), changing.hash.value()) << k;
  }
}

TEST(PagedHand, TheServoPagesAndTheRecordingReplaysToTheBit) {
  const auto source = bumpy_ball();
  source->latency_us = 500;
  const auto paged = test::make_paged(source);
  const test::TemporaryFolder folder;
  const std::string path = folder / "paged.catlog";
  std::vector<RecordedPath::Sample> samples;
  for (const ProbeSample& probe : around(3000, 0.8)) samples.push_back({probe.t_s, probe.position, 0});
  const std::shared_ptr<const HapticProgram> program = press(paged), later = press(paged, 2);
  std::uint64_t snapshots = 0, ticks = 0;
  {
    log::LogHeader header;
    header.scene_text = "{}";
    auto log = value_of(log::LogWriter::open(path, header));
    log->add_program(*program);
    log->add_program(*later);
    RecordedPath device(samples);
    ServoOptions options;
    options.max_ticks = 3000;
    options.sink = log.get();
    options.realtime.fifo = options.realtime.lock_memory = false;
    Servo servo(device, program, options);
    EXPECT_TRUE(servo.start());
    HapticState seen;
    bool has_changed = false;
    while (servo.running()) {
      if (!servo.receive(seen)) continue;
      snapshots = seen.brick_snapshot;
      if (seen.tick > 1500 && !std::exchange(has_changed, true)) servo.set_program(later);
    }
    servo.stop();
    EXPECT_TRUE(log->finish());
  }
  EXPECT_GT(snapshots, 1u);
  log::LogReplayHooks hooks;
  std::uint64_t coarse = 0;
  hooks.build = [&](const log::LogProgram& p) -> Result<std::shared_ptr<const HapticProgram>> { return p.epoch == 1 ? program : later; };
  hooks.on_tick = [&](const log::LogProgram&, const HapticState& state) { ++ticks, coarse += state.links[0].status == LinkStatus::coarse; };
  auto reader = value_of(log::LogReader::open(path));
  const log::LogReplay result = value_of(log::replay_log(reader, hooks));
  EXPECT_TRUE(result.exact()) << result.first_differing << " " << result.difference << result.stop_reason;
  EXPECT_EQ(ticks, 3000u);
  EXPECT_LT(coarse, ticks) << "the first bricks take a while";
}

TEST(PagedHand, UnreadableBricksLeaveTheCoarseLevel) {
  const auto source = bumpy_ball();
  source->fails = true;
  const auto paged = test::make_paged(source);
  auto pager = value_of(BrickPager::start(BrickPager::kMinBytes));
  pager->set_grids({paged});
  HapticState at;
  at.probe = Vec3(kMiddle) + Vec3(1, 0, 0);
  const AllocationCounter allocations;
  pager->put(at);
  EXPECT_EQ(pager->newest(), nullptr);
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_TRUE(pager->wait_until_idle(20));
  const field::BrickSnapshot* snapshot = pager->newest();
  EXPECT_TRUE(snapshot == nullptr || snapshot->bricks().empty());
  EXPECT_GT(source->reads, 0);
}

TEST(BrickPlan, TheWayComesBeforeTheSurroundings) {
  const auto paged = test::make_paged(bumpy_ball({448, 128, 128}));
  const Vec3 from = Vec3(0.96, 2.85, 2.85), velocity(18, 0, 0);  // 600 voxels a second, 240 in the time ahead
  const auto plan = plan_bricks(*paged, std::vector<WatchedPosition>{{from, velocity}}, {8, 0.4, 24});
  EXPECT_EQ(plan.size(), 24u);
  std::vector<int> on_way;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const field::Index3 brick = paged->brick_at(plan[i].number);
    if (brick.y == 1 && brick.z == 1) on_way.push_back(static_cast<int>(i));
  }
  ASSERT_GE(on_way.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_LT(on_way[static_cast<std::size_t>(i)], 10) << "brick " << i << " of the way";
}

}  // namespace catena::haptics::brick_pager_test
