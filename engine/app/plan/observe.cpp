#include "engine/app/plan/observe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/tradeoff/measure/hand/streamline.h"

namespace catena::app::plan {
namespace {

constexpr double kTraced = 10.2, kLongest = 100;  // L

}  // namespace

HandObserver::HandObserver(const HandPlan* plan, const haptics::Program& program) {
  if (plan == nullptr) return;
  for (const PlannedLink& planned : plan->links())
    for (std::size_t i = 0; i < program.links.size(); ++i)
      if (program.links[i].name == planned.link) {
        Track track;
        track.link = planned.link;
        track.index = static_cast<int>(i);
        tracks_.push_back(std::move(track));
      }
}

void HandObserver::add(const exchange::HapticState& state) {
  for (Track& track : tracks_) {
    if (track.index >= state.link_count) continue;
    const exchange::LinkReport& report = state.links[static_cast<std::size_t>(track.index)];
    if (!report.active || report.status != exchange::Status::ok) continue;
    if (track.seen > 0) track.way += norm(report.proxy - track.last);
    track.last = report.proxy;
    if (track.seen++ % track.stride == 0) track.places.push_back(report.proxy);
    if (track.places.size() < kMost) continue;
    for (std::size_t k = 0; k < track.places.size() / 2; ++k) track.places[k] = track.places[2 * k];
    track.places.resize(track.places.size() / 2);
    track.stride *= 2;
  }
}

std::optional<double> HandObserver::error(scene::Scene& scene) const {
  std::optional<double> most;
  for (const Track& track : tracks_) {
    if (track.places.empty()) continue;
    for (const tradeoff::LinkOf& link : tradeoff::links_of_type(scene, "streamline")) {
      if (link.name != track.link) continue;
      const auto stated = tradeoff::stated_line(scene, link);
      if (!stated) continue;
      // what is traced once may be held anywhere along it
      const double length = stated->field->length(), far = std::clamp(1.1 * track.way, kTraced * length, kLongest * length);
      const auto line = flow::trace(stated->flow, stated->seed, tradeoff::converged(far));
      if (!line) continue;
      const flow::NearestOnCurve nearest(*line);
      double far2 = 0;
      for (const Vec3& place : track.places) far2 = std::max(far2, nearest.exact(place).distance2);
      most = std::max(most.value_or(0), std::sqrt(far2));
    }
  }
  return most;
}

std::string HandObserver::sentence(scene::Scene& scene, std::optional<double> us) const {
  if (tracks_.empty()) return {};
  const auto off = error(scene);
  std::string text = "observed: ";
  text += off ? fmt::format("error {:.2g} (the cells' own error is not in it)", *off) : "no planned link held";
  if (us) text += fmt::format(" in {:.3g} us a tick", *us);
  return text + "\n";
}

}  // namespace catena::app::plan
