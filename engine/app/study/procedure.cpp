// SPDX-License-Identifier: MIT
#include "engine/app/study/procedure.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace catena::app {

namespace {

void append_utf8(std::string& to, std::uint32_t c) {
  const auto put = [&](std::uint32_t byte) { to += static_cast<char>(byte); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xc0 | c >> 6);
    put(0x80 | (c & 0x3f));
  } else if (c < 0x10000) {
    put(0xe0 | c >> 12);
    put(0x80 | (c >> 6 & 0x3f));
    put(0x80 | (c & 0x3f));
  } else {
    put(0xf0 | c >> 18);
    put(0x80 | (c >> 12 & 0x3f));
    put(0x80 | (c >> 6 & 0x3f));
    put(0x80 | (c & 0x3f));
  }
}

void remove_character(std::string& from) {
  while (!from.empty() && (static_cast<unsigned char>(from.back()) & 0xc0) == 0x80) from.pop_back();
  if (!from.empty()) from.pop_back();
}

std::string trial_count(std::size_t n) { return fmt::format("{} trial{}", n, n == 1 ? "" : "s"); }

InstructionPage pause_page() { return {"Pause", {"Rest as long as you like. The next trial begins when you continue."}}; }

}  // namespace

Procedure::Procedure(const study::Study& study, const Instructions& instructions, std::vector<study::Trial> trials, std::size_t finished,
                     std::size_t answered)
    : study_(study), trials_(std::move(trials)) {
  if (finished > 0 || answered > 0)
    add_pages(
        {{"Welcome back", {fmt::format("{} of {} trials are done. The session continues with the next one.", finished, trials_.size())}}});
  else
    add_pages(instructions.introduction);
  add_trials(instructions, finished);
  for (std::size_t i = answered; i < question_count(); ++i) steps_.push_back({Step::Kind::question, i});
  if (instructions.end.empty())
    add_pages({{"The end", {"Thank you."}}});
  else
    add_pages(instructions.end);
}

void Procedure::add_pages(const std::vector<InstructionPage>& pages) {
  for (const InstructionPage& page : pages) {
    steps_.push_back({Step::Kind::page, pages_.size()});
    pages_.push_back(page);
  }
}

void Procedure::add_trials(const Instructions& instructions, std::size_t finished) {
  const auto others = [&](std::size_t from) {
    std::size_t n = 0;
    for (const study::Trial& first = trials_[from]; from + n < trials_.size(); ++n)
      if (const study::Trial& one = trials_[from + n]; one.block != first.block || one.training != first.training) break;
    return trial_count(n);
  };
  for (std::size_t i = finished; i < trials_.size(); ++i) {
    const study::Trial& trial = trials_[i];
    const study::Trial* const before = i > 0 ? &trials_[i - 1] : nullptr;
    const bool first = i == finished, new_block = before == nullptr || before->block != trial.block;
    if (new_block && !first)
      add_pages(
          {{"Pause", {fmt::format("Part {} of {} is done. Rest as long as you like.", before->block + 1, trials_.back().block + 1)}}});
    if (first || (new_block && before->task != trial.task))
      add_pages(instructions.pages_before_task(study_.tasks[static_cast<std::size_t>(trial.task)].name));
    if (trial.training && (first || new_block || !before->training))
      add_pages({{"Training", {fmt::format("First {} for practice. They do not count.", others(i))}}});
    if (!trial.training && before != nullptr && before->training && !new_block)
      add_pages({{"Main trials", {fmt::format("The training is over. Next: {}.", others(i))}}});
    steps_.push_back({Step::Kind::trial, i});
  }
}

Procedure::Stage Procedure::stage() const {
  if (pause_page_) return Stage::page;
  if (step_index_ == steps_.size()) return Stage::finished;
  switch (steps_[step_index_].kind) {
    case Step::Kind::page:
      return Stage::page;
    case Step::Kind::trial:
      return running_ ? Stage::running : Stage::ready;
    case Step::Kind::question:
      break;
  }
  return Stage::question;
}

const InstructionPage& Procedure::page() const { return pause_page_ ? *pause_page_ : pages_[steps_[step_index_].index]; }
std::size_t Procedure::trial() const { return steps_[step_index_].index; }
std::string Procedure::trial_label() const {
  const study::Trial& now = trials_[trial()];
  std::size_t number = 0, all = 0;
  for (const study::Trial& one : trials_) {
    if (one.training != now.training || (now.training && one.block != now.block)) continue;
    ++all;
    number += one.index <= now.index;
  }
  return fmt::format("{} {} of {}", now.training ? "Training," : "Trial", number, all);
}

const study::Question& Procedure::question() const { return study_.questions[steps_[step_index_].index]; }
std::size_t Procedure::question_index() const { return steps_[step_index_].index; }

std::optional<std::size_t> Procedure::next_trial() const {
  const auto next = std::find_if(steps_.begin() + static_cast<std::ptrdiff_t>(step_index_), steps_.end(),
                                 [](const Step& step) { return step.kind == Step::Kind::trial; });
  return next == steps_.end() ? std::nullopt : std::optional(next->index);
}

void Procedure::advance() {
  ++step_index_;
  running_ = false;
  typed_answer_.clear();
}

void Procedure::handle_key(const KeyPress& stroke, bool at_start) {
  using What = KeyPress::Kind;
  const bool on = stroke.kind == What::space || stroke.kind == What::enter;
  switch (stage()) {
    case Stage::page:
      if (!on) return;
      if (!std::exchange(pause_page_, std::nullopt)) advance();
      return;
    case Stage::ready:
      if (on && at_start) running_ = true;
      if (stroke.kind == What::character && (stroke.character == 'p' || stroke.character == 'P')) pause_page_ = pause_page();
      return;
    case Stage::question:
      return edit_answer(stroke);
    case Stage::running:
    case Stage::finished:
      return;
  }
}

void Procedure::edit_answer(const KeyPress& stroke) {
  const std::vector<std::string>& choices = question().answers;
  switch (stroke.kind) {
    case KeyPress::Kind::backspace:
      return choices.empty() ? remove_character(typed_answer_) : typed_answer_.clear();
    case KeyPress::Kind::character: {
      const std::uint32_t c = stroke.character;
      if (!choices.empty() && c >= '1' && c - '1' < choices.size()) typed_answer_ = choices[c - '1'];
      if (choices.empty() && c >= 0x20 && c != 0x7f && c <= 0x10ffff && typed_answer_.size() + 4 <= kMaxAnswerBytes)
        append_utf8(typed_answer_, c);
      return;
    }
    case KeyPress::Kind::enter:
      if (!choices.empty() && typed_answer_.empty()) return;
      answer_ = Answer{question().name, typed_answer_};
      return advance();
    case KeyPress::Kind::space:
      return;  // also arrives as a character
  }
}

std::string Procedure::progress_text() const {
  std::size_t trials = trials_.size(), answered = question_count();
  for (std::size_t i = step_index_; i < steps_.size(); ++i) {
    trials -= steps_[i].kind == Step::Kind::trial;
    answered -= steps_[i].kind == Step::Kind::question;
  }
  return fmt::format("{} of {} trials and {} of {} questions are done{}", trials, trials_.size(), answered, question_count(),
                     step_index_ == steps_.size() ? "" : "; the same command continues the session");
}

void Procedure::complete_trial() {
  if (stage() == Stage::running) advance();
}

void Procedure::abort_trial(const std::string& reason) {
  if (stage() != Stage::running) return;
  running_ = false;
  pause_page_ = InstructionPage{"Repeated trial", {reason, "This trial is repeated."}};
}

std::optional<Procedure::Answer> Procedure::take_answer() { return std::exchange(answer_, std::nullopt); }

}  // namespace catena::app
