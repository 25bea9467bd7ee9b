/// HistogramCache keeps the values of fields for histograms: a sorted sample, made once a field version by a thread of its own, so that no
/// frame waits. It has at most about 2 million floats a field; those of fields that are gone go with them. Frame thread.
#pragma once
#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

using SortedSamples = std::shared_ptr<const std::vector<float>>;

/// Heights 0..1 by the logarithm of the count in `bars` parts of lo..hi, equal on a scale (engine/base/symlog_scale.h); all 0 where there
/// is nothing to show.
std::vector<float> histogram_bars(const std::vector<float>& sorted, double lo, double hi, int bars, double linear_below = 0);
/// The value below which `share` of the values lie; 0 of none.
double quantile_of_sorted(const std::vector<float>& sorted, double share);

class HistogramCache {
 public:
  /// Nullptr until they are there. A vector field's are its magnitudes; a formula's those of the grid that is drawn.
  SortedSamples find_or_request(scene::Scene& scene, scene::Entity field);
  /// Forgets the fields that the scene no longer has.
  void prune(const scene::Scene& scene);
  bool is_busy() const { return job_ != nullptr; }

 private:
  struct Job {
    std::uint64_t version = 0;
    SortedSamples values;
    std::atomic<bool> done = false;
    std::jthread thread;  ///< last: joined before the rest goes
  };
  void collect();

  std::map<std::uint64_t, SortedSamples> cached_;
  std::unique_ptr<Job> job_;
};

/// PlotTransform says where values lie in a plot of the interface: value to x, alpha to y, and back. Pixels, y down. Alphas are drawn by
/// their square roots, because those of a volume are mostly small. Pure, any thread.
struct PlotTransform {
  double left = 0, top = 0, right = 1, bottom = 1;
  double lo = 0, hi = 1;    ///< values at the left and right edges, lo < hi
  double linear_below = 0;  ///< the scale between them (engine/base/symlog_scale.h)

  double to_x(double value) const;
  double value_at(double x) const;          ///< within lo..hi
  double rounded_value_at(double x) const;  ///< the same, rounded to a part of a pixel
  double to_y(double alpha) const;
  double alpha_at(double y) const;  ///< within 0..1
};

/// A range that a plot can have: rising, finite, and not too narrow for doubles to be told apart in it. Of a single value: about it.
std::array<double, 2> make_plot_range(double lo, double hi);

/// The shortest number near `value`: within a part in `parts` of the span lo..hi, so that a file does not fill with digits no hand has set.
double round_within(double value, double lo, double hi, double parts = 2000);

}  // namespace catena::app
