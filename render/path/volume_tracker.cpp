// SPDX-License-Identifier: MIT
#include "render/path/volume_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena::render {
namespace {

constexpr std::size_t kIndexSize = 2048;
constexpr double kRouletteBelow = 0.1, kSurvival = 0.5;  // of a transmittance

}  // namespace

void PiecewiseCurve::make_index() {
  if (values_.size() < 2 || !(values_.back() > values_.front())) return;
  const double range = double(values_.back()) - double(values_.front());
  per_value_ = float(double(kIndexSize - 1) / range);
  index_.resize(kIndexSize);
  for (std::size_t i = 0; i < kIndexSize; ++i) {
    // a little lower than the bin, whose lower end is rounded
    const auto value = float(double(values_.front()) + range * (double(i) - 0.5) / double(kIndexSize - 1));
    index_[i] = std::uint32_t(std::ranges::upper_bound(values_, value) - values_.begin());
  }
}

std::size_t PiecewiseCurve::above(float value) const {
  if (index_.empty()) return std::size_t(std::ranges::upper_bound(values_, value) - values_.begin());
  if (value < values_.front()) return 0;
  const float bin = (value - values_.front()) * per_value_;
  std::size_t i = index_[bin < float(kIndexSize - 1) ? std::size_t(bin) : kIndexSize - 1];
  while (i < values_.size() && values_[i] <= value) ++i;
  return i;
}

void PiecewiseCurve::at(float value, float* out) const {
  if (values_.empty()) {
    std::fill_n(out, columns_, 0.0f);
    return;
  }
  const std::size_t i = above(value);
  if (i == 0 || i == values_.size()) {
    std::copy_n(&rows_[(i == 0 ? 0 : i - 1) * columns_], columns_, out);
    return;
  }
  const float f = (value - values_[i - 1]) / (values_[i] - values_[i - 1]);
  const float *a = &rows_[(i - 1) * columns_], *b = a + columns_;
  for (std::size_t c = 0; c < columns_; ++c) out[c] = a[c] + f * (b[c] - a[c]);
}

float PiecewiseCurve::largest(float lo, float hi) const {
  std::array<float, 4> ends{}, other{};
  at(lo, ends.data());
  at(hi, other.data());
  float most = std::max(ends[0], other[0]);
  const auto first = std::ranges::lower_bound(values_, lo);
  for (auto i = first; i != values_.end() && *i <= hi; ++i) most = std::max(most, rows_[std::size_t(i - values_.begin()) * columns_]);
  return most;
}

VolumeTracker::VolumeTracker(const VolumeItem& item, std::shared_ptr<const DenseGrid> grid)
    : item_(&item),
      grid_(std::move(grid)),
      extinction_(item.transfer.extinctions, std::integral_constant<std::size_t, 1>()),
      color_(item.transfer.colors, std::integral_constant<std::size_t, 3>()) {
  if (!item.transfer.gradient_factors.empty()) factor_.emplace(item.transfer.gradient_factors, std::integral_constant<std::size_t, 1>());
  const auto& n = grid_->bricks();
  bounds_.reserve(std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]));
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const auto [lo, hi] = grid_->range(x, y, z);
        bounds_.push_back(lo > hi ? 0.0f : extinction_.largest(lo, hi));
      }
}

float VolumeTracker::extinction_at(const glm::vec3& p) const {
  float value = 0, sigma = 0;
  if (!grid_->sample(p, value)) return 0;
  extinction_.at(value, &sigma);
  if (factor_ && sigma > 0) {
    float factor = 1;
    factor_->at(float(norm(grid_->gradient(p))), &factor);
    sigma *= factor;
  }
  return sigma;
}

template <class Body>
void VolumeTracker::walk(const PathRay& ray, double from, double to, const Body& body) const {
  const Vec3 start = grid_->to_index(ray.origin), step = grid_->to_index_direction(ray.direction);
  const auto& bricks = grid_->bricks();
  if (bricks[0] == 0) return;
  for (int a = 0; a < 3; ++a) {
    const double most = grid_->size()[std::size_t(a)] - 1;
    if (step[a] == 0) {
      if (start[a] < 0 || start[a] > most) return;
      continue;
    }
    const double x = (0 - start[a]) / step[a], y = (most - start[a]) / step[a];
    from = std::max(from, std::min(x, y));
    to = std::min(to, std::max(x, y));
  }
  if (!(from < to)) return;
  // single precision suffices from the entry on
  const glm::vec3 o(start + from * step), d(step);
  const auto length = float(to - from);
  int at[3], step_by[3];
  float next[3], delta[3];
  for (int a = 0; a < 3; ++a) {
    at[a] = std::clamp(int(std::floor(o[a] / DenseGrid::kBrick)), 0, bricks[std::size_t(a)] - 1);
    step_by[a] = d[a] > 0 ? 1 : -1;
    constexpr float kNever = std::numeric_limits<float>::infinity();
    next[a] = d[a] != 0 ? (float((at[a] + (d[a] > 0 ? 1 : 0)) * DenseGrid::kBrick) - o[a]) / d[a] : kNever;
    delta[a] = d[a] != 0 ? float(DenseGrid::kBrick) / std::fabs(d[a]) : kNever;
  }
  float enter = 0;
  while (enter < length) {
    const int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const float leave = std::min(next[a], length);
    const float bound =
        bounds_[(std::size_t(at[2]) * std::size_t(bricks[1]) + std::size_t(at[1])) * std::size_t(bricks[0]) + std::size_t(at[0])];
    if (bound > 0 && leave > enter && !body(bound, enter, leave, o, d, from)) return;
    enter = std::max(enter, leave);
    next[a] += delta[a];
    at[a] += step_by[a];
    if (at[a] < 0 || at[a] >= bricks[std::size_t(a)]) return;
  }
}

std::optional<double> VolumeTracker::collide(const PathRay& ray, double from, double to, Random& random) const {
  std::optional<double> found;
  auto depth = float(-std::log(1 - random.uniform()));  // optical depth left, against the bounds
  walk(ray, from, to, [&](float bound, float enter, float leave, const glm::vec3& o, const glm::vec3& d, double first) {
    float t = enter;
    while (true) {
      const float way = depth / bound;
      if (t + way >= leave) {
        depth -= (leave - t) * bound;
        depth = std::max(depth, 0.0f);
        return true;
      }
      t += way;
      if (float(random.uniform()) * bound < extinction_at(o + t * d)) {
        found = first + double(t);
        return false;
      }
      depth = float(-std::log(1 - random.uniform()));
    }
  });
  return found;
}

double VolumeTracker::transmittance(const PathRay& ray, double from, double to, Random& random) const {
  double share = 1;
  auto depth = float(-std::log(1 - random.uniform()));
  walk(ray, from, to, [&](float bound, float enter, float leave, const glm::vec3& o, const glm::vec3& d, double) {
    float t = enter;
    while (true) {
      const float way = depth / bound;
      if (t + way >= leave) {
        depth -= (leave - t) * bound;
        depth = std::max(depth, 0.0f);
        return true;
      }
      t += way;
      share *= std::max(0.0, 1 - double(extinction_at(o + t * d) / bound));
      if (share < kRouletteBelow) {
        if (share == 0 || random.uniform() >= kSurvival) {
          share = 0;
          return false;
        }
        share /= kSurvival;
      }
      depth = float(-std::log(1 - random.uniform()));
    }
  });
  return share;
}

Color VolumeTracker::color_at(const Vec3& position) const {
  float value = 0, color[3] = {};
  if (grid_->sample(glm::vec3(grid_->to_index(position)), value)) color_.at(value, color);
  return {color[0], color[1], color[2]};
}

Vec3 VolumeTracker::gradient_at(const Vec3& position) const { return grid_->gradient(glm::vec3(grid_->to_index(position))); }

}  // namespace catena::render
