// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/histogram_cache.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>

#include "engine/base/symlog_scale.h"
#include "engine/scene/auto_transfer.h"

namespace catena::app {

namespace {
constexpr std::size_t kMaxMagnitudes = 1u << 20;
}

std::vector<float> histogram_bars(const std::vector<float>& sorted, double lo, double hi, int bars, double linear_below) {
  std::vector<float> heights(static_cast<std::size_t>(std::max(bars, 0)), 0.0f);
  if (heights.empty() || !(lo < hi) || !std::isfinite(hi - lo)) return heights;
  auto from = std::lower_bound(sorted.begin(), sorted.end(), lo, [](float v, double edge) { return v < edge; });
  float maximum = 0;
  for (int i = 0; i < bars; ++i) {
    // the last bar includes its upper edge
    const double edge = i + 1 == bars ? std::nextafter(hi, HUGE_VAL) : symlog_interpolate(lo, hi, (i + 1.0) / bars, linear_below);
    const auto to = std::lower_bound(from, sorted.end(), edge, [](float v, double e) { return v < e; });
    heights[static_cast<std::size_t>(i)] = std::log1p(static_cast<float>(to - from));
    maximum = std::max(maximum, heights[static_cast<std::size_t>(i)]);
    from = to;
  }
  for (float& h : heights) h = maximum > 0 ? h / maximum : 0;
  return heights;
}

double quantile_of_sorted(const std::vector<float>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1))];
}

void HistogramCache::collect() {
  if (!job_ || !job_->done) return;
  cached_[job_->version] = std::move(job_->values);
  job_.reset();
}

SortedSamples HistogramCache::find_or_request(scene::Scene& scene, scene::Entity field) {
  collect();
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(field);
  const field::AnyField& any = source.rendered.get() != nullptr ? source.rendered : source.loaded;
  if (any.get() == nullptr || !any.get()->is_grid()) return nullptr;
  // reuse the sample that the transfer functions may have cached, or cache it for them
  const auto* sample = scene.cache.has<scene::SortedValues>(field) ? &scene.cache.get<scene::SortedValues>(field) : nullptr;
  if (sample != nullptr && sample->grid == any.get()) return sample->sorted;
  const std::uint64_t version = any.get()->version();
  if (const auto it = cached_.find(version); it != cached_.end()) {
    if (source.rendered.scalar && sample == nullptr) scene.cache.emplace<scene::SortedValues>(field, {source.rendered.get(), it->second});
    return it->second;
  }
  if (job_) return nullptr;
  job_ = std::make_unique<Job>();
  job_->version = version;
  const auto sort = [job = job_.get(), any] {
    if (any.scalar) {
      job->values = scene::sorted_values(*any.scalar->grid());
    } else {
      auto values = std::make_shared<std::vector<float>>(field::sample_magnitudes(*any.vector->grid(), kMaxMagnitudes));
      std::sort(values->begin(), values->end());
      job->values = std::move(values);
    }
    job->done = true;
  };
  try {
    job_->thread = std::jthread(sort);
  } catch (const std::system_error&) {
    job_.reset();  // no histogram until the next request
  }
  return nullptr;
}

void HistogramCache::prune(const scene::Scene& scene) {
  std::set<std::uint64_t> live;
  scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    for (const field::AnyField* any : {&source.loaded, &source.rendered})
      if (any->get() != nullptr) live.insert(any->get()->version());
  });
  std::erase_if(cached_, [&](const auto& entry) { return !live.contains(entry.first); });
}

namespace {
constexpr double kNarrowest = 1e-12;  // relative to the magnitude of the values
constexpr double kWidest = 1e300;
}  // namespace

double PlotTransform::to_x(double value) const {
  const auto place = [&](double v) { return symlog(v, linear_below); };
  const double share = (place(value) - place(lo)) / (place(hi) - place(lo));
  return left + (std::isfinite(share) ? share : 0) * (right - left);
}

double PlotTransform::value_at(double x) const {
  const double share = right > left ? std::clamp((x - left) / (right - left), 0.0, 1.0) : 0;
  return std::clamp(symlog_interpolate(lo, hi, share, linear_below), lo, hi);
}

double PlotTransform::rounded_value_at(double x) const {
  const double width = right - left;
  return round_within(value_at(x), 0, width * (value_at(x + 0.5) - value_at(x - 0.5)));
}

double PlotTransform::to_y(double alpha) const { return bottom + std::sqrt(std::clamp(alpha, 0.0, 1.0)) * (top - bottom); }

double PlotTransform::alpha_at(double y) const {
  const double share = bottom > top ? std::clamp((bottom - y) / (bottom - top), 0.0, 1.0) : 0;
  return share * share;
}

std::array<double, 2> make_plot_range(double lo, double hi) {
  if (!std::isfinite(lo) || !std::isfinite(hi)) {
    if (std::isfinite(lo)) return make_plot_range(lo, lo);
    if (std::isfinite(hi)) return make_plot_range(hi, hi);
    return {0, 1};
  }
  lo = std::clamp(lo, -kWidest, kWidest), hi = std::clamp(hi, -kWidest, kWidest);
  if (lo > hi) std::swap(lo, hi);
  const double size = std::max(std::fabs(lo), std::fabs(hi));
  if (hi - lo > kNarrowest * size) return {lo, hi};
  const double half = size > 0 ? 0.5 * size : 0.5, middle = 0.5 * lo + 0.5 * hi;
  return {middle - half, middle + half};
}

double round_within(double value, double lo, double hi, double parts) {
  const double span = std::fabs(hi - lo);
  if (!std::isfinite(value) || !std::isfinite(span) || !(span > 0)) return value;
  const int digits = static_cast<int>(std::floor(std::log10(span / parts)));
  // division by a power of ten gives the double nearest to the short decimal, multiplication does not
  const double step = std::pow(10.0, std::abs(digits));
  const double n = std::round(digits < 0 ? value * step : value / step);
  const double rounded = digits < 0 ? n / step : n * step;
  return std::isfinite(rounded) ? rounded : value;
}

}  // namespace catena::app
