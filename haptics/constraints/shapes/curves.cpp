// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/base/system_failure.h"
#include "haptics/constraints/common/cached_bvh.h"
#include "haptics/constraints/common/morton.h"
#include "haptics/constraints/shapes/polyline_tracking.h"
#include "haptics/constraints/shapes/shapes.h"

namespace catena::haptics {
namespace {

constexpr std::uint32_t kRun = 8;  // segments per leaf
constexpr double kMinLength = 1e-30;
constexpr std::size_t kNoLine = ~std::size_t{0};

/// Lines with the BVH that finds the closest one. Segment k leads from point k to the next one.
struct LineTree {
  using Tree = ClosestPointBvh<glm::vec3>;
  curves::CurveSetPtr set;
  std::vector<std::uint32_t> runs;  ///< index of the first segment of each leaf
  std::vector<bool> is_last;        ///< whether point k ends its line
  Tree tree;

  LineTree(curves::CurveSetPtr of, std::size_t line) : set(std::move(of)), is_last(set->points.size(), false) {
    for (std::size_t k = 1; k < set->line_offsets.size(); ++k) is_last[set->line_offsets[k] - 1] = true;
    const std::size_t begin = line == kNoLine ? 0 : line, end = line == kNoLine ? set->line_count() : line + 1;
    for (std::size_t k = begin; k < end; ++k)
      for (std::uint32_t p = set->line_offsets[k]; p + 1 < set->line_offsets[k + 1]; p += kRun) runs.push_back(p);
    sort_runs();
    std::vector<Tree::Box> boxes(runs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) boxes[i] = box_of(runs[i]);
    tree = Tree(boxes);
  }

  /// Returns an upper bound of the memory of a set's tree, bytes.
  static double bytes_for(const curves::CurveSet& set) {
    const double most_runs = static_cast<double>(set.points.size()) / kRun + static_cast<double>(set.line_count());
    return most_runs * (4 * sizeof(Tree::Box) + sizeof(Tree::Box) + 2 * sizeof(std::pair<std::uint64_t, std::uint32_t>)) +
           static_cast<double>(set.points.size()) / 8;
  }

  std::uint32_t end_of_run(std::uint32_t first) const {
    std::uint32_t k = first;
    while (k < first + kRun && !is_last[k]) ++k;
    return k;
  }

 private:
  Tree::Box box_of(std::uint32_t run) const {
    Tree::Box box;
    for (std::uint32_t k = run, last = end_of_run(run); k <= last; ++k) box.add(set->points[k], set->points[k]);
    return box;
  }
  void sort_runs() {
    const double edge = std::max(max_abs(set->max_corner - set->min_corner), 1e-300);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(runs.size());
    for (const std::uint32_t run : runs) {
      const Tree::Box box = box_of(run);
      order.emplace_back(morton_code(Vec3(box.lo) * 0.5 + Vec3(box.hi) * 0.5, set->min_corner, edge), run);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i] = order[i].second;
  }
};
using LineTreePtr = std::shared_ptr<const LineTree>;

struct FileLines {
  static constexpr int kFirstVisits = 512, kVisits = 256, kVisitWork = 6, kMaxPieces = 1024;
  static constexpr int walk_work(int) { return 2; }

  LineTreePtr lines;

  bool has(std::uint32_t k) const { return k < lines->is_last.size() && !lines->is_last[k]; }
  LineSegment piece(std::uint32_t k) const { return {Vec3(lines->set->points[k]), Vec3(lines->set->points[k + 1])}; }
  std::uint32_t neighbour(std::uint32_t k, int step_sign) const {
    if (step_sign > 0) return lines->is_last[k + 1] ? k : k + 1;
    return k == 0 || lines->is_last[k - 1] ? k : k - 1;
  }
  /// Returns the index of the line that contains segment k, in the order of the file.
  int line_of(std::uint32_t k) const noexcept {
    const auto& first = lines->set->line_offsets;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), k) - first.begin()) - 1;
  }
  void search(const Vec3& probe, int max_visits, SearchState& state) const noexcept {
    lines->tree.search(
        probe, max_visits, state,
        [&](std::uint32_t k) {
          const LineSegment straight = piece(k);
          return straight.at(straight.along(probe));
        },
        [&](std::size_t leaf, const auto& see) {
          const std::uint32_t first = lines->runs[leaf];
          for (std::uint32_t k = first, end = lines->end_of_run(first); k < end; ++k) see(k);
        });
  }
  bool is_sane(const SearchState& state) const noexcept { return lines->tree.is_sane(state); }
  double extent() const noexcept { return lines->tree.extent(); }
};

Result<std::shared_ptr<const Constraint>> build_curves(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "curves"));
  CATENA_TRY(const curves::CurveSetPtr set, context.curves(*link.find("curves"), name));
  std::size_t line = kNoLine;
  if (link.find("line") != nullptr) {
    const auto last = static_cast<int>(std::min<std::size_t>(set->line_count() - 1, std::numeric_limits<int>::max()));
    CATENA_TRY(const int index, json::get_integer(link, "line", 0, 0, last));
    line = static_cast<std::size_t>(index);
  }
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  if (const auto enough = check_memory_available(fmt::format("haptics of curves \"{}\"", name), LineTree::bytes_for(*set)); !enough)
    return with_cause(json::error_at(*link.find("curves"), enough.error().message), enough.error());
  FileLines shape{cached_bvh<LineTree>(set->version, line, [&] { return std::make_shared<const LineTree>(set, line); })};
  if (!(shape.extent() >= kMinLength))
    return json::error_at(*link.find("curves"),
                          fmt::format("the lines span {}; an extent of at least {} was expected", shape.extent(), kMinLength));
  return make_closed_form<PolylineTracker<FileLines>>(std::move(shape), rules);
}

}  // namespace

ConstraintType curves_constraint() {
  return {
      "curves",
      "Holds the proxy on a line of a curve set.",
      "section 3",
      {schema::reference("curves", schema::Role::curves, "Name of an item of `curves`.").required(),
       schema::integer("line", "", "Index of the only line that can hold the proxy, counted from 0.", 0, std::numeric_limits<int>::max())
           .with_range_text("an index")
           .with_default("all lines; the link engages with the closest")},
      build_curves,
      true,
      true,
      "curves"};
}

}  // namespace catena::haptics
