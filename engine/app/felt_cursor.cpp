#include "engine/app/felt_cursor.h"

#include "engine/app/probe_samples.h"
#include "engine/scene/systems.h"

namespace catena::app {

namespace {
// a still hand: as many ticks as a distant proxy may need to arrive
std::vector<haptics::ProbeSample> resting_at(const Vec3& probe) {
  std::vector<haptics::ProbeSample> path;
  for (int k = 0; k < 500; ++k) path.push_back({0.001 * k, probe, 0});
  return path;
}
}  // namespace

Result<FeltPath> FeltPath::make(const scene::Scene& scene, std::shared_ptr<const haptics::Program> program, const std::string& probe_csv) {
  FeltPath felt;
  felt.program_ = std::move(program);
  if (!probe_csv.empty()) {
    CATENA_TRY(const std::vector<ProbeRow> rows, read_probe_path(probe_csv));
    felt.path_ = probe_samples(rows);
  } else if (scene.cursor && scene.world.has<scene::Cursor>(scene.cursor) && scene.world.get<scene::Cursor>(scene.cursor).visible) {
    felt.path_ = resting_at(scene.world.get<scene::Cursor>(scene.cursor).probe);
  }
  return felt;
}

void FeltPath::show(scene::Scene& scene, double share) {
  if (empty()) return;
  const double until = path_.front().t_s + share * (path_.back().t_s - path_.front().t_s);
  std::size_t wanted = 1;
  while (wanted < path_.size() && (share >= 1 || path_[wanted].t_s <= until)) ++wanted;
  if (!state_ || wanted < done_) {
    state_ = std::make_unique<haptics::ChainState>();
    scratch_ = std::make_unique<haptics::ChainScratch>();
    done_ = 0;
  }
  for (; done_ < wanted; ++done_) haptics::tick(*program_, path_[done_], *state_, *scratch_, last_);
  scene::update_cursor(scene, last_);
  scene::Cursor& cursor = scene.world.get<scene::Cursor>(scene.cursor);
  cursor.names.clear();
  for (const haptics::Link& link : program_->links) cursor.names.push_back(link.name);
}

}  // namespace catena::app
