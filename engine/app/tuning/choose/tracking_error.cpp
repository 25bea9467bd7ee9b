// SPDX-License-Identifier: MIT
#include "engine/app/tuning/choose/tracking_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/tuning/measure/haptics/streamline.h"

namespace catena::app::tuning {
namespace {

constexpr double kTraced = 10.2, kLongest = 100;  // L

}  // namespace

TrackingErrorMonitor::TrackingErrorMonitor(const TickTuning* plan, const haptics::HapticProgram& program) {
  if (plan == nullptr) return;
  for (const TunedLink& planned : plan->links())
    for (std::size_t i = 0; i < program.links.size(); ++i)
      if (program.links[i].name == planned.link) {
        Track track;
        track.link = planned.link;
        track.index = static_cast<int>(i);
        tracks_.push_back(std::move(track));
      }
}

void TrackingErrorMonitor::add(const HapticState& state) {
  for (Track& track : tracks_) {
    if (track.index >= state.link_count) continue;
    const LinkReport& report = state.links[static_cast<std::size_t>(track.index)];
    if (!report.active || report.status != LinkStatus::ok) continue;
    if (track.proxy_count > 0) track.path_length += norm(report.proxy - track.last_position);
    track.last_position = report.proxy;
    if (track.proxy_count++ % track.stride == 0) track.positions.push_back(report.proxy);
    if (track.positions.size() < kMaxPositions) continue;
    for (std::size_t k = 0; k < track.positions.size() / 2; ++k) track.positions[k] = track.positions[2 * k];
    track.positions.resize(track.positions.size() / 2);
    track.stride *= 2;
  }
}

std::optional<double> TrackingErrorMonitor::max_error(scene::Scene& scene) const {
  std::optional<double> maximum;
  for (const Track& track : tracks_) {
    if (track.positions.empty()) continue;
    for (const tuning::NamedLink& link : tuning::find_links(scene, "streamline")) {
      if (link.name != track.link) continue;
      const auto stated = tuning::resolve_link_streamline(scene, link);
      if (!stated) continue;
      // with a precomputed line the proxy may be anywhere along it
      const double length = stated->field->domain_length(), far = std::clamp(1.1 * track.path_length, kTraced * length, kLongest * length);
      const auto line = flow::trace(stated->flow, stated->seed, tuning::converged_trace_options(far));
      if (!line) continue;
      const flow::NearestOnCurve nearest(*line);
      double far2 = 0;
      for (const Vec3& place : track.positions) far2 = std::max(far2, nearest.find_exact(place).distance2);
      maximum = std::max(maximum.value_or(0), std::sqrt(far2));
    }
  }
  return maximum;
}

std::string TrackingErrorMonitor::summary(scene::Scene& scene, std::optional<double> us) const {
  if (tracks_.empty()) return {};
  const auto off = max_error(scene);
  std::string text = "observed: ";
  text += off ? fmt::format("error {:.2g} (without the discretization error)", *off) : "no tuned link was in contact";
  if (us) text += fmt::format(" in {:.3g} us per tick", *us);
  return text + "\n";
}

}  // namespace catena::app::tuning
