// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/step_window.h"

#include <fmt/format.h>

#include <algorithm>

namespace catena::flow {
namespace {

bool has_same_nodes(const field::VectorGrid& a, const field::VectorGrid& b) {
  const field::Box &box_a = a.index_box(), &box_b = b.index_box();
  if (!(box_a.lo == box_b.lo && box_a.hi == box_b.hi)) return false;
  double difference = 0;
  for (int i = 0; i < 8; ++i) difference = std::max(difference, max_abs(a.corner(i) - b.corner(i)));
  return difference <= 1e-12 * (a.domain_length() + max_abs(a.corner(0)));
}

}  // namespace

std::array<double, TimeInterval::kMaxSteps> TimeInterval::weights(double time) const {
  std::array<double, kMaxSteps> w{};
  const double h = end - begin, theta = (time - begin) / h;
  if (count == 2) return {1 - theta, theta};
  const double a = theta * theta * (3 - 2 * theta), b = theta * (1 - theta) * (1 - theta), c = theta * theta * (theta - 1);
  w[first] = 1 - a;
  w[first + 1] = a;
  // adds `weight` times h dv/dt of the parabola through the steps k - 1, k, k + 1, at one of them
  const auto add_slope = [&](std::size_t k, std::size_t at, double weight) {
    for (std::size_t i = 0; i < 3; ++i) {  // derivative of the Lagrange polynomial of step k - 1 + i at times[at]
      const std::size_t j = k - 1 + i, m = k - 1 + (i + 1) % 3, n = k - 1 + (i + 2) % 3;
      w[j] += weight * h * ((times[at] - times[m]) + (times[at] - times[n])) / ((times[j] - times[m]) * (times[j] - times[n]));
    }
  };
  add_slope(first > 0 ? first : 1, first, b);
  add_slope(first + 2 < count ? first + 1 : first, first + 1, c);
  return w;
}

Result<TimeInterval> StepWindow::enter(std::size_t interval) {
  const std::size_t steps = field_->times.size();
  const std::size_t from = field_->is_cubic_in_time && interval > 0 ? interval - 1 : interval;
  const std::size_t to = std::min(steps, interval + (field_->is_cubic_in_time ? 3 : 2));
  std::erase_if(loaded_, [&](const auto& entry) { return entry.first < from || entry.first >= to; });
  TimeInterval out;
  out.begin = field_->times[interval];
  out.end = field_->times[interval + 1];
  out.first = interval - from;
  for (std::size_t step = from; step < to; ++step) {
    auto found = std::ranges::find(loaded_, step, [](const auto& entry) { return entry.first; });
    if (found == loaded_.end()) {
      CATENA_TRY(const field::VectorFieldPtr field, field_->load(step));
      std::shared_ptr<const field::VectorGrid> grid(field, field->grid());
      if (grid == nullptr) return Error{fmt::format("step {} is no grid; a grid was expected", step)};
      if (!loaded_.empty() && !has_same_nodes(*loaded_.front().second, *grid))
        return Error{
            fmt::format("step {} has other nodes than step {}; steps over the same nodes were expected", step, loaded_.front().first)};
      found = loaded_.emplace(loaded_.end(), step, std::move(grid));
    }
    out.times[out.count] = field_->times[step];
    out.grids[out.count++] = found->second;
  }
  return out;
}

}  // namespace catena::flow
