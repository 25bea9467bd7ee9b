// SPDX-License-Identifier: MIT
/// catena study analyse DIR -o OUT: evaluates the trials of a data folder and writes tables, JSON and an HTML page.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/study/analyse/analysis.h"
#include "engine/app/study/study_commands.h"
#include "engine/app/tuning/report/results_dir.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "engine/study/protocol_deviations.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

struct AnalyseOptions {
  std::string data, output;
};

Result<std::vector<std::string>> draw(ResultsDir& folder, const analysis::Plots& plots) {
  return folder.draw_svg(plots.script, plots.files);
}

Outcome analyse_folder(const AnalyseOptions& options) {
  const std::string data = options.data;
  CATENA_TRY(const study::Study study, study::read_study((fs::path(data) / "study.json").string()));
  CATENA_TRY(const study::AnalysisPlan inquiry, study::read_analysis_plan(study));
  ProgressLine progress("study analyse", 4);
  CATENA_TRY(const study::TrialTable table, study::read_trial_table(data));
  const std::vector<study::TrialRow>& rows = table.rows;
  if (rows.empty()) return Error{one_line(data + ": there are no trials; at least one trial was expected")};
  progress.update(1);
  CATENA_TRY(analysis::Analysis result, analysis::analyze(study, inquiry, rows, data));
  CATENA_TRY(const std::vector<analysis::SubjectAnswers> answers, analysis::read_questionnaires(study, data, result.subjects));
  result.notes = table.notes;
  for (std::string& line : study::find_protocol_deviations(study, rows)) result.notes.push_back(std::move(line));
  progress.update(2);
  std::error_code code;
  const analysis::DataSource source{fs::weakly_canonical(data, code).filename().string(), study::is_simulated(data)};

  const std::vector<std::pair<std::string, std::string>> files{
      {"trials.csv", study::format_table(rows)},
      {"subjects.csv", analysis::subjects_csv(study, result)},
      {"means.csv", analysis::means_csv(study, result)},
      {"tests.csv", analysis::tests_csv(study, result)},
      {"correlations.csv", analysis::correlations_csv(study, result)},
      {"slopes.csv", analysis::slopes_csv(study, result)},
      {"rejections.csv", analysis::rejections_csv(study, result)},
      {"findings.csv", analysis::findings_csv(inquiry, result)},
      {"answers.csv", analysis::answers_csv(study, answers)},
      {"results.json", analysis::to_json(study, inquiry, result, source, answers)}};
  if (is_path_within(options.output, data))
    return Error{options.output + ": is in the data folder " + data + "; another folder was expected"};
  IoConflictChecker checked;
  checked.add_input_folder(data);
  if (fs::is_directory(options.output)) {
    for (const auto& [name, text] : files) checked.add_output("-o", options.output + "/" + name);
    checked.add_output("-o", options.output + "/report.html");
    CATENA_CHECK(checked.check());
  }
  CATENA_TRY(ResultsDir folder, ResultsDir::open(options.output));
  analysis::PlotImages drawn;
  CATENA_TRY(drawn.means, draw(folder, analysis::means_plots(study, result)));
  CATENA_TRY(drawn.correlations, draw(folder, analysis::correlation_plots(study, result)));
  CATENA_TRY(drawn.tradeoffs, draw(folder, analysis::tradeoff_plots(study, result)));
  progress.update(3);
  CATENA_CHECK(folder.add("report.html", analysis::to_html(study, inquiry, result, source, answers, drawn)));
  for (const auto& [name, text] : files) CATENA_CHECK(folder.add(name, text));
  CATENA_CHECK(folder.commit());

  const analysis::Rejections all = result.total_rejections();
  constexpr std::size_t kMaxTold = 10;
  for (std::size_t i = 0; i < std::min(kMaxTold, result.notes.size()); ++i) print_message("note: " + result.notes[i]);
  if (result.notes.size() > kMaxTold) print_message(fmt::format("note: {} more notes are in the page", result.notes.size() - kMaxTold));
  fmt::print("{} subject{}, {} trials, {} rejected\n", result.subjects.size(), result.subjects.size() == 1 ? "" : "s", all.trials,
             all.total());
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i)
    fmt::print("{}: {}\n", analysis::to_string(result.findings[i].verdict), sanitize_for_terminal(inquiry.findings[i].claim));
  if (source.is_simulated) fmt::print("{}\n", analysis::kSimulatedDataNotice);
  fmt::print("{}:", sanitize_for_terminal(options.output));
  for (const std::string& name : folder.file_names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_study_analyze(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<AnalyseOptions>();
  CLI::App* command = study.add_subcommand(
      "analyse", "analyses the trials of a data folder: tests, confidence intervals, plots, and a comparison with the paper's findings");
  command->add_option("DIR", options->data, "data folder: study.json and its trials")->type_name("FOLDER")->required();
  command->add_option("-o,--output", options->output, "folder for the page, the tables and the JSON")->type_name("FOLDER")->required();
  command->callback([&chosen, options] { chosen = [options] { return analyse_folder(*options); }; });
}

}  // namespace catena::app
