// SPDX-License-Identifier: MIT
#include "engine/study/session.h"

#include <algorithm>

#include "engine/base/random.h"

namespace catena::study {
namespace {

/// Returns a seed for one random choice, derived from the numbers that identify it.
std::uint64_t seed_of(int study, int subject, int what, int number) {
  std::uint64_t seed = 0;
  for (const int part : {study, subject, what, number}) seed = mix_bits(seed ^ static_cast<std::uint64_t>(part));
  return seed;
}

constexpr int kOrders = -1;  ///< value of `what` for the order of a block; task indices are >= 0

/// Fisher-Yates shuffle, repeated up to kDraws times while a stimulus follows itself.
void shuffle(std::vector<Trial>& trials, Random& random) {
  constexpr int kDraws = 1000;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (std::size_t i = trials.size(); i > 1; --i) std::swap(trials[i - 1], trials[random.below(i)]);
    bool repeated = false;
    for (std::size_t i = 1; i < trials.size(); ++i) repeated = repeated || trials[i].stimulus == trials[i - 1].stimulus;
    if (!repeated) return;
  }
}

}  // namespace

std::vector<int> latin_square_row(int count, int row) {
  // in the order 0, 1, n-1, 2, n-2, ... every difference (mod n) of neighbors occurs once
  std::vector<int> order;
  const bool mirrored = count % 2 == 1 && row >= count;
  for (int j = 0; j < count; ++j) {
    const int step = j == 0 ? 0 : j % 2 == 1 ? (j + 1) / 2 : count - j / 2;
    order.push_back((row + step) % count);
  }
  if (mirrored) std::reverse(order.begin(), order.end());
  return order;
}

std::vector<Trial> make_session(const Study& study, int subject) {
  const int tasks = static_cast<int>(study.tasks.size()), rows = tasks % 2 == 0 ? tasks : 2 * tasks;
  const std::vector<int> order = latin_square_row(tasks, (subject - 1) % rows);
  std::vector<Trial> session;
  for (int block = 0; block < tasks; ++block) {
    const int task = order[static_cast<std::size_t>(block)];
    Random random(seed_of(study.seed, subject, kOrders, task));
    for (const bool training : {true, false}) {
      std::vector<Trial> trials;
      const int count = training ? study.training : study.trials, first = training ? study.trials : 0;
      for (int k = 0; k < count; ++k)
        for (int condition = 0; condition < static_cast<int>(study.conditions.size()); ++condition) {
          const int stimulus = first + k;
          const int seed = static_cast<int>(seed_of(study.seed, subject, task, stimulus) >> 34);  // below 2^30
          trials.push_back({.subject = subject,
                            .block = block,
                            .task = task,
                            .condition = condition,
                            .stimulus = stimulus,
                            .seed = seed,
                            .training = training});
        }
      shuffle(trials, random);
      session.insert(session.end(), trials.begin(), trials.end());
    }
  }
  for (std::size_t i = 0; i < session.size(); ++i) session[i].index = static_cast<int>(i);
  return session;
}

}  // namespace catena::study
