// SPDX-License-Identifier: MIT
/// Shared by all subcommands: registration, errors and exit codes, opening scenes, progress output.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/version.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/scene.h"

namespace CLI {
class App;
}

namespace catena::app {

/// The action of a subcommand; exit code 0 on success. An Error is bad input, exit code 2, or a system failure (Error::system_failure),
/// exit code 1.
using CommandAction = std::function<Outcome()>;

/// Each function adds its subcommand to `program` and sets `chosen` if the user selected it.
void add_render(CLI::App& program, CommandAction& chosen);
void add_replay(CLI::App& program, CommandAction& chosen);
void add_export(CLI::App& program, CommandAction& chosen);
void add_trace(CLI::App& program, CommandAction& chosen);
void add_info(CLI::App& program, CommandAction& chosen);
void add_measure(CLI::App& program, CommandAction& chosen);
void add_merge(CLI::App& program, CommandAction& chosen);
void add_generate(CLI::App& program, CommandAction& chosen);
void add_import(CLI::App& program, CommandAction& chosen);
void add_tradeoff(CLI::App& program, CommandAction& chosen);
void add_feel(CLI::App& program, CommandAction& chosen);
void add_devices(CLI::App& program, CommandAction& chosen);
void add_serve(CLI::App& program, CommandAction& chosen);
void add_study(CLI::App& program, CommandAction& chosen);
void add_documents(CLI::App& program, CommandAction& chosen);
void add_upgrade(CLI::App& program, CommandAction& chosen);
void add_view(CLI::App& program, CommandAction& chosen, int& exit_code);
/// Adds all of them, with the options that every command has. `plugins`: values of --plugin; `exit_code`: of `view`.
void add_commands(CLI::App& program, CommandAction& chosen, int& exit_code, std::vector<std::string>& plugins);

/// Thrown for a failure of the system rather than the input, and for a replay that differs from its recording: exit code 1.
struct MachineFailure {
  std::string message;
};

/// Whether a path is a scene file (.json); otherwise it is a data file.
bool is_scene_file(const std::string& path);
/// Describes the grids of a data file at a time step; only the matching ones if `grid`, a name or a number, is not empty. Error: no such
/// grid, or the file cannot be read.
Result<std::vector<field::GridInfo>> read_grid_infos(const std::string& path, const std::string& grid, int step = 0);

/// Opens a scene file, or makes the default scene of a data file. `field_options`: NAME=FILE[:GRID], scene files only. `colors`, `grid` and
/// `step`: data files only. Prints the notes of a scene file.
Result<scene::Scene> open_scene(const std::string& path, const std::vector<std::string>& field_options = {},
                                const scene::FileColors& colors = {}, const std::string& grid = {}, int step = 0);
/// Opens a scene whose time steps are followed (engine/scene/follow_files.h); waits for a data file that is still being written. `source`
/// becomes the path that is followed. Error: nothing in the scene can get time steps, or no file was complete after `seconds` (0: no
/// limit).
Result<scene::Scene> open_followed_scene(std::string& source, const std::vector<std::string>& field_options, const std::string& grid,
                                         double seconds);
/// Prints the notes of a scene and of the data loaded so far to stderr, each only the first time in a process: at most ten, then the number
/// of the others. Every command calls it after loading its data; open_scene() has printed those of a scene file. Any thread.
void print_scene_notes(const scene::Scene& scene);
/// As above, for notes on the file `path`.
void print_scene_notes(const std::string& path, const std::vector<std::string>& notes);
/// Error if the time step is greater than `last`, the last step of `source`. `option`: how it was given ("--step 3"), for the message.
Outcome check_step(int step, int last, const std::string& option, const std::string& source);
/// Sets the time step of a scene and loads all its fields, whose files determine the number of steps. `option`: how the step was given
/// ("--step 3"). A negative step does nothing. Error: a step beyond the last one, or a field that cannot be loaded.
Outcome go_to_step(scene::Scene& scene, int step, const std::string& option);
/// Parses the --field options, NAME=FILE[:GRID].
Result<std::vector<scene::FieldOverride>> parse_field_overrides(const std::vector<std::string>& field_options);

/// Formats a size with a binary unit: "1.23 MiB", "512 B".
std::string format_bytes(double bytes);

/// Progress callback for field::set_read_progress: prints to stderr for how many seconds an external reader has been reading `path`; on a
/// terminal after the first second, elsewhere after 10 s and then at times three times as long. `ended`: the read is over. Any thread.
void print_reading_progress(const std::string& path, double seconds, bool ended);

/// Progress callback for scene::set_trace_progress: `seeds` of `of` seeds are traced; `of` = 0: the work is over.
void print_tracing_progress(const std::string& field, std::size_t seeds, std::size_t of);

/// Progress callback for field::set_level_cache: the part of the work that is done for a store; negative: the work is over.
void print_level_progress(const std::string& path, double part);

/// Progress callback for render::set_page_progress: bricks of an image that have been read.
void print_brick_progress(std::size_t done, std::size_t of);

/// Progress of long work, on stderr: a line rewritten in place on a terminal, after the first second; elsewhere at most ten lines, after
/// the first ten seconds.
class ProgressLine {
 public:
  /// `what`: label of the work; `total`: the value of `done` at the end.
  ProgressLine(std::string what, double total);
  ~ProgressLine();
  void update(double done, std::string_view step_label = {});  ///< `step_label`: label of the current step

 private:
  std::string task_name_;
  double total_;
  std::int64_t start_ns_, last_update_ns_ = 0;
  int printed_tenths_ = 0;
  bool is_terminal_, is_shown_ = false;
};

/// Runs the program `catena`. Exit codes: 0: success; 2: bad input, with one clear line on stderr and no output file; 1: a system failure
/// (no Vulkan device, no display, out of memory), or a replay that differs from its recording.
int run(int argc, char** argv);
}  // namespace catena::app
