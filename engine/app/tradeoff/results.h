/// Where a figure's tables, gnuplot script and plots go: a folder that gets all of them or none.
/// They are made in a folder beside their places, DIR/tables.part<pid>-<random> (engine/base/output_file.h), and renamed at the end.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "haptics/chain/tick.h"

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
  bool first_ = true;
};

class ResultFolder {
 public:
  /// Creates the folder where it is missing.
  static Result<ResultFolder> open(const std::string& path);
  ~ResultFolder();
  ResultFolder(ResultFolder&& other) noexcept;
  ResultFolder& operator=(ResultFolder&&) = delete;

  Outcome add(const std::string& name, std::string_view text);
  /// Runs the program gnuplot on a script that was added, then adds the plots that it names. Where gnuplot is missing or fails
  /// there are none; says so in a line.
  Outcome plot(const std::string& script, const std::vector<std::string>& plots);
  /// Draws pictures of text (SVG) with gnuplot for a page, and keeps neither the script nor them as files. Empty where gnuplot is missing
  /// or fails.
  Result<std::vector<std::string>> draw(const std::string& script, const std::vector<std::string>& pictures);
  /// Everything to its place.
  Outcome commit();
  const std::vector<std::string>& names() const { return names_; }

 private:
  ResultFolder(std::string path, std::string staging, bool created);
  std::string path_, staging_;
  bool created_;
  std::vector<std::string> names_;
};

/// A scene written as text and the hand that feels it: the very tick of `replay`, step by step.
class Hand {
 public:
  /// The text is ours: a mistake in it is a bug.
  explicit Hand(const std::string& scene);
  const exchange::HapticState& at(double t_s, const Vec3& probe) {
    haptics::tick(*program_, {t_s, probe, 0}, *state_, *scratch_, out_);
    return out_;
  }

 private:
  std::shared_ptr<const haptics::Program> program_;
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  exchange::HapticState out_;
};

/// "[x, y, z]" as a scene file has it.
std::string to_json(const Vec3& v);

/// The figures that `catena tradeoff --figure N` measures: tables, a gnuplot script, plots.
///   2  drift of the linear follow mode and of higher-order methods from the streamline (section 4)
///   3  a penetrable surface and a curve: the baselines' one proxy beside the chain (section 5)
///   stiffness  the largest spring that a device can show, by damping, rate and delay, beside the passive limit
Outcome figure2(ResultFolder& folder);
Outcome figure3(ResultFolder& folder);
Outcome figure_stiffness(ResultFolder& folder);

}  // namespace catena::app
