// SPDX-License-Identifier: MIT
/// Procedure is the state machine of one subject's session, without a user interface. Inputs are the user's key presses and the outcomes of
/// trials; outputs are what to show. It uses no files, scene or clock. Frame thread.
///
///   introduction -> for each block: (pages before its task) -> training -> trials -> pause  -> questions -> pages of the end -> finished
///
///   page, pause  space or Enter continues
///   ready        the trial's scene is shown and the subject moves the cursor to the start; space or Enter with the cursor at the start
///                begins the trial; P: a pause
///   running      keys are ignored until complete_trial(), or abort_trial(): then the trial is repeated
///   question     1 to 9 choose an answer, or a line of text is typed; Backspace deletes, Enter confirms
/// An interrupted session continues with its first unfinished trial, after a welcome page and the pages before its task, or with the first
/// unanswered question.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/study/instructions.h"
#include "engine/study/session.h"

namespace catena::app {

/// A key press of the user.
struct KeyPress {
  enum class Kind : std::uint8_t { space, enter, backspace, character };
  Kind kind = Kind::space;
  std::uint32_t character = 0;  ///< Unicode code point, for Kind::character
};

/// The session's state machine.
class Procedure {
 public:
  static constexpr std::size_t kMaxAnswerBytes = 1000;  ///< Maximum length of a typed answer, bytes

  /// Stage of the procedure, as in the table above.
  enum class Stage : std::uint8_t { page, ready, running, question, finished };

  /// `study` must outlive this object. `trials`: the subject's session. The first `finished` trials and `answered` questions, from an
  /// earlier run, are skipped.
  Procedure(const study::Study& study, const Instructions& instructions, std::vector<study::Trial> trials, std::size_t finished = 0,
            std::size_t answered = 0);

  /// Current stage.
  Stage stage() const;
  const InstructionPage& page() const;  ///< The current page; Stage::page only
  std::size_t trial() const;            ///< Index into trials(); Stage::ready and running only
  /// "Trial 3 of 36", or "Training, 2 of 4" for a training trial, counted within its block. Stage::ready and running only.
  std::string trial_label() const;
  const study::Question& question() const;  ///< The current question; Stage::question only
  std::size_t question_index() const;       ///< Index of the current question; Stage::question only
  const std::vector<study::Trial>& trials() const { return trials_; }
  std::size_t question_count() const { return study_.questions.size(); }
  const std::string& typed_answer() const { return typed_answer_; }  ///< The answer chosen or typed so far
  /// Index of the current or next trial, so that its scene can be prepared behind a page; empty if no trial is left.
  std::optional<std::size_t> next_trial() const;

  /// Handles a key press. `at_start`: the cursor is at the trial's start (Stage::ready).
  void handle_key(const KeyPress& stroke, bool at_start);
  /// Progress for the terminal: "12 of 48 trials and 0 of 4 questions are done; the same command goes on".
  std::string progress_text() const;

  /// Call when the running trial has ended at its target or timeout.
  void complete_trial();
  /// Call when the running trial is invalid: shows `reason` on a page, then the trial is repeated.
  void abort_trial(const std::string& reason);

  /// An answer that was confirmed with Enter.
  struct Answer {
    std::string question, answer;  ///< The question's name, and the answer's text
  };
  /// Returns the confirmed answer and clears it; the caller saves it. Empty: none since the last call.
  std::optional<Answer> take_answer();

 private:
  struct Step {
    enum class Kind : std::uint8_t { page, trial, question } kind = Kind::page;
    std::size_t index = 0;  ///< Index of the page, trial or question
  };
  void add_pages(const std::vector<InstructionPage>& pages);
  void add_trials(const Instructions& instructions, std::size_t finished);
  void advance();
  void edit_answer(const KeyPress& stroke);

  const study::Study& study_;
  std::vector<study::Trial> trials_;
  std::vector<InstructionPage> pages_;
  std::vector<Step> steps_;
  std::size_t step_index_ = 0;
  bool running_ = false;
  std::optional<InstructionPage> pause_page_;  ///< Shown in place of the current step; empty: none
  std::string typed_answer_;
  std::optional<Answer> answer_;
};

}  // namespace catena::app
