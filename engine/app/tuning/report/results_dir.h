// SPDX-License-Identifier: MIT
/// Output folder for the tables, plots and HTML page of a run, written atomically: the folder gets all of the files or none.
/// The files are first written to a temporary folder inside it, DIR/tables.part<pid>-<random> (engine/base/output_file.h), and moved by
/// commit(). A temporary folder that a killed run left behind is removed by the next run, which recognizes it by its released lock.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/folder_lock.h"
#include "engine/base/result.h"

namespace catena::app {

/// A CSV table under construction, with text and numbers; the numbers read back exactly.
class CsvTable {
 public:
  explicit CsvTable(const std::string& header) : text_(header + "\n") {}
  CsvTable& add(std::string_view word);
  CsvTable& add(double number);
  void end_row();
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool at_row_start_ = true;
};

/// Returns text usable as a table cell: one line, with commas replaced by semicolons, since Catena's tables have no quoting.
std::string csv_text(std::string text);

/// Collects the files of one run and commits them together. Movable; the destructor removes files that were not committed.
class ResultsDir {
 public:
  /// Checks that the folder can be written to, creating it for the test and removing it afterwards, so that an aborted run leaves nothing.
  /// An Error if `path` is empty, a file, or not writable.
  static Result<ResultsDir> open(const std::string& path);
  ~ResultsDir();
  ResultsDir(ResultsDir&& other) noexcept;
  ResultsDir& operator=(ResultsDir&&) = delete;

  /// Writes a file to the temporary folder. An Error if it cannot be written.
  Outcome add(const std::string& name, std::string_view text);
  /// Runs gnuplot on a script that was added and adds the plots it writes. If gnuplot is missing or fails, prints one line and adds none.
  /// An Error if gnuplot succeeds but a file of `plots` is missing.
  Outcome add_plots(const std::string& script, const std::vector<std::string>& plots);
  /// Renders plots with gnuplot and returns their SVG text for an HTML page; neither the script nor the files in `image_files` are kept.
  /// Returns an empty list if gnuplot is missing or fails.
  Result<std::vector<std::string>> draw_svg(const std::string& script, const std::vector<std::string>& image_files);
  /// Moves all files to the output folder. An Error if a target is an input file or a folder, or cannot be written.
  Outcome commit();
  const std::vector<std::string>& file_names() const { return names_; }

 private:
  explicit ResultsDir(std::string path) : path_(std::move(path)) {}
  /// Creates the output folder if it is missing, and the temporary folder. An Error if the system refuses.
  Outcome create_staging();
  void remove_staging();
  std::string path_, staging_;
  std::optional<FolderLock> lock_;  ///< Lock on staging_.
  bool created_ = false;
  std::vector<std::string> names_;
};

}  // namespace catena::app
