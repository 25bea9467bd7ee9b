/// Where the tables, plots and the page of a run go: a folder that gets all of them or none.
/// They are made in a folder beside their places, DIR/tables.part<pid>-<random> (engine/base/output_file.h), and renamed at the end. What a
/// run that was killed left there is removed by the next, by the lock that it does not hold any more.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/folder_lock.h"
#include "engine/base/result.h"

namespace catena::app {

/// A CSV in the making: words and numbers that read back exactly.
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

/// Text as a cell: a table of Catena's knows no quotes, so commas become semicolons.
std::string csv_text(std::string text);

class ResultsDir {
 public:
  /// An error where it could not be written; what that is tried with is gone again, so that a run that is ended leaves nothing.
  static Result<ResultsDir> open(const std::string& path);
  ~ResultsDir();
  ResultsDir(ResultsDir&& other) noexcept;
  ResultsDir& operator=(ResultsDir&&) = delete;

  Outcome add(const std::string& name, std::string_view text);
  /// Runs the program gnuplot on a script that was added, then adds the plots that it names. Where gnuplot is missing or fails
  /// there are none; says so in a line.
  Outcome add_plots(const std::string& script, const std::vector<std::string>& plots);
  /// Draws pictures of text (SVG) with gnuplot for a page, and keeps neither the script nor them as files. Empty where gnuplot is missing
  /// or fails.
  Result<std::vector<std::string>> draw_svg(const std::string& script, const std::vector<std::string>& pictures);
  /// Everything to its place.
  Outcome commit();
  const std::vector<std::string>& file_names() const { return names_; }

 private:
  explicit ResultsDir(std::string path) : path_(std::move(path)) {}
  /// Creates both folders where they are missing.
  Outcome create_staging();
  void remove_staging();
  std::string path_, staging_;
  std::optional<FolderLock> lock_;  ///< of staging_
  bool created_ = false;
  std::vector<std::string> names_;
};

}  // namespace catena::app
