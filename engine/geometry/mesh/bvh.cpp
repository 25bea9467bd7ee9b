// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/bvh.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/base/result.h"

namespace catena::mesh {
namespace {

constexpr std::size_t kLeaf = 4, kBins = 16;
constexpr int kSahDepth = 32;  // deeper nodes are split in halves: at most 25 more levels for 2^32 faces / 4

FaceBox empty_box() {
  const double inf = std::numeric_limits<double>::infinity();
  return {Vec3(inf), Vec3(-inf)};
}

void add(FaceBox& box, const FaceBox& other) {
  box.lo = {std::min(box.lo.x, other.lo.x), std::min(box.lo.y, other.lo.y), std::min(box.lo.z, other.lo.z)};
  box.hi = {std::max(box.hi.x, other.hi.x), std::max(box.hi.y, other.hi.y), std::max(box.hi.z, other.hi.z)};
}

double half_area(const FaceBox& box) {
  const Vec3 d = box.hi - box.lo;
  return d.x < 0 ? 0 : d.x * d.y + d.y * d.z + d.z * d.x;
}

float rounded_down(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float rounded_up(double v) { return -rounded_down(-v); }

}  // namespace

struct Bvh::Builder {
  const std::vector<FaceBox>& boxes;
  std::vector<std::uint32_t>& order;
  std::vector<BvhNode>& nodes;
  std::vector<Vec3> centres;

  FaceBox bounds(std::size_t begin, std::size_t end) const {
    FaceBox box = empty_box();
    for (std::size_t i = begin; i < end; ++i) add(box, boxes[order[i]]);
    return box;
  }

  /// Partitions the faces and returns the index of the first face of the right part.
  std::size_t split(std::size_t begin, std::size_t end, int depth) {
    FaceBox box = empty_box();
    for (std::size_t i = begin; i < end; ++i) add(box, {centres[order[i]], centres[order[i]]});
    const Vec3 extent = box.hi - box.lo;
    const std::size_t middle = begin + (end - begin) / 2;
    if (!(max_abs(extent) > 0)) return middle;

    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1;
    std::size_t best_bin = 0;
    const auto bin_of = [&](std::uint32_t f, int axis) {
      const double part = (centres[f][axis] - box.lo[axis]) / extent[axis];
      return std::min(kBins - 1, static_cast<std::size_t>(part * static_cast<double>(kBins)));
    };
    for (int axis = 0; axis < 3 && depth < kSahDepth; ++axis) {
      if (!(extent[axis] > 0)) continue;
      std::array<FaceBox, kBins> bins;
      bins.fill(empty_box());
      std::array<std::size_t, kBins> counts{};
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t b = bin_of(order[i], axis);
        add(bins[b], boxes[order[i]]);
        ++counts[b];
      }
      std::array<double, kBins> right_cost{};
      FaceBox part = empty_box();
      std::size_t count = 0;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        add(part, bins[b]);
        count += counts[b];
        right_cost[b] = half_area(part) * static_cast<double>(count);
      }
      part = empty_box();
      count = 0;
      for (std::size_t b = 1; b < kBins; ++b) {
        add(part, bins[b - 1]);
        count += counts[b - 1];
        const double cost = half_area(part) * static_cast<double>(count) + right_cost[b];
        if (count > 0 && count < end - begin && cost < best) {
          best = cost;
          best_axis = axis;
          best_bin = b;
        }
      }
    }
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    if (best_axis >= 0) {
      const auto cut = std::stable_partition(at(begin), at(end), [&](std::uint32_t f) { return bin_of(f, best_axis) < best_bin; });
      return static_cast<std::size_t>(cut - order.begin());
    }
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return centres[a][axis] < centres[b][axis] || (centres[a][axis] == centres[b][axis] && a < b);
    });
    return middle;
  }

  void make(std::size_t index, std::size_t begin, std::size_t end, int depth) {
    const std::size_t cut = end - begin <= kLeaf ? end : split(begin, end, depth);
    const std::size_t from[2] = {begin, cut}, to[2] = {cut, end};
    for (int k = 0; k < 2; ++k) {
      const FaceBox box = from[k] < to[k] ? bounds(from[k], to[k]) : FaceBox{Vec3(1e30), Vec3(1e30)};
      for (std::size_t i = 0; i < 3; ++i) {
        nodes[index].lo[k][i] = rounded_down(box.lo[static_cast<int>(i)]);
        nodes[index].hi[k][i] = rounded_up(box.hi[static_cast<int>(i)]);
      }
      if (to[k] - from[k] <= kLeaf) {
        nodes[index].child[k] = ~static_cast<std::int32_t>(from[k]);
        nodes[index].count[static_cast<std::size_t>(k)] = static_cast<std::uint16_t>(to[k] - from[k]);
        continue;
      }
      const std::size_t child = nodes.size();
      nodes.emplace_back();
      nodes[index].child[k] = static_cast<std::int32_t>(child);
      make(child, from[k], to[k], depth + 1);
    }
  }
};

void Bvh::build(const std::vector<FaceBox>& boxes, std::vector<std::uint32_t>& order) {
  CATENA_ASSERT(!boxes.empty() && boxes.size() < (std::size_t{1} << 30));
  order.resize(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  Builder builder{boxes, order, nodes_, {}};
  builder.centres.reserve(boxes.size());
  for (const FaceBox& box : boxes) builder.centres.push_back((box.lo + box.hi) * 0.5);
  nodes_.clear();
  nodes_.reserve(boxes.size() / 2 + 1);
  nodes_.emplace_back();
  builder.make(0, 0, boxes.size(), 0);
}

}  // namespace catena::mesh
