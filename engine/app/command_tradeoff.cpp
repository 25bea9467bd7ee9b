/// catena tradeoff --figure 2|3|stiffness -o DIR
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/command.h"
#include "engine/app/tradeoff/results.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

struct TradeoffOptions {
  std::string figure, output;
};

Outcome tradeoff(const TradeoffOptions& options) {
  if (options.figure.empty())
    return Error{
        "tradeoff: expected --figure 2 (drift of the methods from a streamline) or --figure 3 (a penetrable surface and a curve: "
        "the chain beside its baselines) or --figure stiffness (the largest spring by damping, rate and delay)"};
  CATENA_TRY(ResultFolder folder, ResultFolder::open(options.output));
  CATENA_CHECK(options.figure == "2" ? figure2(folder) : options.figure == "3" ? figure3(folder) : figure_stiffness(folder));
  CATENA_CHECK(folder.commit());
  fmt::print("{}:", printable(options.output));
  for (const std::string& name : folder.names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_tradeoff(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<TradeoffOptions>();
  CLI::App* command = program.add_subcommand("tradeoff", "the figures of the paper, and of the device's stability, as tables and plots");
  command
      ->add_option("--figure", options->figure,
                   "2: drift from a streamline; 3: a penetrable surface and a curve; stiffness: the largest spring")
      ->check(CLI::IsMember({"2", "3", "stiffness"}));
  command->add_option("-o,--output", options->output, "a folder for tables (CSV), the gnuplot script and plots (PNG)")->required();
  command->callback([&chosen, options] { chosen = [options] { return tradeoff(*options); }; });
}

}  // namespace catena::app
