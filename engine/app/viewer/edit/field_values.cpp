#include "engine/app/viewer/edit/field_values.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <system_error>

#include "engine/scene/transfer.h"

namespace catena::app {

namespace {
constexpr std::size_t kMaxMagnitudes = 1u << 20;
}

std::vector<float> histogram_bars(const std::vector<float>& sorted, double lo, double hi, int bars) {
  std::vector<float> heights(static_cast<std::size_t>(std::max(bars, 0)), 0.0f);
  if (heights.empty() || !(lo < hi) || !std::isfinite(hi - lo)) return heights;
  auto from = std::lower_bound(sorted.begin(), sorted.end(), lo, [](float v, double edge) { return v < edge; });
  float most = 0;
  for (int i = 0; i < bars; ++i) {
    // the last one holds its upper edge
    const double edge = i + 1 == bars ? std::nextafter(hi, HUGE_VAL) : lo + (hi - lo) * (i + 1) / bars;
    const auto to = std::lower_bound(from, sorted.end(), edge, [](float v, double e) { return v < e; });
    heights[static_cast<std::size_t>(i)] = std::log1p(static_cast<float>(to - from));
    most = std::max(most, heights[static_cast<std::size_t>(i)]);
    from = to;
  }
  for (float& h : heights) h = most > 0 ? h / most : 0;
  return heights;
}

double quantile_of(const std::vector<float>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size() - 1))];
}

void FieldValues::collect() {
  if (!job_ || !job_->done) return;
  known_[job_->version] = std::move(job_->values);
  job_.reset();
}

SortedValues FieldValues::of(scene::Scene& scene, scene::Entity field) {
  collect();
  const scene::FieldSource& source = scene.world.get<scene::FieldSource>(field);
  const field::AnyField& any = source.drawn.get() != nullptr ? source.drawn : source.loaded;
  if (any.get() == nullptr || !any.get()->is_grid()) return nullptr;
  // the transfer functions may have asked for them already, or be glad of them later
  const auto* sample = scene.made.has<scene::ValueSample>(field) ? &scene.made.get<scene::ValueSample>(field) : nullptr;
  if (sample != nullptr && sample->grid == any.get()) return sample->sorted;
  const std::uint64_t version = any.get()->version();
  if (const auto it = known_.find(version); it != known_.end()) {
    if (source.drawn.scalar && sample == nullptr) scene.made.emplace<scene::ValueSample>(field, {source.drawn.get(), it->second});
    return it->second;
  }
  if (job_) return nullptr;
  job_ = std::make_unique<Job>();
  job_->version = version;
  const auto sort = [job = job_.get(), any] {
    if (any.scalar) {
      job->values = scene::sorted_values(*any.scalar->grid());
    } else {
      auto values = std::make_shared<std::vector<float>>(scene::sample_magnitudes(*any.vector->grid(), kMaxMagnitudes));
      std::sort(values->begin(), values->end());
      job->values = std::move(values);
    }
    job->done = true;
  };
  try {
    job_->thread = std::jthread(sort);
  } catch (const std::system_error&) {
    job_.reset();  // without a histogram for now
  }
  return nullptr;
}

void FieldValues::tidy(const scene::Scene& scene) {
  std::set<std::uint64_t> live;
  scene.world.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    for (const field::AnyField* any : {&source.loaded, &source.drawn})
      if (any->get() != nullptr) live.insert(any->get()->version());
  });
  std::erase_if(known_, [&](const auto& entry) { return !live.contains(entry.first); });
}

}  // namespace catena::app
