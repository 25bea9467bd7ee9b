// SPDX-License-Identifier: MIT
#include "haptics/servo/log/log_replay.h"

#include <utility>

#include "engine/base/clock.h"
#include "haptics/chain/tick.h"
#include "haptics/chain/validate_state.h"

namespace catena::haptics::log {

namespace {

// Returns the built program with the spec hashes of the log if the program has the links named in the log.
Result<std::shared_ptr<const HapticProgram>> with_recorded_recipes(const HapticProgram& built, const LogProgram& recorded) {
  HapticProgram program = built;
  bool same = program.widgets.size() == recorded.widgets.size() && program.links.size() == recorded.links.size() &&
              program.modes.size() == recorded.modes.size();
  for (std::size_t i = 0; same && i < program.links.size(); ++i) {
    same = program.links[i].name == recorded.links[i].name;
    program.links[i].spec_hash = recorded.links[i].spec_hash;
  }
  for (std::size_t i = 0; same && i < program.widgets.size(); ++i) {
    const LogProgram::Widget& widget = recorded.widgets[i];
    same = program.widget_names[i] == widget.name;
    program.widgets[i].revision = widget.revision;
    program.widgets[i].pose = widget.pose;
    program.widgets[i].value = widget.value;
  }
  if (!same)
    return Error{"tick " + std::to_string(recorded.first_tick) +
                 ": the links or widgets of the scene differ from the recording, expected the recorded scene"};
  return std::shared_ptr<const HapticProgram>(std::make_shared<HapticProgram>(std::move(program)));
}

// Checks the start tick and the initial state of the log, which are not trusted.
Outcome check_at(std::uint64_t tick, const HapticProgram& program, const ChainState& state) {
  const Outcome sane = validate_state(program, state);
  if (!sane) return Error{"before tick " + std::to_string(tick) + ": " + sane.error().message};
  return Done{};
}

}  // namespace

Result<LogReplay> replay_log(LogReader& log, const LogReplayHooks& hooks) {
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  bool begun = false;
  HapticState out;
  std::shared_ptr<const HapticProgram> program;
  std::vector<std::string> names, widgets;
  RecordWords words{};
  ReplayMeter meter;
  LogReplay result;
  for (LogEvent event = log.next(); event != LogEvent::done && result.stop_reason.empty(); event = log.next()) {
    switch (event) {
      case LogEvent::program: {
        if (!log.program().is_known) {
          result.stop_reason =
              "the log does not contain the program that ran from tick " + std::to_string(log.program().first_tick) + " on";
          break;
        }
        CATENA_TRY(const std::shared_ptr<const HapticProgram> built, hooks.build(log.program()));
        CATENA_TRY(std::shared_ptr<const HapticProgram> next, with_recorded_recipes(*built, log.program()));
        if (program) {
          rebind_program(*program, *next, *state, *scratch);
          CATENA_CHECK(check_at(log.program().first_tick, *next, *state));
        }
        program = std::move(next);
        names = log.program().link_names();
        widgets = log.program().widget_names();
        break;
      }
      case LogEvent::state:
        if (!log.state().chain)
          return Error{"the log begins after tick " + std::to_string(log.state().tick) +
                       ", with a state written by another build of Catena, expected the build that recorded the log"};
        break;
      case LogEvent::gap:
        result.stop_reason = log.gap().description();
        break;
      case LogEvent::tick: {
        if (!std::exchange(begun, true) && log.state().chain) {
          *state = *log.state().chain;
          CATENA_CHECK(check_at(log.tick().output.tick, *program, *state));
        }
        const std::int64_t start = now_ns();
        tick(*program, log.tick().input, *state, *scratch, out);
        meter.add(static_cast<double>(now_ns() - start), out);
        pack_tick(log.tick().input, out, words.data());
        std::string difference = first_difference(log.record_words(), words, names, widgets);
        if (difference.empty() && out.tick != log.tick().output.tick) difference = "the tick number";
        if (!difference.empty() && result.differing++ == 0) {
          result.first_differing = log.tick().output.tick;
          result.difference = std::move(difference);
        }
        if (hooks.on_tick) hooks.on_tick(log.program(), out);
        break;
      }
      case LogEvent::poses:
      case LogEvent::done:
        break;
    }
  }
  result.stats = meter.stats();
  return result;
}

}  // namespace catena::haptics::log
