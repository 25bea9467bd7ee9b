/// Procedure is what one subject goes through, as a machine without interface: what the person did and what became of a trial go in, what
/// is to be shown comes out. It knows no files, no scene and no clock. Frame thread.
///
///   introduction -> for each block: (pages before its task) -> training -> trials -> pause  -> questions -> pages of the end -> over
///
///   page, pause  space or Enter goes on
///   ready        the trial's picture is there and the hand finds the start; space or Enter with the cursor at the start begins the trial;
///                P: a pause
///   running      no key counts, until the trial has ended() or was cut_off(): then it is to be done again
///   question     1 to 9 choose an answer, or a line of text is typed; Backspace takes back, Enter goes on
/// A session that was cut off begins with its first unfinished trial, after a page of welcome and the pages before its task, or with the
/// first question without an answer.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/study/instructions.h"
#include "engine/study/session.h"

namespace catena::app {

/// What a person does with the keyboard.
struct KeyPress {
  enum class Kind : std::uint8_t { space, enter, backspace, character };
  Kind kind = Kind::space;
  std::uint32_t character = 0;  ///< Unicode
};

class Procedure {
 public:
  static constexpr std::size_t kMaxAnswerBytes = 1000;  ///< bytes of a typed one

  enum class Stage : std::uint8_t { page, ready, running, question, finished };

  /// `finished` trials and `answered` questions of an earlier run are not done again.
  /// `study` outlives it; `trials`: the subject's session.
  Procedure(const study::Study& study, const Instructions& instructions, std::vector<study::Trial> trials, std::size_t finished = 0,
            std::size_t answered = 0);

  Stage stage() const;
  const InstructionPage& page() const;  ///< Stage::page
  std::size_t trial() const;            ///< ready, running: of trials()
  /// "Trial 3 of 36", or "Training, 2 of 4" of those of its block.
  std::string trial_label() const;
  const study::Question& question() const;  ///< Stage::question
  std::size_t question_index() const;       ///< from 0
  const std::vector<study::Trial>& trials() const { return trials_; }
  std::size_t question_count() const { return study_.questions.size(); }
  const std::string& typed_answer() const { return typed_answer_; }  ///< what is answered so far
  /// The trial that is shown next, so that it can be got ready behind a page; nothing where no trial is left.
  std::optional<std::size_t> next_trial() const;

  /// `is_at_start`: the cursor is at the trial's start (Stage::ready).
  void handle_key(const KeyPress& stroke, bool at_start);
  /// How far it has come, for the terminal: "12 of 48 trials and 0 of 4 questions are done; the same command goes on".
  std::string progress_text() const;

  /// The running trial's end.
  void complete_trial();
  /// The running trial does not count; `why` is shown, and it begins again.
  void abort_trial(const std::string& why);

  /// The answer that Enter has just given, once: the caller keeps it.
  struct Answer {
    std::string question, answer;  ///< the question's name
  };
  std::optional<Answer> take_answer();

 private:
  struct Step {
    enum class Kind : std::uint8_t { page, trial, question } kind = Kind::page;
    std::size_t index = 0;  ///< of the page, trial or question
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
  std::optional<InstructionPage> pause_page_;  ///< over the step
  std::string typed_answer_;
  std::optional<Answer> answer_;
};

}  // namespace catena::app
