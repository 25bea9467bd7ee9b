// SPDX-License-Identifier: MIT
/// catena tradeoff SCENE|FILE -o DIR [--effort quick|default|thorough] [--compare OTHER.json] [--shard I/N]: error against cost for the
/// settings of a scene. catena tradeoff --figure 2|3|stiffness|energy -o DIR: figures of the paper.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/batch/shard.h"
#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/tuning/figures/figures.h"
#include "engine/app/tuning/measure/measure_tradeoffs.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

struct TradeoffOptions : MeasureOptions {
  std::string figure;
};

Outcome run_tradeoff(const TradeoffOptions& options) {
  if (!options.source.empty() && !options.figure.empty()) return Error{"--figure was given with a SOURCE; a figure has its own scenes"};
  if (!options.source.empty()) return measure_tradeoffs(options);
  if (options.shard) return Error{"--shard: a figure is made by one process; a scene or a data file was expected"};
  if (options.figure.empty())
    return Error{
        "tradeoff: a scene or a data file was expected, or --figure 2 (drift of the methods from a streamline), --figure 3 (chain and "
        "baselines on a penetrable surface and a curve), --figure stiffness (maximum stiffness against damping, rate and delay) or "
        "--figure "
        "energy (energy gain of a closed loop)"};
  CATENA_TRY(ResultsDir folder, ResultsDir::open(options.output));
  CATENA_CHECK(options.figure == "2"           ? figure2(folder)
               : options.figure == "3"         ? figure3(folder)
               : options.figure == "stiffness" ? figure_stiffness(folder)
                                               : figure_energy(folder));
  CATENA_CHECK(folder.commit());
  fmt::print("{}:", sanitize_for_terminal(options.output));
  for (const std::string& name : folder.file_names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_tradeoff(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<TradeoffOptions>();
  CLI::App* command =
      program.add_subcommand("tradeoff", "measures error against cost for the settings of a scene, or makes figures of the paper");
  add_source(*command, "SOURCE", options->source,
             "scene (.json) or data file to measure, or the tradeoff.json of an earlier run, whose page is written anew")
      ->type_name("FILE");
  command
      ->add_option("--figure", options->figure,
                   "figure to make instead: 2: drift from a streamline; 3: a penetrable surface and a curve; stiffness: the maximum "
                   "stiffness; energy: energy gain of a closed loop")
      ->type_name("WORD")
      ->check(CLI::IsMember({"2", "3", "stiffness", "energy"}));
  command->add_option("-o,--output", options->output, "folder for the page and the tables, or for the script and the plots of a figure")
      ->type_name("FOLDER")
      ->required();
  command
      ->add_option("--effort", options->effort,
                   "extent of the measurement: quick takes at most 2 minutes, default about 5, thorough up to 20 with larger images and "
                   "more repetitions")
      ->type_name("WORD")
      ->check(CLI::IsMember({"quick", "default", "thorough"}))
      ->capture_default_str();
  command->add_option("--compare", options->compare, "tradeoff.json of another machine or version, shown side by side")
      ->type_name("FILE.json");
  command->add_option("--probe", options->probe, "probe path for the measurement: t,x,y,z[,buttons] (default: a path along the first link)")
      ->type_name("PROBE.csv");
  command->add_option("--only", options->only, "measurements to make (default: all)")
      ->type_name("WORD")
      ->delimiter(',')
      ->check(CLI::IsMember(measurement_names()));
  command->add_option("--grid", options->grid, "field of a data file to measure (default: the first scalar field, or else the first field)")
      ->type_name("GRID");
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  add_shard_option(*command, options->shard, "measurements");
  command->callback([&chosen, options] { chosen = [options] { return run_tradeoff(*options); }; });
}

}  // namespace catena::app
