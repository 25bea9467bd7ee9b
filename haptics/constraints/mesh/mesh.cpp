// SPDX-License-Identifier: MIT
#include "haptics/constraints/mesh/mesh.h"

#include "haptics/constraints/common/one_sided_contact.h"
#include "haptics/constraints/common/pull_back.h"
#include "haptics/constraints/mesh/god_object.h"
#include "haptics/constraints/mesh/mesh_walk.h"

namespace catena::haptics {
namespace {

constexpr double kFarthest = 1e6;  // in the mesh's local frame; a probe beyond is moved toward the mesh, to this distance
constexpr double kReachOfWalk = 32;
constexpr double kMeshSearchRadius = 4e6;

Vec3 own_of(const mesh::TriangleMesh& mesh, const Vec3& probe, double farthest) {
  // halved values, so that no difference overflows
  const Vec3 half = probe * 0.5 - mesh.world_from_local(Vec3(0.0)) * 0.5;
  const double m = max_abs(half), maximum = 0.5 * farthest * mesh.scale();
  if (m > maximum) return Vec3(half.x / m, half.y / m, half.z / m) * farthest;
  return mesh.local_from_world(probe);
}

mesh::NearestResult nearest_to(const mesh::TriangleMesh& mesh, const Vec3& x, double radius, std::uint32_t hint, LinkState& state) {
  const int maximum = state.affordable_steps(kMaxGodObjectNodes);
  int nodes = maximum;
  const mesh::NearestResult nearest = mesh::nearest_point(mesh, x, radius, nodes, hint);
  state.other_work += maximum - std::max(nodes, 0);
  return nearest;
}

// ---- two-sided contact ----

struct WalkMemory {
  SideMemory side;
  mesh::ClosestPoint at;
};

class MeshSurface final : public ContactSurface {
 public:
  MeshSurface(const mesh::TriangleMesh& mesh, WalkMemory& memory, LinkState& state) : mesh_(mesh), memory_(memory), state_(state) {}

  SideValue evaluate_side(const Vec3&) noexcept override { return {0, true, false}; }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    const mesh::NearestResult nearest = nearest_to(mesh_, own(probe), kMeshSearchRadius, memory_.at.face, state_);
    if (!nearest.found) return {};
    return hold({nearest.closest, nearest.is_complete, 0});
  }
  SurfaceHold slide(const Vec3& probe) noexcept override { return hold(walk_mesh(mesh_, memory_.at.face, own(probe))); }

  SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept override {
    const Vec3 a = own_of(mesh_, from, kFarthest), b = own_of(mesh_, probe, kFarthest);
    double part = 2;
    std::uint32_t face = 0;
    Vec3 to = b;
    const int maximum = state_.affordable_steps(kMaxGodObjectNodes);
    int nodes = maximum;
    const bool complete = mesh_.bvh().visit_segment(a, to, kGodObjectGap, nodes, [&](std::uint32_t f) {
      const double ha = mesh_.face(f).signed_distance(a), hb = mesh_.face(f).signed_distance(b);
      if ((ha < 0) == (hb < 0)) return;
      const double at = ha / (ha - hb);
      if (!(at < part) || !mesh_.face(f).covers(a + at * (b - a), kGodObjectGap)) return;
      part = at;
      face = f;
      to = a + at * (b - a);
    });
    state_.other_work += maximum - std::max(nodes, 0);
    if (part > 1 || !complete) return {};
    return hold(walk_mesh(mesh_, face, own(probe)));
  }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    const mesh::NearestResult nearest = nearest_to(mesh_, own(probe), limit / mesh_.scale(), memory_.at.face, state_);
    return nearest.found ? hold({nearest.closest, nearest.is_complete, 0}) : SurfaceHold{};
  }

  Vec3 normal() const noexcept override { return mesh_.face(memory_.at.face).normal; }
  bool may_tunnel() const noexcept override { return true; }
  double domain_length() const noexcept override { return mesh_.domain_length(); }

 private:
  Vec3 own(const Vec3& probe) const noexcept { return own_of(mesh_, probe, kReachOfWalk); }
  SurfaceHold hold(const MeshWalkResult& walk) noexcept {
    memory_.at = walk.closest;
    state_.other_work += walk.faces;
    const double off = std::fabs(mesh_.face(walk.closest.face).signed_distance(walk.closest.point));
    return {true, mesh_.world_from_local(walk.closest.point), off * mesh_.scale(), walk.complete ? LinkStatus::ok : LinkStatus::budget};
  }

  const mesh::TriangleMesh& mesh_;
  WalkMemory& memory_;
  LinkState& state_;
};

class TwoSidedMesh final : public Constraint {
 public:
  TwoSidedMesh(mesh::MeshPtr mesh, const SideSpec& rules) : mesh_(std::move(mesh)), rules_(rules) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    auto& memory = memory_as<WalkMemory>(state);
    memory = WalkMemory{};
    MeshSurface surface(*mesh_, memory, state);
    start_on_surface(surface, rules_.rules_at(probe, state, scratch), probe, memory.side, state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    auto& memory = memory_as<WalkMemory>(state);
    MeshSurface surface(*mesh_, memory, state);
    advance_on_surface(surface, rules_.rules_at_proxy(state, scratch), probe, memory.side, state);
  }
  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const auto& memory = memory_as<WalkMemory>(state);
    if (!memory.side.holding) return false;
    out = {Primitive::Kind::plane, state.proxy, mesh_->face(memory.at.face).normal};
    return true;
  }
  /// Returns the force pulled back on the face, edge or corner that holds the proxy.
  PulledBackForce pull_back(const Vec3&, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const auto& memory = memory_as<WalkMemory>(state);
    const mesh::ClosestPoint& at = memory.at;
    if (!memory.side.holding) return {f};
    if (at.corner >= 0) return {};
    if (at.edge < 0) return haptics::pull_back({Primitive::Kind::plane, state.proxy, mesh_->face(at.face).normal}, f);
    const Vec3 along = mesh_->corner(at.face, (at.edge + 1) % 3) - mesh_->corner(at.face, at.edge);
    return haptics::pull_back({Primitive::Kind::line, state.proxy, direction(along)}, f);
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const auto& memory = memory_as<WalkMemory>(state);
    return haptics::is_sane(memory.side) && memory.at.face < mesh_->triangles().size();
  }
  bool has_primitive() const noexcept override { return true; }
  double domain_length() const noexcept override { return mesh_->domain_length(); }

 private:
  mesh::MeshPtr mesh_;
  SideSpec rules_;
};

// ---- one-sided contact ----

struct GodMemory {
  GodObject god;
  Vec3 probe, proxy;
  double residual;
  std::uint32_t hint;  ///< a nearby face, where the search starts
  LinkStatus status;
  bool fresh;    ///< the other fields are valid
  bool settled;  ///< converged: another tick at the same probe changes nothing
};

class OneSidedMesh final : public Constraint {
 public:
  OneSidedMesh(mesh::MeshPtr mesh, const SideSpec& rules) : mesh_(std::move(mesh)), rules_(rules) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    auto& memory = memory_as<GodMemory>(state);
    memory = GodMemory{};
    state.released = false;
    const SideRules rules = rules_.rules_at(probe, state, scratch);
    if (is_free(probe, memory, state)) return leave(probe, 0, LinkStatus::free, memory, probe, state);
    const Vec3 proxy = mesh_->world_from_local(memory.god.p);
    if (rules.release > 0 && norm(probe - proxy) > rules.release) {
      state.released = true;
      return leave(probe, 0, LinkStatus::released, memory, probe, state);
    }
    leave(proxy, 0, LinkStatus::budget, memory, probe, state);
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    auto& memory = memory_as<GodMemory>(state);
    const double release = rules_.rules_at_proxy(state, scratch).release;
    state.limit = release;
    const bool untouched = memory.fresh && bitwise_equal(memory.proxy, state.proxy);
    if (untouched && memory.settled && bitwise_equal(memory.probe, probe)) {
      state.proxy = memory.proxy;
      state.residual = memory.residual;
      state.status = memory.status;
      return;
    }

    // released, or moved from outside: determine the side of the probe
    if (state.released || !untouched) {
      const bool free = is_free(probe, memory, state);
      if (state.released && !free) return leave(probe, 0, LinkStatus::released, memory, probe, state);
      state.released = false;
      if (free) return leave(probe, 0, LinkStatus::free, memory, probe, state);
    }

    const GodObjectMove move =
        move_god_object(*mesh_, outside(), own_of(*mesh_, probe, kFarthest), state.affordable_steps(kMaxGodObjectNodes), memory.god);
    state.other_work += move.nodes;
    if (move.reached) return leave(probe, 0, LinkStatus::free, memory, probe, state);
    const Vec3 proxy = mesh_->world_from_local(memory.god.p);
    if (release > 0 && norm(probe - proxy) >= release) {
      state.released = true;
      return leave(probe, 0, LinkStatus::released, memory, probe, state);
    }
    const double residual =
        memory.god.count > 0 ? std::fabs(mesh_->face(memory.god.faces[0]).signed_distance(memory.god.p)) * mesh_->scale() : 0;
    leave(proxy, residual, move.complete ? LinkStatus::ok : LinkStatus::budget, memory, probe, state);
  }

  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const auto& memory = memory_as<GodMemory>(state);
    const GodObject& god = memory.god;
    if (state.released || memory.status == LinkStatus::free || god.binding == 0) return false;
    if (god.binding == 1) {
      out = {Primitive::Kind::plane, state.proxy, god.normals[0]};
    } else if (god.binding == 2) {
      out = {Primitive::Kind::line, state.proxy, direction(cross(god.normals[0], god.normals[1]))};
    } else {
      out = {Primitive::Kind::point, state.proxy, Vec3(0.0)};
    }
    return true;
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept override {
    Primitive binding;
    return primitive(probe, state, scratch, binding) ? haptics::pull_back(binding, f) : PulledBackForce{f};
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const auto& memory = memory_as<GodMemory>(state);
    const std::size_t faces = mesh_->triangles().size();
    for (const std::uint32_t face : memory.god.faces)
      if (face >= faces) return false;
    return memory.god.count >= 0 && memory.god.count <= GodObject::kMaxFaces && memory.god.binding >= 0 && memory.god.binding <= 3 &&
           memory.hint < faces && is_valid_enum(memory.status, LinkStatus::bad_probe) && are_valid_bools(memory.fresh, memory.settled);
  }
  bool has_primitive() const noexcept override { return true; }
  double domain_length() const noexcept override { return mesh_->domain_length(); }

 private:
  double outside() const { return rules_.free == FreeSide::above ? 1 : -1; }

  /// Determines the side by the nearest point. Returns true on the free side, or over an open edge; the god-object is then at the probe,
  /// otherwise at the nearest point.
  bool is_free(const Vec3& probe, GodMemory& memory, LinkState& state) const noexcept {
    const Vec3 x = own_of(*mesh_, probe, kFarthest);
    memory.god = GodObject{};
    memory.god.p = x;
    const mesh::NearestResult nearest = nearest_to(*mesh_, x, kMeshSearchRadius, memory.hint, state);
    if (!nearest.found) return true;
    memory.hint = nearest.closest.face;
    const Vec3 normal = direction(mesh::normal_at(*mesh_, nearest.closest)) * outside();
    if (mesh::is_on_boundary(*mesh_, nearest.closest) || dot(normal, x - nearest.closest.point) >= 0) return true;
    memory.god.p = nearest.closest.point + kGodObjectGap * normal;
    memory.god.faces[0] = nearest.closest.face;
    memory.god.count = 1;
    return false;
  }

  void leave(const Vec3& proxy, double residual, LinkStatus status, GodMemory& memory, const Vec3& probe, LinkState& state) const noexcept {
    if (status == LinkStatus::free || status == LinkStatus::released) memory.god.binding = memory.god.count = 0;
    state.proxy = memory.proxy = proxy;
    state.residual = memory.residual = residual;
    state.status = memory.status = status;
    memory.probe = probe;
    memory.fresh = true;
    memory.settled = status != LinkStatus::budget;
  }

  mesh::MeshPtr mesh_;
  SideSpec rules_;
};

Result<std::shared_ptr<const Constraint>> build_mesh(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "mesh"));
  CATENA_TRY(mesh::MeshPtr mesh, context.mesh(*link.find("mesh"), name));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  if (rules.free == FreeSide::none) return std::shared_ptr<const Constraint>(std::make_shared<TwoSidedMesh>(std::move(mesh), rules));
  return std::shared_ptr<const Constraint>(std::make_shared<OneSidedMesh>(std::move(mesh), rules));
}

}  // namespace

ConstraintType mesh_constraint() {
  return {"mesh",
          "Holds the proxy on a triangle mesh, from both sides or as a god object.",
          "section 3; god-object",
          {schema::reference("mesh", schema::Role::mesh, "Name of an item of `meshes`.").required(),
           free_key("the side to which the face normals point")},
          build_mesh,
          true,
          true,
          "meshes"};
}

}  // namespace catena::haptics
