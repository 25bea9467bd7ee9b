/// FieldValues keeps the values of fields for histograms: a sorted sample, made once a field version by a thread of its own, so that no
/// frame waits. It has at most about 2 million floats a field; those of fields that are gone go with them. Frame thread.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

using SortedValues = std::shared_ptr<const std::vector<float>>;

/// Heights 0..1 by the logarithm of the count in `bars` equal parts of lo..hi; all 0 where there is nothing to show.
std::vector<float> histogram_bars(const std::vector<float>& sorted, double lo, double hi, int bars);
/// The value below which `share` of the values lie; 0 of none.
double quantile_of(const std::vector<float>& sorted, double share);

class FieldValues {
 public:
  /// Nullptr until they are there. A vector field's are its magnitudes; a formula's those of the grid that is drawn.
  SortedValues of(scene::Scene& scene, scene::Entity field);
  /// Forgets the fields that the scene no longer has.
  void tidy(const scene::Scene& scene);
  bool is_working() const { return job_ != nullptr; }

 private:
  struct Job {
    std::uint64_t version = 0;
    SortedValues values;
    std::atomic<bool> done = false;
    std::jthread thread;  ///< last: joined before the rest goes
  };
  void collect();

  std::map<std::uint64_t, SortedValues> known_;
  std::unique_ptr<Job> job_;
};

}  // namespace catena::app
