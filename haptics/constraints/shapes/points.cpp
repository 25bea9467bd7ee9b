// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/base/system_failure.h"
#include "haptics/constraints/common/cached_bvh.h"
#include "haptics/constraints/common/closest_point_bvh.h"
#include "haptics/constraints/common/morton.h"
#include "haptics/constraints/shapes/closed_form.h"
#include "haptics/constraints/shapes/shapes.h"

namespace catena::haptics {
namespace {

constexpr std::size_t kPointsOfLeaf = 8;

/// Points in the order of a Morton curve, eight per leaf.
struct PointTree {
  using Tree = ClosestPointBvh<glm::vec3>;
  Vec3 origin;  ///< origin to which points and BVH refer
  std::vector<glm::vec3> points;
  Tree tree;

  explicit PointTree(const curves::PointSet& set) : origin(set.origin) {
    const double edge = std::max(max_abs(set.max_corner - set.min_corner), 1e-300);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(set.points.size());
    for (std::size_t i = 0; i < set.points.size(); ++i)
      order.emplace_back(morton_code(set.position(i), set.min_corner, edge), static_cast<std::uint32_t>(i));
    std::sort(order.begin(), order.end());
    points.reserve(order.size());
    for (const auto& [code, i] : order) points.push_back(set.points[i]);
    std::vector<Tree::Box> boxes((points.size() + kPointsOfLeaf - 1) / kPointsOfLeaf);
    for (std::size_t i = 0; i < points.size(); ++i) boxes[i / kPointsOfLeaf].add(points[i], points[i]);
    tree = Tree(boxes);
  }
  /// Returns an upper bound of the memory of a set's tree, bytes.
  static double bytes_for(const curves::PointSet& set) {
    return static_cast<double>(set.points.size()) * (sizeof(glm::vec3) + 16 + 5.0 * sizeof(Tree::Box) / kPointsOfLeaf);
  }
};

class NearestPoint final : public ContactSurface {
 public:
  using Shape = std::shared_ptr<const PointTree>;
  struct Memory {
    SearchState search;
    std::uint32_t held;
  };
  static constexpr int kFirstVisits = 768, kVisits = 256, kVisitWork = 3;
  NearestPoint(const Shape& shape, Memory& memory, const SideMemory&) : shape_(*shape), memory_(memory) {}

  static bool is_sane(const Shape& shape, const Memory& m) noexcept {
    return shape->tree.is_sane(m.search) && m.search.best_item < shape->points.size() && m.held < shape->points.size();
  }
  SideValue evaluate_side(const Vec3&) noexcept override { return {}; }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    search(probe);
    return memory_.search.in_progress ? SurfaceHold{false, probe, 0, LinkStatus::budget} : hold();
  }
  SurfaceHold slide(const Vec3&) noexcept override { return hold(); }
  SurfaceHold find_crossing(const Vec3&, const Vec3&) noexcept override { return {}; }
  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    search(probe);
    if (!(norm(probe - held()) <= limit)) return {};
    memory_.search.in_progress = false;
    return hold();
  }

  int work() const noexcept { return work_; }
  Vec3 normal() const noexcept override { return Vec3(0.0); }
  double domain_length() const noexcept override { return std::max(kDefaultDomainLength, shape_.tree.extent()); }
  bool primitive(const Vec3&, Primitive& out) noexcept {
    out = {Primitive::Kind::point, held(), Vec3(0.0)};
    return true;
  }

 private:
  void search(const Vec3& probe) noexcept {
    SearchState& search = memory_.search;
    shape_.tree.search(
        probe - shape_.origin, search.has_best ? kVisits : kFirstVisits, search, [&](std::uint32_t k) { return Vec3(shape_.points[k]); },
        [&](std::size_t leaf, const auto& see) {
          const std::size_t last = std::min((leaf + 1) * kPointsOfLeaf, shape_.points.size());
          for (std::size_t k = leaf * kPointsOfLeaf; k < last; ++k) see(static_cast<std::uint32_t>(k));
        });
    work_ += kVisitWork * search.visits;
    memory_.held = search.best_item;
  }
  Vec3 held() const noexcept {
    const Vec3 p(shape_.points[memory_.held]);
    return shape_.origin == Vec3(0.0) ? p : shape_.origin + p;
  }
  SurfaceHold hold() const noexcept { return {true, held(), 0, LinkStatus::ok}; }

  const PointTree& shape_;
  Memory& memory_;
  int work_ = 0;
};

Result<std::shared_ptr<const Constraint>> build_points(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "points"));
  CATENA_TRY(const curves::PointSetPtr set, context.points(*link.find("points"), name));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  if (const auto enough = check_memory_available(fmt::format("haptics of points \"{}\"", name), PointTree::bytes_for(*set)); !enough)
    return with_cause(json::error_at(*link.find("points"), enough.error().message), enough.error());
  return make_closed_form<NearestPoint>(cached_bvh<PointTree>(set->version, 0, [&] { return std::make_shared<const PointTree>(*set); }),
                                        rules);
}

}  // namespace

ConstraintType points_constraint() {
  return {"points",     "Holds the proxy at a point of a point set.",
          "section 3",  {schema::reference("points", schema::Role::points, "Name of an item of `points`.").required()},
          build_points, true,
          false,        "points"};
}

}  // namespace catena::haptics
