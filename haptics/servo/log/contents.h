/// What a log tells beside its ticks: the header, the programs, gaps and the end; to bytes and back. Off the tick.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "haptics/chain/tick.h"

namespace catena::haptics::log {

/// A plug-in that was loaded: its constraints may run in the ticks.
struct LogPlugin {
  std::string file;                ///< its name, without its folder
  std::uint64_t hash = 0;          ///< FNV-1a-64 of the file
  std::vector<std::string> types;  ///< types of links that it gave
};

/// What was known before the first tick.
struct LogHeader {
  std::string scene_path;            ///< as the user gave it
  std::string working_folder;        ///< of relative paths; empty: filled in by the writer
  std::string scene_text;            ///< the file as it was read
  std::vector<std::string> fields;   ///< --field NAME=FILE[:GRID]
  std::string device;                ///< its name
  std::string catena_version;        ///< that recorded
  double rate_hz = 1000;             ///< of the servo
  std::int64_t started_unix_ns = 0;  ///< 0: filled in by the writer
  std::string about{};               ///< what it was recorded for, one line; empty: nothing is known
  std::vector<LogPlugin> plugins{};  ///< none in recordings of before there were plug-ins
};

/// All of a program that its scene's text does not say, or that the program may have got elsewhere (a fitted workspace, a ramp).
struct LogProgram {
  /// A link of the program.
  struct Link {
    std::string name;             ///< its name
    std::uint64_t spec_hash = 0;  ///< as in Link::recipe
  };
  std::uint64_t epoch = 0;                ///< as in HapticProgram
  std::uint64_t first_tick = 0;           ///< the tick that it runs from
  bool is_known = true;                   ///< false: the log does not say what ran here; the links are named link_1 ..
  std::optional<std::string> scene_text;  ///< none: the header's
  DeviceLimits limits;                    ///< of the device
  Coupling coupling;                      ///< how the links made a force
  double meters_per_unit = 1;             ///< as in HapticProgram
  Vec3 workspace_origin{0.0};             ///< as in HapticProgram
  Mat3 workspace_rotation{1.0};           ///< as in HapticProgram
  std::vector<Link> links;                ///< in the order of the chain
  /// A widget of the program.
  struct Widget {
    std::string name;            ///< its name
    std::uint32_t revision = 0;  ///< as in widget::Spec
    widget::Pose pose;           ///< when the program was made
    double value = 0;            ///< isolevel
  };
  std::vector<std::string> modes;  ///< names of modes
  std::vector<Widget> widgets;     ///< in the order of the program

  /// Names in the order of the ticks' columns.
  std::vector<std::string> link_names() const;
  /// Names in the order of the ticks' columns.
  std::vector<std::string> widget_names() const;
};

/// Ticks that the log does not hold.
struct LogGap {
  /// Why they are not there.
  enum class Cause { overrun, damaged };
  std::uint64_t first_tick = 0, ticks = 0;  ///< the first that is missing, and how many
  Cause cause = Cause::overrun;             ///< why
  std::string description() const;          ///< "ticks 5 to 9 are lost: ..."
};

/// What the writer wrote at the end.
struct LogEnd {
  std::uint64_t ticks = 0, lost = 0, last_tick = 0, state_hash = 0;  ///< ticks in the log, ticks lost, number of the last, hash (StateHash)
};

/// Where a log begins that is not the servo's beginning: what the chain remembers after `tick`. Its bytes are the file's: they are to be
/// run only after validate_state (haptics/chain/validate_state.h) with the program.
struct LogState {
  std::uint64_t tick = 0;           ///< the tick before the log's first
  std::optional<ChainState> chain;  ///< none: the program that recorded keeps its state in another way
};

/// What the log tells of a program; none: its scene text is the header's.
LogProgram to_log_program(const HapticProgram& program, std::optional<std::string> scene_text);

/// The payload of the block.
std::string to_bytes(const LogHeader& header);
/// The payload of the block.
std::string to_bytes(const LogProgram& program);
/// The payload of the block.
std::string to_bytes(const ChainState& state);
/// The payload of the block.
std::string to_bytes(const LogGap& gap);
/// The payload of the block.
std::string to_bytes(const LogEnd& end);
/// Nothing where the bytes are none of these.
std::optional<LogHeader> parse_header(std::string_view bytes);
/// Nothing where the bytes are none of these.
std::optional<LogProgram> parse_program(std::string_view bytes);
/// Nothing where the bytes are none of these.
std::optional<LogState> parse_state(std::string_view bytes);
/// Nothing where the bytes are none of these.
std::optional<LogGap> parse_gap(std::string_view bytes);
/// Nothing where the bytes are none of these.
std::optional<LogEnd> parse_end(std::string_view bytes);

}  // namespace catena::haptics::log
