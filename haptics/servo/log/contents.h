// SPDX-License-Identifier: MIT
/// Contents of a log besides its ticks (header, programs, state, gaps, end) and their conversion to and from bytes. Off the tick.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "haptics/chain/tick.h"

namespace catena::haptics::log {

/// Plug-in that was loaded during the recording; its constraints may have run in the ticks.
struct LogPlugin {
  std::string file;                ///< file name, without the folder
  std::uint64_t hash = 0;          ///< FNV-1a-64 hash of the file
  std::vector<std::string> types;  ///< names of the constraint types that it added
};

/// Header of a log: everything that is known before the first tick.
struct LogHeader {
  std::string scene_path;            ///< path of the scene as the user specified it
  std::string working_folder;        ///< folder to which relative paths refer; empty: set by the writer
  std::string scene_text;            ///< text of the scene file as it was read
  std::vector<std::string> fields;   ///< arguments of --field, NAME=FILE[:GRID]
  std::string device;                ///< name of the device
  std::string catena_version;        ///< version of Catena that recorded the log
  double rate_hz = 1000;             ///< nominal rate of the servo
  std::int64_t started_unix_ns = 0;  ///< start time, nanoseconds since 1970 (UTC); 0: set by the writer
  std::string about{};               ///< purpose of the recording, one line; empty: unknown
  std::vector<LogPlugin> plugins{};  ///< loaded plug-ins; empty also in recordings of versions without plug-in support
};

/// Properties of a haptic program that its scene text does not contain or that may come from elsewhere (a fitted workspace, a ramp).
/// Coupling::force is not stored; it comes from the scene text.
struct CATENA_EXPORT LogProgram {
  /// Link of the program.
  struct Link {
    std::string name;             ///< name of the link
    std::uint64_t spec_hash = 0;  ///< as in haptics::Link
  };
  std::uint64_t epoch = 0;                ///< as in HapticProgram
  std::uint64_t first_tick = 0;           ///< first tick that it runs
  bool is_known = true;                   ///< false: the log does not contain the program; its links are named link_1, link_2 ..
  std::optional<std::string> scene_text;  ///< scene text; none: the header's
  DeviceLimits limits;                    ///< limits of the device
  Coupling coupling;                      ///< coupling of probe and links
  double meters_per_unit = 1;             ///< as in HapticProgram
  Vec3 workspace_origin{0.0};             ///< as in HapticProgram
  Mat3 workspace_rotation{1.0};           ///< as in HapticProgram
  std::vector<Link> links;                ///< links in the order of the program
  /// Widget of the program.
  struct Widget {
    std::string name;            ///< name of the widget
    std::uint32_t revision = 0;  ///< as in widget::Spec
    widget::Pose pose;           ///< pose when the program was built
    double value = 0;            ///< isolevel widget: its value
  };
  std::vector<std::string> modes;  ///< names of the modes
  std::vector<Widget> widgets;     ///< widgets in the order of the program
  /// Versions of the paged grids, for the writer; not in the log.
  std::vector<std::uint64_t> paged_grids;

  /// Returns the names of the links, in the order of the ticks' columns.
  std::vector<std::string> link_names() const;
  /// Returns the names of the widgets, in the order of the ticks' columns.
  std::vector<std::string> widget_names() const;
};

/// Range of ticks that are missing in the log.
struct CATENA_EXPORT LogGap {
  /// Cause of the gap: the writer could not keep up with the ticks; the log is damaged there.
  enum class Cause { overrun, damaged };
  std::uint64_t first_tick = 0, ticks = 0;  ///< first missing tick and number of missing ticks
  Cause cause = Cause::overrun;             ///< cause of the gap
  /// Returns one line, "ticks 5 to 9 are lost: ...".
  std::string description() const;
};

/// End of a log, written when the recording was finished.
struct LogEnd {
  std::uint64_t ticks = 0;       ///< number of ticks in the log
  std::uint64_t lost = 0;        ///< number of ticks lost
  std::uint64_t last_tick = 0;   ///< number of the last tick in the log
  std::uint64_t state_hash = 0;  ///< hash of the ticks in the log (StateHash)
};

/// Start of a log that begins while the servo runs: the state of the chain after `tick`. The state has the bytes of the file; check it with
/// validate_state (haptics/chain/validate_state.h) and the program before running ticks from it.
struct LogState {
  std::uint64_t tick = 0;           ///< number of the tick before the log's first
  std::optional<ChainState> chain;  ///< state; none: it was recorded by a build of Catena with another state layout
};

/// Brick of a paged grid in memory.
struct LogBrick {
  std::uint32_t grid = 0;    ///< index in HapticProgram::paged_grids
  std::uint64_t number = 0;  ///< BrickId::number
  auto operator<=>(const LogBrick&) const = default;
};
/// Change of the bricks in memory. The lists are sorted.
struct LogBricks {
  std::uint64_t first_tick = 0;       ///< first tick that samples them
  std::vector<LogBrick> left, added;  ///< bricks that are no longer, or now, in memory
};

/// Returns what the log stores of a program. `scene_text`: scene text of the program; none: the header's.
CATENA_EXPORT LogProgram to_log_program(const HapticProgram& program, std::optional<std::string> scene_text);

/// Returns the payload of the header block.
CATENA_EXPORT std::string to_bytes(const LogHeader& header);
/// Returns the payload of the program block.
CATENA_EXPORT std::string to_bytes(const LogProgram& program);
/// Returns the payload of the state block.
CATENA_EXPORT std::string to_bytes(const ChainState& state);
/// Returns the payload of the gap block.
CATENA_EXPORT std::string to_bytes(const LogGap& gap);
/// Returns the payload of the end block.
CATENA_EXPORT std::string to_bytes(const LogEnd& end);
/// Returns the payload of a block of bricks.
CATENA_EXPORT std::string to_bytes(const LogBricks& bricks);
/// Parses the payload of a block of bricks; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogBricks> parse_bricks(std::string_view bytes);
/// Parses the payload of a header block; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogHeader> parse_header(std::string_view bytes);
/// Parses the payload of a program block; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogProgram> parse_program(std::string_view bytes);
/// Parses the payload of a state block; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogState> parse_state(std::string_view bytes);
/// Parses the payload of a gap block; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogGap> parse_gap(std::string_view bytes);
/// Parses the payload of an end block; returns nothing if the bytes are invalid.
CATENA_EXPORT std::optional<LogEnd> parse_end(std::string_view bytes);

}  // namespace catena::haptics::log
