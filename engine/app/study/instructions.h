// SPDX-License-Identifier: MIT
/// The instructions of a study: a text file that the experimenter writes and translates. Pure functions, any thread.
///
///   # introduction                 a line "# NAME" starts the pages of a section: "introduction", "before TASK" (before the first trial of
///                                  that task), "end" (after the questionnaire); a section without pages is skipped
///   Welcome                        the first line of a page is its heading
///
///   You will see ...
///   ---                            a line of at least three hyphens ends a page
///   The hand
///   ...
/// Consecutive lines form one paragraph, whatever their length; a blank line ends it. A line that starts with "- " starts a new paragraph.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

/// One page of instructions.
struct InstructionPage {
  std::string heading;
  std::vector<std::string> paragraphs;
  bool operator==(const InstructionPage&) const = default;
};

/// All pages, by section.
struct Instructions {
  struct TaskPages {
    std::string task;
    std::vector<InstructionPage> pages;
  };
  std::vector<InstructionPage> introduction, end;
  std::vector<TaskPages> task_pages;

  /// Pages to show before the first trial of a task; empty if the file has none.
  const std::vector<InstructionPage>& pages_before_task(const std::string& task) const;
};

/// Parses the instructions. `tasks`: names of the study's tasks. Error, with file and line: an unknown or duplicate section, a page without
/// a heading, text before the first section.
Result<Instructions> parse_instructions(std::string_view text, const std::string& file, const std::vector<std::string>& tasks);
/// Reads and parses a file.
Result<Instructions> read_instructions(const std::string& path, const std::vector<std::string>& tasks);

}  // namespace catena::app
