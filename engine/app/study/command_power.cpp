// SPDX-License-Identifier: MIT
/// catena study power STUDY.json --effect D [--power P] [--alpha A]: number of subjects needed to find a difference of that size.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/options.h"
#include "engine/app/study/study_commands.h"
#include "engine/study/statistics/power.h"
#include "engine/study/study.h"

namespace catena::app {

namespace {

struct PowerOptions {
  std::string study;
  double effect = 0, power = 0.8, alpha = 0.05;
};

Outcome print_power(const PowerOptions& options) {
  const double size = std::fabs(options.effect);
  if (!(size >= 0.01 && size <= 10)) return Error{fmt::format("--effect {:g}: a d_z of 0.01 to 10 was expected", options.effect)};
  if (!(options.alpha >= 1e-6 && options.alpha <= 0.5)) return Error{fmt::format("--alpha {:g}: 1e-6 to 0.5 was expected", options.alpha)};
  if (!(options.power > options.alpha && options.power <= 0.9999))
    return Error{fmt::format("--power {:g}: more than alpha and at most 0.9999 was expected", options.power)};
  CATENA_TRY(const study::Study study, study::read_study(options.study));
  fmt::print(
      "{}: paired, two-sided t-tests over subjects; d_z = {:g} (mean difference divided by the standard deviation of the differences)\n",
      study.name, options.effect);
  // the tests of conditions are one family: every task and other condition, mean and deviation of error and time
  const int family = static_cast<int>(study.tasks.size()) * (static_cast<int>(study.conditions.size()) - 1) * 4;
  const auto line = [&](double alpha, const std::string& what) -> Outcome {
    CATENA_TRY(const int needed, statistics::required_subjects(size, options.power, alpha));
    fmt::print("{}: {} subjects for a power of {:g}", what, needed, options.power);
    if (study.subjects >= 2)
      fmt::print("; the design's {} subjects have a power of {:.3f}", study.subjects,
                 statistics::paired_power(size, study.subjects, alpha));
    fmt::print("\n");
    return Done{};
  };
  CATENA_CHECK(line(options.alpha, fmt::format("one test at alpha = {:g}", options.alpha)));
  if (family > 1) CATENA_CHECK(line(options.alpha / family, fmt::format("the strictest of {} tests corrected by Holm's method", family)));
  return Done{};
}

}  // namespace

void add_study_power(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<PowerOptions>();
  CLI::App* command =
      study.add_subcommand("power", "computes the number of subjects that a design needs to find a difference of a given size");
  command->add_option("STUDY", options->study, "study (.json)")->type_name("STUDY")->required();
  command->add_option("--effect", options->effect, "effect size d_z: mean of the differences divided by their standard deviation")
      ->type_name("D_Z")
      ->check(accepted("0.01 to 10"))
      ->required();
  command->add_option("--power", options->power, "probability of finding the difference")
      ->type_name("POWER")
      ->check(accepted("--alpha < P <= 0.9999"))
      ->capture_default_str();
  command->add_option("--alpha", options->alpha, "significance level: probability of a false finding")
      ->type_name("ALPHA")
      ->check(accepted("1e-6 to 0.5"))
      ->capture_default_str();
  command->callback([&chosen, options] { chosen = [options] { return print_power(*options); }; });
}

}  // namespace catena::app
