// SPDX-License-Identifier: MIT
#include "engine/app/tuning/report/results_dir.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "engine/base/input_files.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::app {

namespace fs = std::filesystem;

namespace {

constexpr int kMissing = 127;

/// Runs gnuplot without its messages and returns its exit code; kMissing if the program is not installed.
int run_gnuplot(const std::string& folder, const std::string& script) {
  const pid_t child = ::fork();
  if (child < 0) return kMissing;
  if (child == 0) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
    ::_exit(kMissing);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return kMissing;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

CsvTable& CsvTable::add(std::string_view word) {
  if (!at_row_start_) text_ += ',';
  at_row_start_ = false;
  text_ += word;
  return *this;
}

CsvTable& CsvTable::add(double number) { return add(to_text(number)); }

void CsvTable::end_row() {
  text_ += '\n';
  at_row_start_ = true;
}

std::string csv_text(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return one_line(text);
}

ResultsDir::ResultsDir(ResultsDir&& other) noexcept
    : path_(std::move(other.path_)),
      staging_(std::move(other.staging_)),
      lock_(std::move(other.lock_)),
      created_(other.created_),
      names_(std::move(other.names_)) {
  other.staging_.clear();
  other.created_ = false;
}

ResultsDir::~ResultsDir() { remove_staging(); }

void ResultsDir::remove_staging() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (created_) fs::remove(path_, ignored);  // succeeds only if the folder is empty
  staging_.clear();
  lock_.reset();
  created_ = false;
}

Outcome ResultsDir::create_staging() {
  if (!staging_.empty()) return Done{};
  std::error_code code;
  const bool created = !fs::exists(path_, code);
  if (created && !fs::create_directories(path_, code) && code) return system_error(path_ + ": cannot create the folder", code.value());
  created_ = created;
  const std::string staged = path_ + "/tables", staging = temporary_name(staged);
  remove_stale_temporaries(staged);
  if (::mkdir(staging.c_str(), 0777) != 0) return system_error(path_ + ": cannot write into the folder", errno);
  staging_ = staging;
  if (auto lock = FolderLock::acquire(staging)) lock_.emplace(std::move(*lock));
  return Done{};
}

Result<ResultsDir> ResultsDir::open(const std::string& path) {
  std::error_code code;
  if (path.empty()) return Error{"the name of the output is empty; a folder was expected"};
  if (fs::exists(path, code) && !fs::is_directory(path, code)) return Error{path + ": is a file; a folder was expected"};
  ResultsDir folder(path);
  CATENA_CHECK(folder.create_staging());
  folder.remove_staging();
  return folder;
}

Outcome ResultsDir::add(const std::string& name, std::string_view text) {
  CATENA_CHECK(create_staging());
  const auto write = [&]() -> Outcome {
    CATENA_TRY(OutputFile file, OutputFile::open(staging_ + "/" + name));
    file.write(text);
    return file.commit();
  };
  if (const Outcome written = write(); !written) {
    // reported with the final name: the temporary directory is removed
    Error error = written.error();
    if (error.message.starts_with(staging_)) error.message.replace(0, staging_.size(), path_);
    return error;
  }
  names_.push_back(name);
  return Done{};
}

Outcome ResultsDir::add_plots(const std::string& script, const std::vector<std::string>& plots) {
  const int code = run_gnuplot(staging_, script);
  if (code != 0) {
    fmt::print("no plots: gnuplot {}; the tables are complete, and `gnuplot {}` in {} makes the plots\n",
               code == kMissing ? "is not installed" : "failed", script, sanitize_for_terminal(path_));
    return Done{};
  }
  for (const std::string& name : plots) {
    if (!fs::exists(staging_ + "/" + name)) return Error{path_ + "/" + name + ": gnuplot did not write this file"};
    names_.push_back(name);
  }
  return Done{};
}

Result<std::vector<std::string>> ResultsDir::draw_svg(const std::string& script, const std::vector<std::string>& image_files) {
  std::vector<std::string> drawn;
  if (image_files.empty()) return drawn;
  CATENA_CHECK(create_staging());
  CATENA_TRY(OutputFile file, OutputFile::open(staging_ + "/draw.gp"));
  file.write(script);
  CATENA_CHECK(file.commit());
  if (run_gnuplot(staging_, "draw.gp") != 0) return drawn;
  for (const std::string& name : image_files) {
    CATENA_TRY(const std::string text, read_text_file(staging_ + "/" + name, "an image by gnuplot"));
    // without the lines before the <svg> element, which an HTML page must not contain
    const auto begin = text.find("<svg");
    if (begin != std::string::npos) drawn.push_back(text.substr(begin));
  }
  return drawn;
}

Outcome ResultsDir::commit() {
  for (const std::string& name : names_) {
    std::error_code code;
    CATENA_CHECK(check_not_input(path_ + "/" + name));
    if (fs::is_directory(path_ + "/" + name, code)) return Error{path_ + "/" + name + ": is a folder; a file name was expected"};
  }
  for (const std::string& name : names_) {
    std::error_code code;
    fs::rename(staging_ + "/" + name, path_ + "/" + name, code);
    if (code) return system_error(path_ + "/" + name + ": cannot write", code.value());
  }
  created_ = false;
  return Done{};
}

}  // namespace catena::app
