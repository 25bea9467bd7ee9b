#include <fmt/format.h>

#include <cmath>

#include "engine/app/cost/cost.h"
#include "engine/base/clock.h"
#include "engine/scene/prepare.h"
#include "haptics/chain/tick.h"

namespace catena::app {
namespace {

constexpr int kTicks = 1500, kRepeats = 5;

/// Slowly through the box of what is loaded, on a closed curve about its middle.
std::vector<haptics::ProbeSample> standard_walk(const scene::Scene& scene) {
  const Bounds box = scene::prepared_bounds(scene);
  const Vec3 middle = box.empty() ? Vec3(0.0) : (box.lo + box.hi) / 2.0, half = box.empty() ? Vec3(1.0) : (box.hi - box.lo) * 0.35;
  std::vector<haptics::ProbeSample> walk;
  for (int k = 0; k < kTicks; ++k) {
    const double a = 2 * 3.14159265358979 * k / kTicks;
    walk.push_back({0.001 * k, middle + Vec3(half.x * std::cos(a), half.y * std::sin(a), half.z * std::sin(2 * a)), 0});
  }
  return walk;
}

struct Walked {
  double ns = 0;  ///< a tick
  std::vector<double> fetches, work;
};

Walked walk_through(const haptics::Program& program, const std::vector<haptics::ProbeSample>& walk) {
  Walked walked{0, std::vector<double>(program.links.size()), std::vector<double>(program.links.size())};
  exchange::HapticState out;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    auto state = std::make_unique<haptics::ChainState>();
    auto scratch = std::make_unique<haptics::ChainScratch>();
    const std::int64_t start = now_ns();
    for (const haptics::ProbeSample& probe : walk) {
      haptics::tick(program, probe, *state, *scratch, out);
      for (std::size_t i = 0; i < program.links.size() && repeat == 0; ++i) {
        walked.fetches[i] += double(state->links[i].evaluations) / double(walk.size());
        walked.work[i] += double(state->links[i].work()) / double(walk.size());
      }
    }
    const double ns = double(now_ns() - start) / double(walk.size());
    walked.ns = repeat == 0 ? ns : std::min(walked.ns, ns);
  }
  return walked;
}

/// Of a fetch from the fields that the hand may feel, along the walk.
double fetch_ns(const scene::Scene& scene, const std::vector<haptics::ProbeSample>& walk) {
  double sum = 0, count = 0, used = 0;
  scene.world.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    if (source.loaded.get() == nullptr) return;
    double quickest = 1e9;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      field::Cursor cursor;
      const std::int64_t start = now_ns();
      for (const haptics::ProbeSample& probe : walk)
        used += source.loaded.scalar ? source.loaded.scalar->sample(probe.position, cursor).value
                                     : source.loaded.vector->sample(probe.position, cursor).value.x;
      quickest = std::min(quickest, double(now_ns() - start) / double(walk.size()));
    }
    sum += quickest;
    ++count;
  });
  volatile double kept = used;
  (void)kept;
  return count > 0 ? sum / count : 0;
}

}  // namespace

void add_tick_costs(const scene::Scene& scene, const haptics::Program& program, bool measure, CostTable& table) {
  const std::vector<haptics::ProbeSample> walk = standard_walk(scene);
  haptics::Program empty;
  empty.coupling = program.coupling;
  empty.metres_per_unit = program.metres_per_unit;
  const double base_ns = walk_through(empty, walk).ns, unit_ns = fetch_ns(scene, walk) / haptics::kFetchWork;
  const Walked walked = walk_through(program, walk);
  double all_ns = base_ns;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const double ns = walked.work[i] * unit_ns;
    all_ns += ns;
    table.push_back({"tick",
                     program.links[i].name,
                     fmt::format("{:.1f} fetches, {:.0f} units of work", walked.fetches[i], walked.work[i]),
                     {{}, 1e-6 * ns},
                     {}});
  }
  CostRow all{"tick", "all", fmt::format("{} links, {} widgets", program.links.size(), program.widgets.size()), {{}, 1e-6 * all_ns}, {}};
  if (measure) all.measured.ms = 1e-6 * walked.ns;
  table.push_back(std::move(all));
}

}  // namespace catena::app
