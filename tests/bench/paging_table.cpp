// SPDX-License-Identifier: MIT
// Table of ticks on the coarse level, for stores that take a while to answer: paging_table [SECONDS]. A hand circles on a ball of 1024^3
// voxels in bricks of 0.5 MB, of which 64 MB are in memory (haptics/servo/brick_pager.h).
#include <fmt/core.h>

#include <cstdlib>

#include "haptics/device/recorded_path.h"
#include "haptics/servo/brick_pager.h"
#include "haptics/servo/servo.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/support/formula_bricks.h"

namespace catena::haptics {

namespace {

constexpr double kRadius = 360, kMiddle = 512, kLevel = 30000, kMaxForce = 8;

/// Level 0 by a formula, level 1 as a grid of every 16th voxel: the table needs no coarse level of 512^3 voxels.
class Ball final : public field::BrickSource {
 public:
  explicit Ball(int latency_ms)
      : BrickSource(*field::find_number_type("uint16"), {level(1024, 1), level(64, 16)}), latency_ms_(latency_ms) {}
  static field::BrickLevel level(int size, double spacing) {
    return {{size, size, size}, field::Mapping::from_linear(Mat3(spacing), Vec3(0.5 * (spacing - 1)))};
  }
  static double value(const Vec3& p) {
    return std::clamp(kLevel + 40 * (kRadius - norm(p - Vec3(kMiddle))) + 60 * std::sin(0.21 * p.x) * std::sin(0.17 * p.y), 0.0, 65535.0);
  }
  field::BrickRange range(int, const field::Index3&) const noexcept override { return {}; }
  Outcome read(int of, const field::Index3& brick, std::span<std::byte> values) const override {
    std::this_thread::sleep_for(std::chrono::milliseconds(latency_ms_));
    const field::BrickLevel& at = levels()[static_cast<std::size_t>(of)];
    const field::Index3 n = brick_size(at, brick);
    // as value(), without a sine for each voxel
    std::vector<Vec3> along_x;
    for (int x = 0; x < n.x; ++x) {
      const double p = at.mapping.world_from_index(Vec3(brick.x * 64 + x, 0, 0)).x;
      along_x.emplace_back((p - kMiddle) * (p - kMiddle), 60 * std::sin(0.21 * p), 0);
    }
    std::size_t byte = 0;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y) {
        const Vec3 p = at.mapping.world_from_index(Vec3(0, brick.y * 64 + y, brick.z * 64 + z)), d = p - Vec3(kMiddle);
        const double across = d.y * d.y + d.z * d.z, bump = std::sin(0.17 * p.y);
        for (int x = 0; x < n.x; ++x, byte += 2) {
          const Vec3& here = along_x[static_cast<std::size_t>(x)];
          const double v = kLevel + 40 * (kRadius - std::sqrt(here.x + across)) + here.y * bump + 0.5;
          const auto rounded = static_cast<std::uint16_t>(std::clamp(v, 0.0, 65535.0));
          std::memcpy(values.data() + byte, &rounded, 2);
        }
      }
    return Done{};
  }

 private:
  int latency_ms_;
};

std::shared_ptr<const field::PagedGrid> paged_ball(int latency_ms) {
  const auto source = std::make_shared<const Ball>(latency_ms);
  const field::BrickLevel& coarse = source->levels()[1];
  const field::SliceSource slices{coarse.size, false, [&](int z, std::span<float> out) {
                                    for (std::size_t i = 0; i < out.size(); ++z)
                                      for (int y = 0; y < coarse.size.y; ++y)
                                        for (int x = 0; x < coarse.size.x; ++x)
                                          out[i++] = static_cast<float>(Ball::value(coarse.mapping.world_from_index(Vec3(x, y, z))));
                                  }};
  const field::AnyField grid = test::value_of(field::make_grid_from_slices("ball", coarse.mapping, slices));
  return std::make_shared<const field::PagedGrid>(source,
                                                  field::PagedGrid::Part{{0, 0, 0}, source->levels()[0].size, source->levels()[0].mapping},
                                                  std::static_pointer_cast<const field::ScalarGrid>(grid.scalar));
}

void run(int latency_ms, double voxels_per_s, int ticks) {
  const auto paged = paged_ball(latency_ms);
  const tests::Fields fields = tests::scalars({{"f", paged}});
  auto program = std::make_shared<HapticProgram>();
  program->epoch = 1;
  for (const char* text : {R"({"name": "a", "type": "isosurface", "field": "f", "level": 30000, "free": "below"})",
                           R"({"name": "b", "type": "drag", "surface": "f", "level": 30000, "threshold": 0.5})",
                           R"({"name": "c", "type": "gradient_force", "field": "f", "displacement": 1, "direction": "up_gradient"})"}) {
    Link& link = program->links.emplace_back();
    link.constraint = test::value_of(tests::try_build(text, fields));
    link.name = std::string(1, static_cast<char>('a' + program->links.size() - 1));
  }
  program->coupling.max_force_n = kMaxForce;
  program->meters_per_unit = 0.001;
  program->paged_grids = {paged};
  std::vector<RecordedPath::Sample> path;
  for (int k = 0; k < ticks; ++k) {
    const double a = voxels_per_s * k / 1000 / kRadius, b = 0.7 * std::sin(0.13 * a), r = kRadius - 1.5 - std::sin(0.01 * k);
    path.push_back({1e-3 * k, Vec3(kMiddle) + r * Vec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)), 0});
  }
  struct Count final : TickSink {
    void put(const ProbeSample&, const HapticState& state) noexcept override {
      if (state.tick <= 200) return;  // the first bricks
      ++ticks;
      coarse += state.links[0].status == LinkStatus::coarse;
      none += state.links[0].status == LinkStatus::no_surface;
      if (ticks > 1) largest_step = std::max(largest_step, norm(state.coupling_force_n - before));
      before = state.coupling_force_n;
    }
    std::uint64_t ticks = 0, coarse = 0, none = 0;
    double largest_step = 0;
    Vec3 before{0.0};
  } count;
  RecordedPath device(path);
  ServoOptions options;
  options.max_ticks = static_cast<std::uint64_t>(ticks);
  options.sink = &count;
  Servo servo(device, program, options);
  if (!servo.start()) return;
  HapticState state;
  while (servo.running()) {
    servo.receive(state);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  servo.stop();
  const ServoStats stats = servo.stats();
  fmt::print("{:6} {:10.0f} {:6} {:9.3f} {:7} {:10.1f} {:9.1f} {:9.1f}\n", latency_ms, voxels_per_s, program->links.size(),
             100.0 * static_cast<double>(count.coarse) / static_cast<double>(count.ticks), count.none, 100 * count.largest_step / kMaxForce,
             stats.compute.p50_us, stats.compute.p999_us);
}

}  // namespace

}  // namespace catena::haptics

int main(int argc, char** argv) {
  using namespace catena;
  const int ticks = 1000 * (argc > 1 ? std::atoi(argv[1]) : 20);
  set_memory_limit(std::uint64_t{512} << 20);
  fmt::print("{:>6} {:>10} {:>6} {:>9} {:>7} {:>10} {:>9} {:>9}\n", "ms", "voxels/s", "links", "coarse %", "nothing", "step %", "p50 us",
             "p99.9 us");
  for (const int latency_ms : {0, 5, 20, 50})
    for (const double speed : {500.0, 2000.0, 5000.0}) haptics::run(latency_ms, speed, ticks);
}
