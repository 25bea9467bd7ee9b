// SPDX-License-Identifier: MIT
#include "engine/study/trial_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "engine/base/durable_append.h"
#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::study {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHeader =
    "subject,index,block,task,kind,dimensions,condition,stimulus,seed,training,ended,time_s,error_mm,travelled_mm,peak_force_n,end_x_mm,"
    "end_y_mm,end_z_mm";
constexpr std::size_t kColumns = 18;

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

Error fault_at(const std::string& file, int line, const std::string& what) {
  return Error{one_line(fmt::format("{}:{}: {}", file, line, what))};
}

Result<TrialRow> parse_row(std::string_view line, const std::string& file, int number) {
  const std::vector<std::string_view> cells = cells_of(line);
  if (cells.size() != kColumns)
    return fault_at(file, number, fmt::format("the row has {} cells; {} were expected", cells.size(), kColumns));
  TrialRow row;
  std::optional<std::size_t> bad;
  const auto non_negative = [&](std::size_t column, int& out) {
    const auto value = parse_integer(cells[column]);
    if (!value || *value < 0 || *value > std::numeric_limits<int>::max()) return void(bad = bad.value_or(column));
    out = static_cast<int>(*value);
  };
  const auto real = [&](std::size_t column, double& out) {
    const auto value = parse_double(cells[column]);
    if (!value || !std::isfinite(*value)) return void(bad = bad.value_or(column));
    out = *value;
  };
  const auto either = [&](std::size_t column, std::string_view no, std::string_view yes, bool& out) {
    if (cells[column] != no && cells[column] != yes) return void(bad = bad.value_or(column));
    out = cells[column] == yes;
  };
  const auto word = [&](std::size_t column, std::string& out) {
    if (cells[column].empty()) return void(bad = bad.value_or(column));
    out = std::string(cells[column]);
  };
  bool tracing = false;
  non_negative(0, row.subject), non_negative(1, row.index), non_negative(2, row.block);
  word(3, row.task);
  either(4, "advection", "tracing", tracing);
  row.kind = to_string(tracing ? TaskKind::tracing : TaskKind::advection);
  non_negative(5, row.dimensions);
  word(6, row.condition);
  non_negative(7, row.stimulus), non_negative(8, row.seed);
  either(9, "0", "1", row.training);
  either(10, "limit", "target", row.reached_target);
  real(11, row.time_s), real(12, row.error_mm), real(13, row.traveled_mm), real(14, row.peak_force_n);
  for (int axis = 0; axis < 3; ++axis) real(static_cast<std::size_t>(15 + axis), row.end_mm[axis]);
  if (bad)
    return fault_at(
        file, number,
        in_quotes(cells[*bad]) + " is not valid for the column " + std::string(cells_of(kHeader)[*bad]) + "; a valid value was expected");
  return row;
}

std::string table_of(const std::string& folder) { return (fs::path(folder) / "trials.csv").string(); }

/// Reads a subject's rows. `size` is the size of the file in bytes, `non_negative` the bytes of its complete rows.
Result<std::vector<TrialRow>> read_subject(const std::string& folder, int subject, std::size_t& complete_bytes, std::size_t& size) {
  const std::string path = subject_file(folder, subject);
  std::error_code code;
  if (fs::symlink_status(path, code).type() == fs::file_type::not_found) return std::vector<TrialRow>{};
  CATENA_TRY(const std::string text, read_text_file(path, "a table of trials"));
  size = text.size();
  CATENA_TRY(std::vector<TrialRow> rows, parse_rows(text, path, true, &complete_bytes));
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].subject != subject)
      return fault_at(path, static_cast<int>(i) + 2,
                      fmt::format("the trial belongs to subject {}; subject {} was expected", rows[i].subject, subject));
  return rows;
}

/// Returns the rows of all subjects, in the order of their numbers.
Result<std::vector<TrialRow>> rows_of_subjects(const std::string& folder, std::vector<std::string>* notes = nullptr) {
  CATENA_TRY(const std::vector<int> numbers, list_subjects(folder, notes));
  std::vector<TrialRow> all;
  for (const int subject : numbers) {
    CATENA_TRY(const std::vector<TrialRow> some, read_rows(folder, subject, notes));
    if (some.empty() && notes != nullptr) notes->push_back(subject_file(folder, subject) + ": the file has no completed trial");
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Flushes a folder to the disk: a new file's name is durable only after that.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

std::string simulated_marker(const std::string& folder) { return (fs::path(folder) / "simulated.json").string(); }

}  // namespace

TrialRow make_row(const Study& study, const Trial& trial, const TrialResult& measured) {
  const Task& task = study.tasks[static_cast<std::size_t>(trial.task)];
  return {.subject = trial.subject,
          .index = trial.index,
          .block = trial.block,
          .task = task.name,
          .kind = to_string(task.kind),
          .dimensions = task.dimensions,
          .condition = study.conditions[static_cast<std::size_t>(trial.condition)].name,
          .stimulus = trial.stimulus,
          .seed = trial.seed,
          .training = trial.training,
          .reached_target = measured.reached_target,
          .time_s = measured.time_s,
          .error_mm = measured.error_mm,
          .traveled_mm = measured.traveled_mm,
          .peak_force_n = measured.peak_force_n,
          .end_mm = measured.end_mm};
}

std::string table_header() { return fmt::format("{}\n", kHeader); }

std::string format_table(const std::vector<TrialRow>& rows) {
  std::string text = table_header();
  for (const TrialRow& row : rows) text += format_row(row);
  return text;
}

std::string format_row(const TrialRow& row) {
  std::string text = fmt::format("{},{},{},{},{},{},{},{},{},{},{}", row.subject, row.index, row.block, row.task, row.kind, row.dimensions,
                                 row.condition, row.stimulus, row.seed, row.training ? 1 : 0, row.reached_target ? "target" : "limit");
  for (const double value : {row.time_s, row.error_mm, row.traveled_mm, row.peak_force_n, row.end_mm.x, row.end_mm.y, row.end_mm.z}) {
    text += ',';
    append_number(text, value);
  }
  return text + "\n";
}

Result<std::vector<TrialRow>> parse_rows(std::string_view text, const std::string& file, bool allow_partial_line,
                                         std::size_t* complete_bytes) {
  std::vector<TrialRow> rows;
  const auto lines = static_cast<double>(std::count(text.begin(), text.end(), '\n'));
  CATENA_CHECK(check_text_memory_available(one_line(fmt::format("{}: a table of {} rows", file, lines)), lines * 2 * sizeof(TrialRow)));
  std::size_t at = 0;
  int number = 0;
  if (complete_bytes != nullptr) *complete_bytes = 0;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos && allow_partial_line) break;
    std::string_view line = text.substr(at, end == std::string_view::npos ? end : end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number;
    if (number == 1) {
      if (cells_of(line) != cells_of(kHeader)) return fault_at(file, 1, "the header is wrong; " + std::string(kHeader) + " was expected");
    } else if (!trim(line).empty()) {
      CATENA_TRY(TrialRow row, parse_row(line, file, number));
      rows.push_back(std::move(row));
    }
    at = end == std::string_view::npos ? text.size() : end + 1;
    if (complete_bytes != nullptr) *complete_bytes = at;
  }
  if (number == 0 && !allow_partial_line) return fault_at(file, 1, "the file is empty; a header was expected");
  return rows;
}

std::string subject_file(const std::string& folder, int subject) {
  return (fs::path(folder) / "subjects" / fmt::format("{:03}.csv", subject)).string();
}

std::string recordings_folder(const std::string& folder) { return (fs::path(folder) / "recordings").string(); }

Outcome make_folder(const std::string& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code) return system_error(path + ": cannot create the folder", code.value());
  return Done{};
}

std::string recording_file(const std::string& folder, const Trial& trial) {
  return (fs::path(recordings_folder(folder)) / fmt::format("{:03}-{:03}.catlog", trial.subject, trial.index)).string();
}

Result<std::vector<int>> list_subjects(const std::string& folder, std::vector<std::string>* notes) {
  std::vector<int> numbers;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(folder) / "subjects", code)) {
    const auto number = parse_integer(entry.path().stem().string());
    const bool is_one =
        number && *number >= 1 && *number <= kMaxSubject && entry.path().string() == subject_file(folder, static_cast<int>(*number));
    if (is_one)
      numbers.push_back(static_cast<int>(*number));
    else if (notes != nullptr && entry.path().string().find(".csv.part") == std::string::npos)
      notes->push_back(one_line(entry.path().string()) + ": this is not the file of a subject and was left out");
  }
  if (code && code != std::errc::no_such_file_or_directory) return system_error(folder + ": cannot read the folder", code.value());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

Result<std::vector<TrialRow>> read_rows(const std::string& folder, int subject, std::vector<std::string>* notes) {
  std::size_t complete_bytes = 0, size = 0;
  CATENA_TRY(std::vector<TrialRow> rows, read_subject(folder, subject, complete_bytes, size));
  if (complete_bytes < size && notes != nullptr)
    notes->push_back(subject_file(folder, subject) + ": the last line is incomplete and was left out");
  return rows;
}

Result<DataFolder> DataFolder::open(const std::string& path, const Study& study, ParticipantKind participant_kind) {
  const std::string copy = (fs::path(path) / "study.json").string();
  std::error_code code;
  const bool is_new = !fs::exists(copy, code);
  if (!is_new) {
    CATENA_TRY(const std::string old, read_text_file(copy, "the study of this data folder", kMaxJsonBytes));
    if (old != study.text)
      return Error{fmt::format("{}: the folder contains data of another study ({} differs from {}); another folder was expected", path,
                               copy, study.path)};
  }
  CATENA_TRY(const std::vector<int> subjects, list_subjects(path));
  const bool simulated = is_simulated(path);
  if (participant_kind == ParticipantKind::people && simulated)
    return Error{path + ": the folder contains trials of a model; another folder was expected for trials of people"};
  if (participant_kind == ParticipantKind::model && !simulated && !subjects.empty())
    return Error{path + ": the folder contains trials of people; another folder was expected for trials of a model"};
  CATENA_CHECK(make_folder((fs::path(path) / "subjects").string()));
  CATENA_TRY(FolderLock lock, FolderLock::acquire(path));
  const auto write = [](const std::string& file, const std::string& text) -> Outcome {
    CATENA_TRY(OutputFile out, OutputFile::open(file));
    out.write(text);
    out.sync();
    return out.commit();
  };
  if (is_new) CATENA_CHECK(write(copy, study.text));
  if (participant_kind == ParticipantKind::model && !simulated)
    CATENA_CHECK(write(simulated_marker(path), "{\"simulated\": true, \"by\": \"the human model of study.json, not a person\"}\n"));
  return DataFolder(path, std::move(lock));
}

Result<std::vector<TrialRow>> DataFolder::rows(int subject) const {
  std::size_t complete_bytes = 0, size = 0;
  CATENA_TRY(std::vector<TrialRow> rows, read_subject(path_, subject, complete_bytes, size));
  const std::string path = subject_file(path_, subject);
  if (complete_bytes < size && ::truncate(path.c_str(), static_cast<off_t>(complete_bytes)) != 0)
    return system_error(path + ": cannot remove the incomplete last line", errno);
  return rows;
}

Outcome DataFolder::append(const TrialRow& row) const {
  return append_durably(subject_file(path_, row.subject), table_header(), format_row(row));
}

Outcome DataFolder::write_subject(int subject, const std::vector<TrialRow>& rows) const {
  CATENA_TRY(OutputFile file, OutputFile::open(subject_file(path_, subject)));
  file.write(format_table(rows));
  file.sync();
  return file.commit();
}

std::string DataFolder::partial_recording_path(const Trial& trial) const {
  const std::string recording = recording_file(path_, trial);
  remove_stale_temporaries(recording);
  return temporary_name(recording);
}

Outcome DataFolder::commit_recording(const Trial& trial, const std::string& unfinished) const {
  const std::string recording = recording_file(path_, trial);
  if (std::rename(unfinished.c_str(), recording.c_str()) != 0) return system_error(recording + ": cannot write", errno);
  sync_folder(recordings_folder(path_));
  return Done{};
}

Outcome DataFolder::write_table() const {
  CATENA_TRY(const std::vector<TrialRow> all, rows_of_subjects(path_));
  CATENA_TRY(OutputFile file, OutputFile::open(table_of(path_)));
  file.write(format_table(all));
  return file.commit();
}

Result<TrialTable> read_trial_table(const std::string& folder) {
  TrialTable table;
  CATENA_TRY(table.rows, rows_of_subjects(folder, &table.notes));
  const std::string path = table_of(folder);
  std::error_code code;
  if (!fs::exists(path, code)) {
    if (table.rows.empty()) return Error{folder + ": no trials.csv and no trials in subjects/*.csv; a data folder of a study was expected"};
    return table;
  }
  CATENA_TRY(const std::string text, read_text_file(path, "a table of trials"));
  if (table.rows.empty()) {
    CATENA_TRY(table.rows, parse_rows(text, path));
  } else if (text != format_table(table.rows)) {
    table.notes.push_back(path + ": differs from subjects/*.csv, which are analysed");
  }
  return table;
}

bool is_simulated(const std::string& folder) {
  std::error_code code;
  return fs::exists(simulated_marker(folder), code);
}

}  // namespace catena::study
