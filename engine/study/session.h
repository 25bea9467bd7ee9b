/// The design: which trials a subject does, in which order. A pure function of the study and the subject's number.
///   tasks        in blocks, by a Latin square of E. J. Williams (1949): over as many subjects as it has rows each task stands at each
///                place, and follows each other task, equally often; subject n has row n - 1, from the top again after the last
///   within one   every stimulus once in every condition; all of them shuffled, so that conditions are interleaved unannounced; no stimulus
///                follows itself where that can be
///   seeds        of the study's seed, the subject, the task and the stimulus: conditions share them
#pragma once
#include <cstdint>
#include <vector>

#include "engine/study/study.h"

namespace catena::study {

/// One trial of the design.
struct Trial {
  int subject = 1;        ///< from 1
  int index = 0;          ///< in the session, from 0, training counted
  int block = 0;          ///< from 0
  int task = 0;           ///< index into the study's tasks
  int condition = 0;      ///< index into its conditions
  int stimulus = 0;       ///< number within the task, from 0; of training trials, behind those
  int seed = 0;           ///< of the stimulus
  bool training = false;  ///< not analysed
  bool operator==(const Trial&) const = default;
};

inline constexpr int kMaxSubject = 9999;  ///< Greater numbers are refused.

/// The order of `count` tasks for a row of the square; it has `count` rows, or twice as many where `count` is odd.
std::vector<int> latin_square_row(int count, int row);
/// `subject`: 1 .. kMaxSubject.
std::vector<Trial> make_session(const Study& study, int subject);

}  // namespace catena::study
