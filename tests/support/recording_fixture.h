// SPDX-License-Identifier: MIT
/// Recordings for the tests of haptics/servo/log: ticks driven without a thread, with all conditions of a probe.
#pragma once
#include <cmath>
#include <limits>
#include <map>

#include "haptics/chain/tick.h"
#include "haptics/servo/log/log_replay.h"
#include "haptics/servo/log/writer.h"
#include "tests/support/simple_links.h"
#include "tests/support/support.h"

namespace catena::test {

/// A program that runs from tick `tick` on (the first is 1).
struct ProgramChange {
  std::uint64_t tick = 1;
  std::shared_ptr<const haptics::HapticProgram> program;
  std::optional<std::string> scene_text;
};

/// Motion, jumps, rests, buttons, rotations; and ticks without a probe or a device, late ticks, forces off, a clock that runs backwards.
inline std::vector<haptics::ProbeSample> adversarial_path(int ticks) {
  std::vector<haptics::ProbeSample> path;
  for (int k = 0; k < ticks; ++k) {
    haptics::ProbeSample p;
    p.t_s = 1e-3 * k;
    const double f = (k % 400) / 400.0, side = k % 800 < 400 ? 1 : -1;
    p.position = {side * (0.7 - 1.4 * f), 0.6 * (f - 0.5) * side, 0.3 - 0.5 * f};
    if (k % 300 > 270) p.position = Vec3(0.1, -0.0, 0.2);
    p.buttons = k % 500 > 350 ? 1u : k % 500 > 200 ? 2u : 0u;
    const double w = 1 / std::sqrt(1 + f * f);
    p.orientation = Quat(w, 0, f * w, 0);
    if (k % 97 == 13) p.condition = TickCondition::late;
    if (k % 311 >= 100 && k % 311 < 108) p.condition = TickCondition::late;
    if (k % 401 == 50) p.condition = TickCondition::no_device;
    if (k % 401 == 51) p.condition = TickCondition::watchdog;
    if (k % 603 > 560) p.forces_on = false;
    if (k % 211 == 7) p.position.y = std::numeric_limits<double>::quiet_NaN();
    if (k % 223 == 9) p.orientation.x = std::numeric_limits<double>::infinity();
    if (k % 227 == 11) p.t_s = -std::numeric_limits<double>::quiet_NaN();
    if (k % 229 == 17) p.t_s -= 0.01;
    path.push_back(p);
  }
  return path;
}

/// Runs the ticks like the servo and passes each to `sink`.
template <class Sink>
void run_ticks(const std::vector<ProgramChange>& changes, const std::vector<haptics::ProbeSample>& path, const Sink& sink) {
  auto state = std::make_unique<haptics::ChainState>();
  auto scratch = std::make_unique<haptics::ChainScratch>();
  HapticState out;
  const haptics::HapticProgram* program = nullptr;
  std::size_t next = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (next < changes.size() && changes[next].tick == k + 1) {
      const haptics::HapticProgram* newer = changes[next++].program.get();
      if (program != nullptr) haptics::rebind_program(*program, *newer, *state, *scratch);
      program = newer;
    }
    haptics::tick(*program, path[k], *state, *scratch, out);
    out.period_us = 1000 + 0.25 * static_cast<double>(k % 7);
    out.compute_us = 2.5;
    out.device_us = 0.125;
    out.missed_deadlines = k / 100;
    sink(path[k], out);
  }
}

/// Records the ticks; returns their state_hash.
inline std::uint64_t record_ticks(haptics::log::LogWriter& writer, const std::vector<ProgramChange>& changes,
                                  const std::vector<haptics::ProbeSample>& path) {
  for (const ProgramChange& change : changes) writer.add_program(*change.program, change.scene_text);
  haptics::StateHash hash;
  run_ticks(changes, path, [&](const haptics::ProbeSample& input, const HapticState& output) {
    hash.add(output);
    writer.put(input, output);
  });
  return hash.value();
}

inline std::shared_ptr<haptics::HapticProgram> make_level_program(std::uint64_t epoch, const std::vector<std::string>& names) {
  auto program = std::make_shared<haptics::HapticProgram>();
  program->epoch = epoch;
  for (std::size_t i = 0; i < names.size(); ++i) {
    program->links.push_back(hold_height(names[i], 0.1 * static_cast<double>(i) + 0.01 * static_cast<double>(epoch), 300));
    program->links.back().spec_hash = i + 1;
  }
  program->coupling.damping_ns_per_m = 1.5;
  program->coupling.ramp_s = 0.02;
  return program;
}

/// Replay hooks that find the programs of a recording by their epoch.
inline haptics::log::LogReplayHooks make_replay_hooks(const std::vector<ProgramChange>& changes) {
  haptics::log::LogReplayHooks hooks;
  hooks.build = [changes](const haptics::log::LogProgram& wanted) -> Result<std::shared_ptr<const haptics::HapticProgram>> {
    for (const ProgramChange& change : changes)
      if (change.program->epoch == wanted.epoch) return change.program;
    return Error{"no program of this epoch was expected"};
  };
  return hooks;
}

/// Bytes of a log with 5 small blocks of ticks, two programs and an end.
inline std::string make_small_log(int ticks = 60) {
  const TemporaryFolder folder;
  haptics::log::LogHeader header{"scene.json", "/somewhere", "{\"chain\": []}", {"density=d.vdb:x"}, "null", "0.1.0", 1000, 1};
  header.plugins = {{"ring.so", 7, {"ring", "knot"}}, {"none.so", 8, {}}};
  haptics::log::LogOptions options;
  options.flush_s = 1000;
  auto writer = haptics::log::LogWriter::open(folder / "small.catlog", header, {}, options);
  const std::vector<ProgramChange> changes{{1, make_level_program(1, {"a"}), {}},
                                           {11, make_level_program(2, {"b", "a"}), "{\"chain\": [1]}"},
                                           {21, make_level_program(3, {"a"}), {}},
                                           {31, make_level_program(4, {}), {}},
                                           {41, make_level_program(5, {"a", "b", "c"}), {}}};
  record_ticks(**writer, changes, adversarial_path(ticks));
  const Outcome done = (*writer)->finish();
  CATENA_ASSERT(static_cast<bool>(done));
  writer->reset();
  return read_file(folder / "small.catlog");
}

}  // namespace catena::test
