/// catena study analyse DIR -o OUT: what the trials of a data folder say, as tables, JSON and a page.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/app/report/folder.h"
#include "engine/app/run_files.h"
#include "engine/app/study/analyse/analysis.h"
#include "engine/app/study/study_command.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/study/departures.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

struct AnalyseOptions {
  std::string data, output;
};

Result<std::vector<std::string>> draw(ResultFolder& folder, const analysis::Plots& plots) { return folder.draw(plots.script, plots.files); }

Outcome analyse_folder(const AnalyseOptions& options) {
  const std::string data = options.data;
  CATENA_TRY(const study::Study study, study::read_study((fs::path(data) / "study.json").string()));
  CATENA_TRY(const study::Inquiry inquiry, study::read_inquiry(study));
  Progress progress("study analyse", 4);
  CATENA_TRY(const study::TrialTable table, study::read_table(data));
  const std::vector<study::Row>& rows = table.rows;
  if (rows.empty()) return Error{one_line(data + ": there are no trials; at least one was expected")};
  progress.at(1);
  CATENA_TRY(analysis::Analysis result, analysis::analyse(study, inquiry, rows, data));
  CATENA_TRY(const std::vector<analysis::Answered> answers, analysis::read_questionnaires(study, data, result.subjects));
  result.notes = table.notes;
  for (std::string& line : study::departures(study, rows)) result.notes.push_back(std::move(line));
  progress.at(2);
  std::error_code code;
  const analysis::Source source{fs::weakly_canonical(data, code).filename().string(), study::is_simulated(data)};

  const std::vector<std::pair<std::string, std::string>> files{
      {"trials.csv", study::table_text(rows)},
      {"subjects.csv", analysis::subjects_csv(study, result)},
      {"means.csv", analysis::means_csv(study, result)},
      {"tests.csv", analysis::tests_csv(study, result)},
      {"correlations.csv", analysis::correlations_csv(study, result)},
      {"slopes.csv", analysis::slopes_csv(study, result)},
      {"rejections.csv", analysis::rejections_csv(study, result)},
      {"findings.csv", analysis::findings_csv(inquiry, result)},
      {"answers.csv", analysis::answers_csv(study, answers)},
      {"results.json", analysis::to_json(study, inquiry, result, source, answers)}};
  if (lies_within(options.output, data))
    return Error{options.output + ": lies in the data folder " + data + "; another place was expected"};
  RunFiles checked;
  checked.reads_folder(data);
  if (fs::is_directory(options.output)) {
    for (const auto& [name, text] : files) checked.writes("-o", options.output + "/" + name);
    checked.writes("-o", options.output + "/report.html");
    CATENA_CHECK(checked.check());
  }
  CATENA_TRY(ResultFolder folder, ResultFolder::open(options.output));
  analysis::Drawn drawn;
  CATENA_TRY(drawn.means, draw(folder, analysis::means_plots(study, result)));
  CATENA_TRY(drawn.correlations, draw(folder, analysis::correlation_plots(study, result)));
  CATENA_TRY(drawn.trade, draw(folder, analysis::trade_plots(study, result)));
  progress.at(3);
  CATENA_CHECK(folder.add("report.html", analysis::to_html(study, inquiry, result, source, answers, drawn)));
  for (const auto& [name, text] : files) CATENA_CHECK(folder.add(name, text));
  CATENA_CHECK(folder.commit());

  const analysis::Rejections all = result.all_rejected();
  constexpr std::size_t kMostTold = 10;
  for (std::size_t i = 0; i < std::min(kMostTold, result.notes.size()); ++i) tell_from_catena("note: " + result.notes[i]);
  if (result.notes.size() > kMostTold) tell_from_catena(fmt::format("note: and {} more, in the page", result.notes.size() - kMostTold));
  fmt::print("{} subject{}, {} trials, {} left out\n", result.subjects.size(), result.subjects.size() == 1 ? "" : "s", all.trials,
             all.rejected());
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i)
    fmt::print("{}: {}\n", analysis::verdict_word(result.findings[i].verdict), printable(inquiry.findings[i].paper));
  if (source.simulated) fmt::print("{}\n", analysis::kModelSentence);
  fmt::print("{}:", printable(options.output));
  for (const std::string& name : folder.names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_study_analyse(CLI::App& study, Work& chosen) {
  auto options = std::make_shared<AnalyseOptions>();
  CLI::App* command =
      study.add_subcommand("analyse", "what the trials of a data folder say: tests, intervals, plots, each of the paper's findings");
  command->add_option("DIR", options->data, "the data folder: study.json and its trials")->required();
  command->add_option("-o,--output", options->output, "a folder for the page, the tables and the JSON")->required();
  command->callback([&chosen, options] { chosen = [options] { return analyse_folder(*options); }; });
}

}  // namespace catena::app
