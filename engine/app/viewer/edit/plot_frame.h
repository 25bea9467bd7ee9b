/// PlotFrame says where values lie in a plot of the interface: value to x, alpha to y, and back. Pixels, y down. Alphas are drawn by their
/// square roots, because those of a volume are mostly small. Pure, any thread.
#pragma once
#include <array>

namespace catena::app {

struct PlotFrame {
  double left = 0, top = 0, right = 1, bottom = 1;
  double lo = 0, hi = 1;  ///< values at the left and right edges, lo < hi

  double x_of(double value) const;
  double value_at(double x) const;  ///< within lo..hi
  double y_of(double alpha) const;
  double alpha_at(double y) const;  ///< within 0..1
};

/// A range that a plot can have: rising, finite, and not too narrow for doubles to be told apart in it. Of a single value: about it.
std::array<double, 2> plot_range(double lo, double hi);

/// The shortest number near `value`: within a part in `parts` of the span lo..hi, so that a file does not fill with digits no hand has set.
double rounded_in(double value, double lo, double hi, double parts = 2000);

}  // namespace catena::app
