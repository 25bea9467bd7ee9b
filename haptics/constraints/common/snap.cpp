// SPDX-License-Identifier: MIT
#include "haptics/constraints/common/snap.h"

#include <fmt/format.h>

#include "haptics/constraints/common/link_schema.h"

namespace catena::haptics {
namespace {

constexpr double kReleasePart = 2, kMaxSnap = 0.9;

struct SnapMemory {
  Vec3 hidden{0.0};  ///< proxy of the inner constraint while the link is released
  bool apart;
};

struct Distances {
  double snap, release;
};

class Snap final : public Constraint {
 public:
  Snap(std::shared_ptr<const Constraint> inner, const SnapSpec& spec) : inner_(std::move(inner)), spec_(spec) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    SnapMemory& memory = wrapper_memory_as<SnapMemory>(state);
    memory = SnapMemory{};
    memory.apart = spec_.has_snap;
    if (!memory.apart) return inner_->start(probe, state, scratch);
    state.proxy = memory.hidden = probe;
    state.released = true;
    state.status = LinkStatus::released;
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    SnapMemory& memory = wrapper_memory_as<SnapMemory>(state);
    const Distances distances = at_last_proxy(state, scratch);
    if (!memory.apart) {
      state.released = false;
      state.limit = 0;
      inner_->advance(probe, state, scratch);
      const bool stays = state.status != LinkStatus::no_surface && state.status != LinkStatus::released &&
                         !(norm(probe - state.proxy) >= distances.release);
      if (stays) return hold(memory, distances, state);
      return stay_apart(memory, distances, probe, LinkStatus::released, state);
    }

    // released: finds the feature, and whether it is within the snap distance; a search out of budget finds nothing
    state.released = false;
    state.proxy = memory.hidden;
    inner_->seek(probe, state, scratch);
    const bool found = state.evaluations < kMaxEvaluations && state.status != LinkStatus::budget && state.status != LinkStatus::no_surface;
    if (found && norm(probe - state.proxy) <= distances.snap) {
      inner_->advance(probe, state, scratch);
      if (state.status != LinkStatus::no_surface && !(norm(probe - state.proxy) >= distances.release))
        return hold(memory, distances, state);
    }
    stay_apart(memory, distances, probe, state.status == LinkStatus::no_surface ? LinkStatus::no_surface : LinkStatus::released, state);
  }

  bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept override {
    return !wrapper_memory_as<SnapMemory>(state).apart && inner_->primitive(at, state, scratch, out);
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept override {
    return wrapper_memory_as<SnapMemory>(state).apart ? PulledBackForce{f} : inner_->pull_back(probe, f, state, scratch);
  }
  bool is_sane(const LinkState& state) const noexcept override {
    return are_valid_bools(wrapper_memory_as<SnapMemory>(state).apart) && inner_->is_sane(state);
  }
  bool has_primitive() const noexcept override { return inner_->has_primitive(); }
  bool is_energy_source() const noexcept override { return inner_->is_energy_source(); }
  double domain_length() const noexcept override { return inner_->domain_length(); }

 private:
  Distances at_last_proxy(LinkState& state, LinkScratch& scratch) const noexcept {
    const auto ask = [&](const Parameter& parameter) { return parameter.at(state.proxy, scratch.parameter_cursor, state.evaluations); };
    const double snap = spec_.has_snap ? ask(spec_.snap) : 0;
    const double release = spec_.has_release ? ask(spec_.release) : kReleasePart * snap;
    return {spec_.has_snap ? std::fmin(snap, kMaxSnap * release) : kRearmFraction * release, release};
  }

  /// Engages the link: takes over the state of the inner constraint.
  static void hold(SnapMemory& memory, const Distances& distances, LinkState& state) noexcept {
    memory.apart = false;
    memory.hidden = state.proxy;
    state.released = state.status == LinkStatus::released;
    if (!(state.limit > 0 && state.limit < distances.release)) state.limit = distances.release;
  }
  /// Keeps the link released: the probe passes through; the proxy of the inner constraint is kept in the memory.
  static void stay_apart(SnapMemory& memory, const Distances& distances, const Vec3& probe, LinkStatus status, LinkState& state) noexcept {
    memory.apart = true;
    memory.hidden = state.proxy;
    state.proxy = probe;
    state.residual = 0;
    state.limit = distances.release;
    state.released = status == LinkStatus::released;
    state.curve_index = -1;
    state.status = status;
  }

  std::shared_ptr<const Constraint> inner_;
  SnapSpec spec_;
};

}  // namespace

std::shared_ptr<const Constraint> make_snap(std::shared_ptr<const Constraint> inner, const SnapSpec& spec) {
  CATENA_ASSERT(inner && (spec.has_snap || spec.has_release));
  return std::make_shared<Snap>(std::move(inner), spec);
}

Result<std::shared_ptr<const Constraint>> wrap_snap(const json::Node& link, bool releases_itself, std::shared_ptr<const Constraint> inner,
                                                    const BuildContext& context) {
  SnapSpec spec;
  spec.has_snap = link.find("snap") != nullptr;
  spec.has_release = link.find("release") != nullptr;
  if (!spec.has_snap && (releases_itself || !spec.has_release)) return inner;
  CATENA_TRY(spec.snap, get_parameter(link, "snap", 0.0, json::NumberRange::positive, context));
  CATENA_TRY(spec.release, get_parameter(link, "release", 0.0, json::NumberRange::positive, context));
  const bool both = spec.has_snap && spec.has_release && spec.snap.is_constant() && spec.release.is_constant();
  if (both && !(spec.release.min() > spec.snap.max()))
    return json::error_at(*link.find("release"), fmt::format("\"release\" is {}; a number > \"snap\", which is {}, was expected",
                                                             spec.release.min(), spec.snap.max()));
  return make_snap(std::move(inner), spec);
}

}  // namespace catena::haptics
