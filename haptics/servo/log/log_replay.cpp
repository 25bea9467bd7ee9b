#include "haptics/servo/log/log_replay.h"

#include <utility>

#include "engine/base/clock.h"
#include "haptics/chain/check_state.h"
#include "haptics/chain/tick.h"

namespace catena::haptics::log {

namespace {

// The program that was built, if it has the links that the log names.
Result<std::shared_ptr<const Program>> with_recorded_recipes(const Program& built, const LogProgram& recorded) {
  Program program = built;
  bool same = program.widgets.size() == recorded.widgets.size() && program.links.size() == recorded.links.size() &&
              program.modes.size() == recorded.modes.size();
  for (std::size_t i = 0; same && i < program.links.size(); ++i) {
    same = program.links[i].name == recorded.links[i].name;
    program.links[i].recipe = recorded.links[i].recipe;
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
                 ": the scene has other links or widgets than the recording; expected the scene that was recorded"};
  return std::shared_ptr<const Program>(std::make_shared<Program>(std::move(program)));
}

// The log says where it begins, and which links of the next program keep their state: neither is trusted.
Outcome check_at(std::uint64_t tick, const Program& program, const ChainState& state) {
  const Outcome sane = check_state(program, state);
  if (!sane) return Error{"before tick " + std::to_string(tick) + ": " + sane.error().message};
  return Done{};
}

}  // namespace

Result<LogReplay> replay_log(LogReader& log, const LogReplayHooks& hooks) {
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  bool begun = false;
  exchange::HapticState out;
  std::shared_ptr<const Program> program;
  std::vector<std::string> names, widgets;
  Words words{};
  ReplayMeter meter;
  LogReplay result;
  for (LogEvent event = log.next(); event != LogEvent::done && result.stopped.empty(); event = log.next()) {
    switch (event) {
      case LogEvent::program: {
        if (!log.program().known) {
          result.stopped = "the log does not say what ran from tick " + std::to_string(log.program().first_tick) + " on";
          break;
        }
        CATENA_TRY(const std::shared_ptr<const Program> built, hooks.build(log.program()));
        CATENA_TRY(std::shared_ptr<const Program> next, with_recorded_recipes(*built, log.program()));
        if (program) {
          rebind(*program, *next, *state, *scratch);
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
                       ", with a state that another build of Catena has written; expected the build that recorded it"};
        break;
      case LogEvent::gap:
        result.stopped = log.gap().text();
        break;
      case LogEvent::tick: {
        if (!std::exchange(begun, true) && log.state().chain) {
          *state = *log.state().chain;
          CATENA_CHECK(check_at(log.tick().output.tick, *program, *state));
        }
        const std::int64_t start = now_ns();
        tick(*program, log.tick().input, *state, *scratch, out);
        meter.add(static_cast<double>(now_ns() - start), out);
        pack(log.tick().input, out, words.data());
        std::string difference = first_difference(log.words(), words, names, widgets);
        if (difference.empty() && out.tick != log.tick().output.tick) difference = "the tick's number";
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
