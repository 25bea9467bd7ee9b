// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "engine/app/tuning/predict/cost.h"
#include "engine/base/clock.h"
#include "engine/scene/prepare.h"
#include "haptics/chain/tick.h"

namespace catena::app {
namespace {

constexpr int kTicks = 1500, kWalks = 5;

/// Slow probe path along a closed curve about the center of a box.
std::vector<haptics::ProbeSample> closed_walk(const Vec3& middle, const Vec3& half) {
  std::vector<haptics::ProbeSample> walk;
  for (int k = 0; k < kTicks; ++k) {
    const double a = 2 * 3.14159265358979 * k / kTicks;
    walk.push_back({0.001 * k, middle + Vec3(half.x * std::cos(a), half.y * std::sin(a), half.z * std::sin(2 * a)), 0});
  }
  return walk;
}

struct Walked {
  double ns = 0;  ///< nanoseconds per tick
  std::vector<double> fetches, work;
};

Walked walk_through(const haptics::HapticProgram& program, const std::vector<haptics::ProbeSample>& walk) {
  Walked walked{0, std::vector<double>(program.links.size()), std::vector<double>(program.links.size())};
  HapticState out;
  for (int repeat = 0; repeat < kWalks; ++repeat) {
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

/// Returns a copy of the program with these links only; `widgets`: the links belong to widgets.
haptics::HapticProgram with_links(const haptics::HapticProgram& program, std::vector<haptics::Link> links, bool widgets = false) {
  haptics::HapticProgram some = program;
  some.links = std::move(links);
  some.modes.clear();
  some.first_widget_link = widgets ? 0 : -1;
  if (!widgets) some.widgets.clear(), some.widget_names.clear();
  return some;
}

}  // namespace

void add_tick_costs(const scene::Scene& scene, const haptics::HapticProgram& program, bool measure, CostTable& table) {
  const Bounds box = scene::scene_bounds(scene);
  const Vec3 middle = box.empty() ? Vec3(0.0) : (box.lo + box.hi) / 2.0, half = box.empty() ? Vec3(1.0) : (box.hi - box.lo) * 0.35;
  const std::vector<haptics::ProbeSample> walk = closed_walk(middle, half);
  const double none_ns = walk_through(with_links(program, {}), walk).ns;
  double all_ns = none_ns;
  const auto add = [&](const std::string& name, const haptics::HapticProgram& part) {
    const Walked alone = walk_through(part, walk);
    const double ns = std::max(0.0, alone.ns - none_ns), fetches = std::accumulate(alone.fetches.begin(), alone.fetches.end(), 0.0),
                 work = std::accumulate(alone.work.begin(), alone.work.end(), 0.0);
    all_ns += ns;
    table.push_back({"tick", name, fmt::format("{:.1f} fetches, {:.0f} units of work", fetches, work), {{}, 1e-6 * ns}, {}});
  };
  const auto scene_links = static_cast<std::ptrdiff_t>(program.scene_link_count());
  for (auto link = program.links.begin(); link != program.links.begin() + scene_links; ++link)
    add(link->name, with_links(program, {*link}));
  if (!program.widgets.empty()) add("widgets", with_links(program, {program.links.begin() + scene_links, program.links.end()}, true));
  CostRow all{"tick", "all", fmt::format("{} links, {} widgets", scene_links, program.widgets.size()), {{}, 1e-6 * all_ns}, {}};
  if (measure) all.measured.ms = 1e-6 * walk_through(program, walk).ns;
  table.push_back(std::move(all));
}

}  // namespace catena::app
