/// The instructions of a study: a text file that anybody can write and translate. Pure functions, any thread.
///
///   # introduction                 a line "# NAME" begins the pages of a moment: "introduction", "before TASK" (a task of the study,
///   before Welcome                        its first trial), "end" (after the questionnaire); a moment without pages is passed over
///
///   You will see ...
///   ---                            a line of at least three hyphens ends a page
///   The hand                       the first line of a page is its heading
///   ...
/// Lines that follow each other are one paragraph, whatever their length; a blank line ends it. A line that begins with "- " begins one,
/// too.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

struct InstructionPage {
  std::string heading;
  std::vector<std::string> paragraphs;
  bool operator==(const InstructionPage&) const = default;
};

struct Instructions {
  struct TaskPages {
    std::string task;
    std::vector<InstructionPage> pages;
  };
  std::vector<InstructionPage> introduction, end;
  std::vector<TaskPages> task_pages;

  /// None where the file says nothing of this task.
  const std::vector<InstructionPage>& pages_before_task(const std::string& task) const;
};

/// `tasks`: the study's. The error names file and line: a moment that is none, a page without a heading, text before the first moment.
Result<Instructions> parse_instructions(std::string_view text, const std::string& file, const std::vector<std::string>& tasks);
Result<Instructions> read_instructions(const std::string& path, const std::vector<std::string>& tasks);

}  // namespace catena::app
