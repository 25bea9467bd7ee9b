// SPDX-License-Identifier: MIT
#include "haptics/servo/log/log_replay.h"

#include <map>
#include <utility>

#include "engine/base/clock.h"
#include "engine/field/bricks/paged_grid.h"
#include "haptics/chain/offline_ticks.h"
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

/// Reads the bricks that were in memory in the recording; those of `before` are not read again.
Result<std::shared_ptr<const field::BrickSnapshot>> read_recorded(const std::vector<LogBrick>& recorded, const HapticProgram& program,
                                                                  const field::BrickSnapshot* before, std::uint64_t number) {
  std::map<field::BrickId, std::shared_ptr<const field::Brick>> known;
  if (before != nullptr)
    for (const field::StoredBrick& brick : before->bricks()) known.emplace(brick.id, brick.values);
  std::vector<field::StoredBrick> bricks;
  for (const LogBrick& brick : recorded) {
    if (brick.grid >= program.paged_grids.size())
      return Error{"the log was recorded with less memory for data; replaying it needs the same --memory"};
    const field::PagedGrid& grid = *program.paged_grids[brick.grid];
    if (brick.number >= grid.brick_count()) return Error{"the log names a brick that the grid does not have; the data have changed"};
    const field::BrickId id{grid.version(), brick.number};
    const auto found = known.find(id);
    if (found != known.end()) {
      bricks.push_back({id, found->second});
      continue;
    }
    CATENA_TRY(std::shared_ptr<const field::Brick> values, grid.read(grid.brick_at(brick.number)));
    bricks.push_back({id, std::move(values)});
  }
  return std::make_shared<const field::BrickSnapshot>(number, bricks);
}

}  // namespace

Result<LogReplay> replay_log(LogReader& log, const LogReplayHooks& hooks) {
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  bool begun = false;
  HapticState out;
  std::shared_ptr<const HapticProgram> program;
  std::shared_ptr<const field::BrickSnapshot> bricks, previous_bricks;
  std::uint64_t snapshots = 1;
  OfflineTicks ticks;
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
          scratch->bricks = bricks.get();  // the recording began with the bricks of the tick before it
        }
        ProbeSample input = log.tick().input;
        input.bricks = bricks.get();
        const std::int64_t start = now_ns();
        // grids may be in memory as a whole in the recording, but not here
        if (bricks)
          tick(*program, input, *state, *scratch, out);
        else
          ticks.run(*program, input, *state, *scratch, out);
        previous_bricks.reset();
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
      case LogEvent::bricks: {
        CATENA_ASSERT(program != nullptr);
        if (!previous_bricks) previous_bricks = bricks;  // that of the last tick stays alive for the next one
        CATENA_TRY(bricks, read_recorded(log.bricks(), *program, bricks.get(), snapshots++));
        break;
      }
      case LogEvent::poses:
      case LogEvent::done:
        break;
    }
  }
  if (result.differing > 0 && bricks)
    result.difference += "; the data were larger than the memory, so that a replay needs the same --memory";
  result.stats = meter.stats();
  return result;
}

}  // namespace catena::haptics::log
