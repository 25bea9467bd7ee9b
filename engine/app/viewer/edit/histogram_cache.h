// SPDX-License-Identifier: MIT
/// Cache of field values for histograms: a sorted sample per field version, computed on a separate thread so that no frame waits. At most
/// about 2 million floats per field; those of removed fields are discarded. Frame thread.
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

/// Returns bar heights 0 to 1, by the logarithm of the count in `bars` intervals of lo..hi that are equal on the scale
/// (engine/base/symlog_scale.h); all 0 if there is nothing to show.
std::vector<float> histogram_bars(const std::vector<float>& sorted, double lo, double hi, int bars, double linear_below = 0);
/// Returns the value below which the fraction `share` of the values lies; 0 for an empty list.
double quantile_of_sorted(const std::vector<float>& sorted, double share);

/// Owns the cached samples and the thread that computes the next ones.
class HistogramCache {
 public:
  /// Returns the sorted values, or nullptr until they are available; requests them. For a vector field its magnitudes, for a formula the
  /// values of the rendered grid.
  SortedSamples find_or_request(scene::Scene& scene, scene::Entity field);
  /// Discards the values of fields that are not in the scene.
  void prune(const scene::Scene& scene);
  bool is_busy() const { return job_ != nullptr; }

 private:
  struct Job {
    std::uint64_t version = 0;
    SortedSamples values;
    std::atomic<bool> done = false;
    std::jthread thread;  ///< Last member: joined before the others are destroyed.
  };
  void collect();

  std::map<std::uint64_t, SortedSamples> cached_;
  std::unique_ptr<Job> job_;
};

/// Mapping between values and positions in a plot of the GUI: value to x, alpha to y, and back. Pixels, y down. Alpha is plotted by its
/// square root, because the alphas of a volume are mostly small. Pure, any thread.
struct PlotTransform {
  double left = 0, top = 0, right = 1, bottom = 1;
  double lo = 0, hi = 1;    ///< Values at the left and right edges, lo < hi.
  double linear_below = 0;  ///< Linear part of the scale between them (engine/base/symlog_scale.h).

  double to_x(double value) const;
  double value_at(double x) const;          ///< Result within lo..hi.
  double rounded_value_at(double x) const;  ///< The same, rounded to a fraction of a pixel.
  double to_y(double alpha) const;
  double alpha_at(double y) const;  ///< Result within 0..1.
};

/// Returns a valid range for a plot: increasing, finite, and wide enough for doubles to be distinguishable. For a single value: a range
/// around it.
std::array<double, 2> make_plot_range(double lo, double hi);

/// Returns the shortest number near `value`, within 1/`parts` of the span lo..hi, so that files do not fill with meaningless digits.
double round_within(double value, double lo, double hi, double parts = 2000);

}  // namespace catena::app
