// SPDX-License-Identifier: MIT
#include "engine/app/cli/command.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/cli/plugins.h"
#include "engine/app/cli/process_limits.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/input_files.h"
#include "engine/base/memory_limit.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/stores/load_store.h"
#include "engine/scene/streamlines.h"
#include "engine/schema/renames.h"
#include "render/residency/page_loader.h"

namespace catena::app {

namespace {
int bad_input(const std::string& message) {
  print_message(message);
  return 2;
}

int machine_failed(const std::string& message) {
  print_message(message);
  return 1;
}

// Returns "MESSAGE (see catena render --help)".
std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
  std::string command = "catena";
  for (const CLI::App* sub : program.get_subcommands()) command += " " + sub->get_name();
  return std::string(error.what()) + " (see " + command + " --help)";
}

/// Returns a message on the first unknown command or option of the command line, with its new name or the most similar known name; empty
/// if all are known.
std::string unknown_word(const CLI::App& program, int argc, char** argv) {
  for (int i = 2; i < argc && argv[i] != std::string_view("--"); ++i) {
    const std::string_view word = argv[i], name = word.substr(0, word.find('='));
    if (const std::string_view now = schema::renamed_option(name); !now.empty())
      return "the option " + in_quotes(name) + " is now " + in_quotes(now) + "; the new name was expected";
  }
  const CLI::App* command = nullptr;
  std::vector<std::string> commands, options;
  for (const CLI::App* sub : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_group().empty()) commands.push_back(sub->get_name());
    if (argc > 1 && sub->get_name() == argv[1]) command = sub;
  }
  const auto unknown_name_message = [](const char* kind, const std::string& word, const std::vector<std::string>& known) {
    const std::vector<std::string_view> views(known.begin(), known.end());
    return "there is no " + std::string(kind) + " " + in_quotes(word) + suggestion(word, views);
  };
  if (argc > 1 && command == nullptr && argv[1][0] != '-')
    return unknown_name_message("command", argv[1], commands) + "; one of " + join_words({commands.begin(), commands.end()}) +
           " was expected";
  if (command == nullptr || !command->get_subcommands([](const CLI::App*) { return true; }).empty()) return {};
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    if (word == "--") return {};
    if (name.starts_with("--") && std::find(options.begin(), options.end(), name) == options.end())
      return unknown_name_message("option", name, options);
  }
  return {};
}

// Adds --memory MB to every command
void add_memory_limit(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    command
        ->add_option_function<double>(
            "--memory", [](double megabytes) { set_memory_limit(static_cast<std::uint64_t>(1e6 * megabytes)); },
            "maximum memory for data (default: three quarters of the free memory)")
        ->type_name("MB")
        ->check(CLI::Range(1.0, 1e9));
  }
}

// Reads large levels of stores in bricks, unless --memory says how much memory data may take
void prefer_bricks(const CLI::App& program) {
  const bool prefers = std::ranges::any_of(std::initializer_list<const char*>{"info", "render", "serve", "view"},
                                           [&](const char* name) { return program.got_subcommand(name); });
  if (prefers && !memory_limit()) field::set_max_whole_level(field::kMaxDrawnWholeLevel);
}

// Adds --plugin FILE to every visible command
void add_plugins(CLI::App& program, std::vector<std::string>& plugins) {
  const auto add_to = [&](CLI::App& command) {
    command.add_option("--plugin", plugins, "shared library with additional constraints")->type_name("LIBRARY")->allow_extra_args(false);
  };
  for (CLI::App* command : program.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); })) {
    const auto parts = command->get_subcommands([](const CLI::App*) { return true; });
    if (command->get_require_subcommand_min() == 0) add_to(*command);
    for (CLI::App* part : parts) add_to(*part);
  }
}

// Parses the command line and runs the command; returns the exit code. The caller handles exceptions.
int parse_and_work(int argc, char** argv) {
  if (const Outcome ready = prepare_process(); !ready) return machine_failed(ready.error().message);
  CLI::App program{"Catena: see a scientific field and feel it with a hand."};
  program.name("catena");
  program.require_subcommand(1);
  program.set_version_flag("--version", std::string("catena ") + kVersion);
  CommandAction chosen;
  int view_exit_code = 0;
  std::vector<std::string> plugins;
  add_commands(program, chosen, view_exit_code, plugins);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    const std::string unknown = unknown_word(program, argc, argv);
    return bad_input(unknown.empty() ? usage_message(program, error) : unknown);
  }
  prefer_bricks(program);
  const Outcome loaded = load_plugins(plugins);
  const Outcome done = loaded ? chosen() : loaded;
  if (!done) return to_exit_code(done.error()) == 1 ? machine_failed(done.error().message) : bad_input(done.error().message);
  return view_exit_code;
}

}  // namespace

void add_commands(CLI::App& program, CommandAction& chosen, int& exit_code, std::vector<std::string>& plugins) {
  add_render(program, chosen);
  add_replay(program, chosen);
  add_export(program, chosen);
  add_trace(program, chosen);
  add_info(program, chosen);
  add_measure(program, chosen);
  add_merge(program, chosen);
  add_generate(program, chosen);
  add_import(program, chosen);
  add_tradeoff(program, chosen);
  add_feel(program, chosen);
  add_devices(program, chosen);
  add_serve(program, chosen);
  add_study(program, chosen);
  add_view(program, chosen, exit_code);
  add_upgrade(program, chosen);
  add_documents(program, chosen);
  add_memory_limit(program);
  add_plugins(program, plugins);
  for (CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    refuse_empty_numbers(*command);
    for (CLI::App* part : command->get_subcommands([](const CLI::App*) { return true; })) refuse_empty_numbers(*part);
  }
}

// Runs parse_and_work() and reports the exceptions that it throws.
static int guarded(int argc, char** argv) {
  try {
    return parse_and_work(argc, argv);
  } catch (const MachineFailure& failure) {
    return machine_failed(failure.message);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "catena: %s\n", out_of_memory_message());  // without allocation: memory is exhausted
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return 0;  // the output is lost: flush_output() reports that
    if (is_thread_start_failure(error)) return machine_failed("no other thread can be started: " + describe_errno(thread_start_errno()));
    return machine_failed(fmt::format("a resource of the system is not available: {}", error.what()));
  } catch (const std::exception& error) {
    if (is_thread_start_failure(error)) return machine_failed("no other thread can be started: " + describe_errno(thread_start_errno()));
    return machine_failed(fmt::format("ended by an unhandled error: {}", error.what()));
  }
  return 1;
}

int run(int argc, char** argv) {
  ms_since_process_start();
  retain_freed_memory();
  protect_inputs(true);
  field::set_read_progress(print_reading_progress);
  const std::string cache = user_folder("XDG_CACHE_HOME", ".cache");
  field::set_level_cache(cache.empty() ? cache : cache + "/levels", print_level_progress);
  scene::set_trace_progress(print_tracing_progress);
  render::set_page_progress(print_brick_progress);
  reserve_standard_descriptors();
  return flush_output(guarded(argc, argv));
}

}  // namespace catena::app
