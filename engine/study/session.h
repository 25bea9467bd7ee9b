// SPDX-License-Identifier: MIT
/// The design of the experiment: which trials a subject does, in which order. A pure function of the study and the subject's number.
///   tasks           in blocks, by a Latin square of E. J. Williams (1949): over as many subjects as the square has rows, each task is in
///                   each position, and follows each other task, equally often; subject n has row n - 1, cyclically
///   within a block  training first, then the trials: every stimulus in every condition, all of them shuffled, so that conditions are
///                   interleaved and not announced; where possible, no stimulus follows itself
///   seeds           from the study's seed, the subject, the task and the stimulus: conditions share them
#pragma once
#include <cstdint>
#include <vector>

#include "engine/base/export.h"
#include "engine/study/study.h"

namespace catena::study {

/// One trial of the design.
struct Trial {
  int subject = 1;        ///< Number of the subject, from 1
  int index = 0;          ///< Position in the session, from 0, training included
  int block = 0;          ///< Position of the task's block, from 0
  int task = 0;           ///< Index into the study's tasks
  int condition = 0;      ///< Index into the study's conditions
  int stimulus = 0;       ///< Number within the task, from 0; those of training trials follow those of the others
  int seed = 0;           ///< Seed of the stimulus
  bool training = false;  ///< Excluded from the analysis
  bool operator==(const Trial&) const = default;
};

inline constexpr int kMaxSubject = 9999;  ///< Largest number of a subject

/// The order of `count` tasks (their indices) in row `row` (from 0) of the Latin square, which has `count` rows, or twice as many if
/// `count` is odd.
CATENA_EXPORT std::vector<int> latin_square_row(int count, int row);
/// The trials of a subject's session in their order. `subject`: 1 to kMaxSubject.
CATENA_EXPORT std::vector<Trial> make_session(const Study& study, int subject);

}  // namespace catena::study
