// SPDX-License-Identifier: MIT
/// catena study simulate STUDY.json --subjects N -o DIR [--shard I/N] [--model NAME=NUMBER] [--record]: simulates sessions with the human
/// model, on all cores. Training trials are omitted: the model does not learn. Trials that the folder already holds are not repeated, so
/// that an interrupted run continues.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <mutex>

#include "engine/app/batch/shard.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/cli/plugins.h"
#include "engine/app/study/study_commands.h"
#include "engine/app/study/study_shards.h"
#include "engine/app/study/subject_folder.h"
#include "engine/base/clock.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/base/threads.h"
#include "engine/study/protocol_deviations.h"
#include "engine/study/simulated_trial.h"
#include "engine/study/trial_table.h"
#include "haptics/servo/log/writer.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string study, output;
  std::optional<std::string> shard;
  std::vector<std::string> model;
  int subjects = 0;
  bool record = false;
};

/// Replaces numbers in the study's "operator" (NAME=NUMBER), in its text, so that the data folder holds the study that was simulated.
Result<study::Study> study_with_model(const SimulateOptions& options) {
  CATENA_TRY(std::string text, read_text_file(options.study, "a study file (JSON)", kMaxJsonBytes));
  for (const std::string& one : options.model) {
    const std::size_t equals = one.find('=');
    const auto value = parse_double(equals == std::string::npos ? "" : one.substr(equals + 1));
    if (!value) return Error{"--model " + in_quotes(one) + ": NAME=NUMBER was expected, such as depth_noise_mm=4"};
    CATENA_TRY(text,
               json::set_value(text, options.study, "/operator/" + json::escape_pointer_token(one.substr(0, equals)), to_text(*value)));
  }
  return study::parse_study(text, options.study);
}

/// Writes the recordings of one subject, one trial after the other.
class Recordings {
 public:
  Recordings(const study::Study& study, const study::DataFolder& data) : study_(study), data_(data) {}

  Result<haptics::TickSink*> begin(const study::Trial& trial, const std::string& text, const haptics::HapticProgram& program) {
    haptics::log::LogHeader header;
    header.scene_path = study_.path;
    header.scene_text = text;
    header.device = "simulated hand";
    header.catena_version = kVersion;
    header.rate_hz = study::kSimulatedRateHz;
    header.about = trial_metadata_json(study_, trial);
    header.plugins = plugins_for_log();
    unfinished_ = data_.partial_recording_path(trial);
    CATENA_TRY(writer_, haptics::log::LogWriter::open(unfinished_, std::move(header)));
    writer_->add_program(program);
    return writer_.get();
  }
  /// A recording gets its final name once it is complete.
  Outcome end(const study::Trial& trial) {
    if (!writer_) return Done{};
    const auto writer = std::move(writer_);
    CATENA_CHECK(writer->finish());
    return data_.commit_recording(trial, std::exchange(unfinished_, {}));
  }
  ~Recordings() {
    std::error_code ignored;
    if (!unfinished_.empty()) fs::remove(unfinished_, ignored);
  }

 private:
  const study::Study& study_;
  const study::DataFolder& data_;
  std::string unfinished_;
  std::unique_ptr<haptics::log::LogWriter> writer_;
};

/// The trials that count, and those of them that the folder lacks.
struct Session {
  std::vector<study::Trial> trials;
  std::size_t done = 0;
};

Result<Session> session_in(const study::Study& study, const study::DataFolder& data, int subject) {
  Session session;
  for (const study::Trial& trial : study::make_session(study, subject))
    if (!trial.training) session.trials.push_back(trial);
  CATENA_TRY(const std::vector<study::TrialRow> rows, data.rows(subject));
  session.done = rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i >= session.trials.size() || !study::find_protocol_deviation(study, rows[i], session.trials[i]).empty())
      return Error{fmt::format("{}:{}: is not a trial of a simulated session; data of `study simulate` was expected",
                               study::subject_file(data.path(), subject), i + 2)};
  return session;
}

Outcome simulate_subject(const study::Study& study, const study::DataFolder& data, const Session& session, bool record,
                         const std::function<void()>& on_trial) {
  Recordings recordings(study, data);
  study::TrialSimulator::Recorder recorder;
  if (record)
    recorder = [&](const study::Trial& trial, const std::string& text, const haptics::HapticProgram& program) {
      return recordings.begin(trial, text, program);
    };
  study::TrialSimulator simulator(study, recorder);
  for (std::size_t i = session.done; i < session.trials.size(); ++i) {
    const study::Trial& trial = session.trials[i];
    const auto ran = simulator.run(trial);
    if (!ran)
      return Error{fmt::format("{} (subject {}, trial {})", ran.error().message, trial.subject, trial.index), ran.error().system_failure};
    const study::TrialResult& measured = *ran;
    if (!std::isfinite(measured.error_mm) || !std::isfinite(measured.traveled_mm) || !is_finite(measured.end_mm))
      return Error{fmt::format("{}: subject {}, trial {}: the model diverged; other numbers in \"operator\" were expected", study.path,
                               trial.subject, trial.index)};
    CATENA_CHECK(recordings.end(trial));
    CATENA_CHECK(data.append(study::make_row(study, trial, measured)));
    on_trial();
  }
  return Done{};
}

Outcome simulate(const SimulateOptions& options) {
  CATENA_TRY(const study::Study study, study_with_model(options));
  CATENA_TRY(const std::optional<Shard> given, parse_shard(options.shard));
  const Shard shard = given.value_or(Shard{});
  CATENA_CHECK(study::TrialSimulator(study).check());
  CATENA_TRY(const study::DataFolder data, study::DataFolder::open(options.output, study, study::ParticipantKind::model));
  if (options.record) CATENA_CHECK(study::make_folder(study::recordings_folder(data.path())));
  const int subjects = options.subjects > 0 ? options.subjects : study.subjects;
  if (given) CATENA_CHECK(write_shard_file(data.path(), shard, subjects));
  std::vector<Session> sessions;
  std::size_t todo = 0, all = 0;
  for (const std::size_t item : shard.items(static_cast<std::size_t>(subjects))) {
    CATENA_TRY(Session session, session_in(study, data, static_cast<int>(item) + 1));
    all += session.trials.size();
    todo += session.trials.size() - session.done;
    sessions.push_back(std::move(session));
  }

  const std::int64_t began = now_ns();
  ProgressLine progress("simulate", static_cast<double>(todo));
  std::mutex guard;
  std::size_t done = 0;
  std::optional<std::pair<std::size_t, Error>> fault;  // of the first subject with an error
  parallel_for(sessions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Outcome outcome = simulate_subject(study, data, sessions[i], options.record, [&] {
        const std::lock_guard lock(guard);
        progress.update(static_cast<double>(++done));
      });
      const std::lock_guard lock(guard);
      if (!outcome && (!fault || i < fault->first)) fault.emplace(i, outcome.error());
    }
  });
  if (fault) return fault->second;
  CATENA_CHECK(data.write_table());
  if (sessions.empty()) {
    fmt::print("{}\n", empty_shard_message(shard, static_cast<std::size_t>(subjects), "subjects"));
    return Done{};
  }
  fmt::print("{}: {} simulated subject{}, {} trials, {} of them computed in this run in {:.1f} s\n", sanitize_for_terminal(options.output),
             sessions.size(), sessions.size() == 1 ? "" : "s", all, todo, 1e-3 * ms_since(began));
  return Done{};
}

}  // namespace

void add_study_simulate(CLI::App& study, CommandAction& chosen) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = study.add_subcommand("simulate", "simulates the sessions of a study with a model of the subjects");
  command->add_option("STUDY", options->study, "study (.json)")->type_name("STUDY")->required();
  command->add_option("--subjects", options->subjects, "number of subjects (default: the number in the study)")
      ->type_name("N")
      ->check(CLI::Range(1, study::kMaxSubject));
  command->add_option("-o,--output", options->output, "data folder; trials of this study in the folder are kept and not repeated")
      ->type_name("FOLDER")
      ->required();
  add_shard_option(*command, options->shard, "subjects");
  command->add_option("--model", options->model, "replacement for a number in the study's \"operator\"")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  command->add_flag("--record", options->record, "records every tick of every trial: DIR/recordings/SUBJECT-TRIAL.catlog");
  command->callback([&chosen, options] { chosen = [options] { return simulate(*options); }; });
}

}  // namespace catena::app
