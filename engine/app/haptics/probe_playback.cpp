// SPDX-License-Identifier: MIT
#include "engine/app/haptics/probe_playback.h"

#include <algorithm>

#include "engine/scene/prepare.h"

namespace catena::app {

Result<ProbePath> read_probe_samples(const std::string& probe_csv) {
  CATENA_TRY(const std::vector<ProbePathRow> rows, read_probe_path(probe_csv));
  return to_probe_samples(rows);
}

ProbePath make_resting_path(const scene::Scene& scene) {
  ProbePath path;
  if (!scene.cursor || !scene.entities.has<scene::Cursor>(scene.cursor)) return path;
  const scene::Cursor& cursor = scene.entities.get<scene::Cursor>(scene.cursor);
  if (!cursor.visible) return path;
  // resting probe: enough ticks for a distant proxy to converge
  for (int k = 0; k < 500; ++k) path.push_back({0.001 * k, cursor.probe, 0});
  return path;
}

void ProbePlayback::seek(scene::Scene& scene, double share) {
  if (path_.empty()) return;
  const double until = path_.front().t_s + share * (path_.back().t_s - path_.front().t_s);
  const auto later = [](double t_s, const haptics::ProbeSample& sample) { return t_s < sample.t_s; };
  const auto first_later = std::upper_bound(path_.begin() + 1, path_.end(), until, later);
  const std::size_t wanted = share >= 1 ? path_.size() : static_cast<std::size_t>(first_later - path_.begin());
  if (!state_ || wanted < ticks_done_) {
    state_ = std::make_unique<haptics::ChainState>();
    scratch_ = std::make_unique<haptics::ChainScratch>();
    ticks_done_ = 0;
  }
  for (; ticks_done_ < wanted; ++ticks_done_) ticks_.run(*program_, path_[ticks_done_], *state_, *scratch_, last_state_);
  scene::update_cursor(scene, last_state_);
  scene::Cursor& cursor = scene.entities.get<scene::Cursor>(scene.cursor);
  cursor.names.clear();
  for (const haptics::Link& link : program_->links) cursor.names.push_back(link.name);
}

}  // namespace catena::app
