/// What every subcommand shares: how it registers itself, how it fails, how it finds its scene.
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

/// A subcommand's work; the exit code of a success is 0. An Error means bad input: exit code 2, or 1 where it is the machine's.
using CommandAction = std::function<Outcome()>;

/// Each adds its subcommand and, when the user chose it, sets `chosen`.
void add_render(CLI::App& program, CommandAction& chosen);
void add_replay(CLI::App& program, CommandAction& chosen);
void add_export(CLI::App& program, CommandAction& chosen);
void add_trace(CLI::App& program, CommandAction& chosen);
void add_info(CLI::App& program, CommandAction& chosen);
void add_generate(CLI::App& program, CommandAction& chosen);
void add_import(CLI::App& program, CommandAction& chosen);
void add_tradeoff(CLI::App& program, CommandAction& chosen);
void add_feel(CLI::App& program, CommandAction& chosen);
void add_devices(CLI::App& program, CommandAction& chosen);
void add_serve(CLI::App& program, CommandAction& chosen);
void add_study(CLI::App& program, CommandAction& chosen);
void add_documents(CLI::App& program, CommandAction& chosen);
void add_view(CLI::App& program, CommandAction& chosen, int& exit_code);

/// A failure of the machine, not of the input, or a replay that does not repeat its recording: exit code 1.
struct MachineFailure {
  std::string message;
};

/// A scene file (.json), or a bare data file.
bool is_scene_file(const std::string& path);
/// What a data file says of its grids; of one alone where `grid` names it, or is its number.
Result<std::vector<field::GridInfo>> read_grid_infos(const std::string& path, const std::string& grid, int step = 0);

/// `colors`, `grid` and `step` are for a bare data file.
Result<scene::Scene> open_scene(const std::string& path, const std::vector<std::string>& field_options = {},
                                const scene::NamedColors& colors = {}, const std::string& grid = {}, int step = 0);
/// The same of a scene that is followed (engine/scene/follow_files.h): a data file that is still being written is waited for. `source`
/// becomes what is followed. Error: nothing in it can get steps, or none was whole after `seconds` (0: no limit).
Result<scene::Scene> open_followed_scene(std::string& source, const std::vector<std::string>& field_options, const std::string& grid,
                                         double seconds);
/// Tells the notes of a scene and of the data that it has loaded so far, each once in a process: at most ten, and how many more there are.
/// Every command calls it when its data are loaded; open_scene has told those of a scene file. Any thread.
void print_scene_notes(const scene::Scene& scene);
/// The same of notes on one file.
void print_scene_notes(const std::string& path, const std::vector<std::string>& notes);
/// Refuses a step in time beyond the last one of `source`; `option` states it ("--step 3").
Outcome check_step(int step, int last, const std::string& option, const std::string& source);
/// Goes to a step in time, which `option` states ("--step 3"); below 0: nothing is stated. Loads the fields, whose files say how many
/// there are. Error: a step beyond the last one.
Outcome go_to_step(scene::Scene& scene, int step, const std::string& option);
/// NAME=FILE[:GRID], as the command line gives them.
Result<std::vector<scene::FieldOverride>> parse_field_overrides(const std::vector<std::string>& field_options);

/// "1.23 MiB", "512 B".
std::string format_bytes(double bytes);

/// The same of a file that is read by another program: how long it has taken (field::set_read_progress).
void print_reading_progress(const std::string& path, double seconds, bool ended);

/// The same of streamlines (scene::set_trace_progress).
void print_tracing_progress(const std::string& field, std::size_t seeds, std::size_t of);

/// A line on stderr that says how far long work is: rewritten in place on a terminal, after the first second; elsewhere at most ten lines,
/// after the first ten seconds.
class ProgressLine {
 public:
  ProgressLine(std::string what, double total);
  ~ProgressLine();
  void update(double done, std::string_view doing = {});  ///< `doing`: what comes now

 private:
  std::string task_name_;
  double total_;
  std::int64_t start_ns_, last_update_ns_ = 0;
  int printed_tenths_ = 0;
  bool is_terminal_, is_shown_ = false;
};

/// The program `catena`: one file a subcommand. Exit codes: 0 done; 2 bad input, with one clear line on stderr and no output
/// file; 1 the machine failed (no Vulkan device, no display, out of memory), or a replay does not repeat its recording.
int run(int argc, char** argv);
}  // namespace catena::app
