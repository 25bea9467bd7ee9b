/// What a log tells beside its ticks: the header, the programs, gaps and the end; to bytes and back. Off the tick.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "haptics/chain/tick.h"

namespace catena::haptics::log {

struct LogHeader {
  std::string scene_path;           ///< as the user gave it
  std::string working_folder;       ///< of relative paths; empty: filled in by the writer
  std::string scene_text;           ///< the file as it was read
  std::vector<std::string> fields;  ///< --field NAME=FILE[:GRID]
  std::string device;
  std::string catena_version;
  double rate_hz = 1000;
  std::int64_t started_unix_ns = 0;  ///< 0: filled in by the writer
  std::string about{};               ///< what it was recorded for, one line; empty: nothing is known
};

/// All of a program that its scene's text does not say, or that the program may have got elsewhere (a fitted workspace, a ramp).
struct LogProgram {
  struct Link {
    std::string name;
    std::uint64_t recipe = 0;
  };
  std::uint64_t epoch = 0;
  std::uint64_t first_tick = 0;
  bool known = true;                      ///< false: the log does not say what ran here; the links are named link_1 ..
  std::optional<std::string> scene_text;  ///< none: the header's
  Limits limits;
  Coupling coupling;
  double metres_per_unit = 1;
  Vec3 workspace_origin{0.0};
  Mat3 workspace_rotation{1.0};
  std::vector<Link> links;
  struct Widget {
    std::string name;
    std::uint32_t revision = 0;
    widget::Pose pose;  ///< when the program was made
    double value = 0;
  };
  std::vector<std::string> modes;
  std::vector<Widget> widgets;

  std::vector<std::string> link_names() const;
  std::vector<std::string> widget_names() const;
};

/// Ticks that the log does not hold.
struct LogGap {
  enum class Why { not_kept_up, damaged };
  std::uint64_t first_tick = 0, ticks = 0;
  Why why = Why::not_kept_up;
  std::string text() const;  ///< "ticks 5 to 9 are lost: ..."
};

struct LogEnd {
  std::uint64_t ticks = 0, lost = 0, last_tick = 0, state_hash = 0;
};

/// Where a log begins that is not the servo's beginning: what the chain remembers after `tick`. Its bytes are the file's: they are to be
/// run only after check_state (haptics/chain/check_state.h) with the program.
struct LogState {
  std::uint64_t tick = 0;
  std::optional<ChainState> chain;  ///< none: the program that recorded keeps its state in another way
};

LogProgram facts_of(const Program& program, std::optional<std::string> scene_text);

std::string to_bytes(const LogHeader& header);
std::string to_bytes(const LogProgram& program);
std::string to_bytes(const ChainState& state);
std::string to_bytes(const LogGap& gap);
std::string to_bytes(const LogEnd& end);
/// Nothing where the bytes are none of these.
std::optional<LogHeader> header_from(std::string_view bytes);
std::optional<LogProgram> program_from(std::string_view bytes);
std::optional<LogState> state_from(std::string_view bytes);
std::optional<LogGap> gap_from(std::string_view bytes);
std::optional<LogEnd> end_from(std::string_view bytes);

}  // namespace catena::haptics::log
