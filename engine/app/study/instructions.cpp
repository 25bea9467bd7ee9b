// SPDX-License-Identifier: MIT
#include "engine/app/study/instructions.h"

#include <algorithm>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

constexpr std::string_view kBefore = "before ";

bool ends_page(std::string_view line) { return line.size() >= 3 && line.find_first_not_of('-') == std::string_view::npos; }

/// Collects lines into pages.
class PageReader {
 public:
  explicit PageReader(std::vector<InstructionPage>& to) : to_(&to) {}

  void add(std::string_view line) {
    if (line.empty()) {
      open_ = false;
    } else if (page_.heading.empty()) {
      page_.heading = line;
    } else if (open_ && !line.starts_with("- ")) {
      page_.paragraphs.back().append(" ").append(line);
    } else {
      page_.paragraphs.emplace_back(line);
      open_ = true;
    }
  }
  /// Ends the page and stores it. False if the page is empty.
  bool end() {
    if (page_.heading.empty()) return false;
    to_->push_back(std::move(page_));
    page_ = {};
    open_ = false;
    return true;
  }

 private:
  std::vector<InstructionPage>* to_;
  InstructionPage page_;
  bool open_ = false;  ///< whether the next line continues the last paragraph
};

}  // namespace

const std::vector<InstructionPage>& Instructions::pages_before_task(const std::string& task) const {
  static const std::vector<InstructionPage> none;
  const auto found = std::ranges::find(task_pages, task, &TaskPages::task);
  return found == task_pages.end() ? none : found->pages;
}

Result<Instructions> parse_instructions(std::string_view text, const std::string& file, const std::vector<std::string>& tasks) {
  Instructions all;
  all.task_pages.reserve(tasks.size());
  std::vector<std::string> seen, known{"introduction", "end"};
  for (const std::string& task : tasks) known.push_back(std::string(kBefore) + task);
  const std::vector<std::string_view> known_views(known.begin(), known.end());
  std::optional<PageReader> reader;
  bool page_was_ended = false;
  int number = 0;
  const auto error = [&](const std::string& what) { return Error{file + ":" + std::to_string(number) + ": " + what}; };
  const auto pages_of = [&](const std::string& moment) -> std::vector<InstructionPage>& {
    if (moment == "introduction") return all.introduction;
    if (moment == "end") return all.end;
    all.task_pages.push_back({moment.substr(kBefore.size()), {}});
    return all.task_pages.back().pages;
  };
  const auto end_page = [&]() -> Outcome {
    if (reader && !reader->end() && page_was_ended) return error("a page without text; a heading was expected after \"---\"");
    return Done{};
  };
  text = strip_bom(text);
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = trim(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (line.starts_with("# ")) {
      CATENA_CHECK(end_page());
      const std::string moment(trim(line.substr(2)));
      if (std::ranges::find(known, moment) == known.end())
        return error("there is no section " + in_quotes(moment) + suggestion(moment, known_views) + "; expected " +
                     join_alternatives(known_views));
      if (std::ranges::find(seen, moment) != seen.end()) return error("the section " + in_quotes(moment) + " is repeated");
      seen.push_back(moment);
      reader.emplace(pages_of(moment));
      page_was_ended = false;
    } else if (!reader) {
      if (!line.empty()) return error("text before the first section; \"# introduction\" was expected");
    } else if (ends_page(line)) {
      if (!reader->end()) return error("a page without text; a heading was expected before \"---\"");
      page_was_ended = true;
    } else {
      reader->add(line);
    }
  }
  CATENA_CHECK(end_page());
  return all;
}

Result<Instructions> read_instructions(const std::string& path, const std::vector<std::string>& tasks) {
  CATENA_TRY(const std::string text, read_text_file(path, "a text file of instructions"));
  return parse_instructions(text, path, tasks);
}

}  // namespace catena::app
