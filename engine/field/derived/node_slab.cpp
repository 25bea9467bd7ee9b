// SPDX-License-Identifier: MIT
#include "engine/field/derived/node_slab.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/threads.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

constexpr double kNoDifference = std::numeric_limits<double>::quiet_NaN();

constexpr Stencil kCentral{2, {-1, 1}, {-0.5, 0.5}};
constexpr Stencil kCentral4{4, {-2, -1, 1, 2}, {1 / 12.0, -8 / 12.0, 8 / 12.0, -1 / 12.0}};
constexpr Stencil kForward{3, {0, 1, 2}, {-1.5, 2, -0.5}};
constexpr Stencil kToNext{2, {0, 1}, {-1, 1}};
constexpr Stencil kSecond{3, {-1, 0, 1}, {1, -2, 1}};
constexpr Stencil kSecond4{5, {-2, -1, 0, 1, 2}, {-1 / 12.0, 16 / 12.0, -30 / 12.0, 16 / 12.0, -1 / 12.0}};
constexpr Stencil kSecondForward{4, {0, 1, 2, 3}, {2, -5, 4, -1}};
constexpr Stencil kSecondNext{3, {0, 1, 2}, {1, -2, 1}};
constexpr Stencil kZero{1, {0}, {0}};

/// Returns the stencil mirrored; `sign`: -1 for first derivatives.
Stencil mirrored(Stencil stencil, double sign) {
  for (int i = 0; i < stencil.count; ++i) {
    stencil.offset[std::size_t(i)] *= -1;
    stencil.weight[std::size_t(i)] *= sign;
  }
  return stencil;
}

Index3 size_of(const Box& box) {
  const Vec3 extent = box.hi - box.lo;
  return {int(extent.x) + 1, int(extent.y) + 1, int(extent.z) + 1};
}

}  // namespace

template <class Grid>
NodeSlab<Grid>::NodeSlab(const Grid& grid, int derivatives, int order)
    : grid_(grid),
      order_(order),
      halo_((derivatives > 0 ? derivatives + 1 : 0) + (grid.has_mask() ? 1 : 0)),  // reach of one-sided derivatives; cells beside
      origin_{int(grid.index_box().lo.x), int(grid.index_box().lo.y), int(grid.index_box().lo.z)},
      size_(size_of(grid.index_box())) {
  stride_ = {1, size_.x, std::ptrdiff_t(size_.x) * size_.y};
}

template <class Grid>
void NodeSlab<Grid>::read(int z, int layers) {
  first_ = std::max(0, z - halo_);
  layers_ = std::min(size_.z, z + layers + halo_) - first_;
  const std::size_t plane = std::size_t(stride_[2]), count = plane * std::size_t(layers_);
  for (auto& component : values_) component.resize(count);
  read_.resize(C == 1 ? 0 : C * count);
  parallel_for(std::size_t(layers_), 1, [&](std::size_t begin, std::size_t end) {
    const Index3 from{origin_.x, origin_.y, origin_.z + first_ + int(begin)}, size{size_.x, size_.y, int(end - begin)};
    const std::size_t first = begin * plane, n = (end - begin) * plane;
    if constexpr (C == 1) {
      grid_.read_block(from, size, std::span(values_[0]).subspan(first, n));
    } else {
      grid_.read_block(from, size, std::span(read_).subspan(C * first, C * n));
      const float* interleaved = read_.data() + C * first;
      for (std::size_t c = 0; c < C; ++c) {
        float* out = values_[c].data() + first;
        for (std::size_t i = 0; i < n; ++i) out[i] = interleaved[C * i + c];
      }
    }
  });
  valid_.clear();
  if (grid_.has_mask()) mark_valid();
}

/// Marks the corners of valid cells.
template <class Grid>
void NodeSlab<Grid>::mark_valid() {
  valid_.assign(values_[0].size(), 0);
  const auto finite = [&](std::size_t i) {
    for (const auto& component : values_)
      if (!std::isfinite(component[i])) return false;
    return true;
  };
  const Index3 cells{std::max(1, size_.x - 1), std::max(1, size_.y - 1), layers_ - (size_.z > 1 ? 1 : 0)};
  const int dx = size_.x > 1 ? 1 : 0, dy = size_.y > 1 ? 1 : 0, dz = size_.z > 1 ? 1 : 0;
  for (int z = first_; z < first_ + std::max(1, cells.z); ++z)
    for (int y = 0; y < cells.y; ++y)
      for (int x = 0; x < cells.x; ++x) {
        bool counts = may_be_cell(x, y, z);
        std::array<std::size_t, 8> corners{};
        for (int i = 0; i < 8; ++i) {
          corners[std::size_t(i)] = at(x + (i & 1) * dx, y + (i >> 1 & 1) * dy, z + (i >> 2) * dz);
          counts = counts && finite(corners[std::size_t(i)]);
        }
        if (counts)
          for (const std::size_t corner : corners) valid_[corner] = 1;
      }
}

template <class Grid>
bool NodeSlab<Grid>::may_be_cell(int x, int y, int z) const {
  const auto& storage = grid_.storage();
  const Index3 base{origin_.x + x, origin_.y + y, origin_.z + z};
  return !storage.valid_cells || !storage.is_legal_base(base) || storage.valid_cells->tree().getValue(to_nano_coord(base));
}

template <class Grid>
bool NodeSlab<Grid>::has(int axis, const Index3& node, int offset) const {
  Index3 other = node;
  (axis == 0 ? other.x : axis == 1 ? other.y : other.z) += offset;
  const bool in_box =
      other.x >= 0 && other.y >= 0 && other.z >= first_ && other.x < size_.x && other.y < size_.y && other.z < first_ + layers_;
  return in_box && is_valid(other.x, other.y, other.z);
}

template <class Grid>
Stencil NodeSlab<Grid>::first_stencil(int axis, const Index3& node) const {
  if ((axis == 0 ? size_.x : axis == 1 ? size_.y : size_.z) == 1) return kZero;
  const auto is_there = [&](int offset) { return has(axis, node, offset); };
  if (is_there(-1) && is_there(1)) return order_ == 4 && is_there(-2) && is_there(2) ? kCentral4 : kCentral;
  for (const int side : {1, -1})
    if (is_there(side)) {
      const Stencil& one_sided = is_there(2 * side) ? kForward : kToNext;
      return side == 1 ? one_sided : mirrored(one_sided, -1);
    }
  return {};
}

template <class Grid>
Stencil NodeSlab<Grid>::second_stencil(int axis, const Index3& node) const {
  if ((axis == 0 ? size_.x : axis == 1 ? size_.y : size_.z) == 1) return kZero;
  const auto is_there = [&](int offset) { return has(axis, node, offset); };
  if (is_there(-1) && is_there(1)) return order_ == 4 && is_there(-2) && is_there(2) ? kSecond4 : kSecond;
  for (const int side : {1, -1})
    if (is_there(side) && is_there(2 * side)) {
      const Stencil& one_sided = is_there(3 * side) ? kSecondForward : kSecondNext;
      return side == 1 ? one_sided : mirrored(one_sided, 1);
    }
  return {};
}

template <class Grid>
double NodeSlab<Grid>::apply(const Stencil& stencil, int c, int axis, const Index3& node) const {
  if (stencil.count == 0) return kNoDifference;
  const float* values = values_[std::size_t(c)].data() + at(node.x, node.y, node.z);
  double sum = 0;
  for (int i = 0; i < stencil.count; ++i)
    sum += stencil.weight[std::size_t(i)] * double(values[stencil.offset[std::size_t(i)] * stride_[std::size_t(axis)]]);
  return sum;
}

template <class Grid>
Vec3 NodeSlab<Grid>::first(int c, int x, int y, int z) const {
  Vec3 by_index;
  for (int a = 0; a < 3; ++a) by_index[a] = apply(first_stencil(a, {x, y, z}), c, a, {x, y, z});
  return by_index;
}

/// Product of the first derivatives along two axes; at masks, where nodes of it are missing, the difference of a quadrant's four nodes.
template <class Grid>
double NodeSlab<Grid>::mixed(int c, int a, int b, const Index3& node) const {
  const Stencil along_a = first_stencil(a, node), along_b = first_stencil(b, node);
  if (along_a.count == 0 || along_b.count == 0) return kNoDifference;
  const auto moved = [](Index3 n, int axis, int offset) {
    (axis == 0 ? n.x : axis == 1 ? n.y : n.z) += offset;
    return n;
  };
  const auto sum_of = [&](const Stencil& s, const Stencil& t) {
    double sum = 0;
    for (int i = 0; i < s.count; ++i) {
      const Index3 line = moved(node, a, s.offset[std::size_t(i)]);
      for (int j = 0; j < t.count; ++j) {
        const Index3 other = moved(line, b, t.offset[std::size_t(j)]);
        if (has_mask() && !is_valid(other.x, other.y, other.z)) return kNoDifference;
        sum += s.weight[std::size_t(i)] * t.weight[std::size_t(j)] * value(c, other.x, other.y, other.z);
      }
    }
    return sum;
  };
  const double all = sum_of(along_a, along_b);
  if (!has_mask() || !std::isnan(all)) return all;
  for (const int side_a : {1, -1})
    for (const int side_b : {1, -1}) {
      if (!has(a, node, side_a) || !has(b, node, side_b)) continue;
      const double quadrant = sum_of(side_a == 1 ? kToNext : mirrored(kToNext, -1), side_b == 1 ? kToNext : mirrored(kToNext, -1));
      if (!std::isnan(quadrant)) return quadrant;
    }
  return kNoDifference;
}

template <class Grid>
Mat3 NodeSlab<Grid>::second(int c, int x, int y, int z) const {
  const Index3 node{x, y, z};
  Mat3 by_index;
  for (int a = 0; a < 3; ++a) {
    by_index[a][a] = apply(second_stencil(a, node), c, a, node);
    for (int b = 0; b < a; ++b) by_index[a][b] = by_index[b][a] = mixed(c, a, b, node);
  }
  return by_index;
}

template <class Grid>
void NodeSlab<Grid>::first_of_row(int c, int axis, int y, int z, double* out) const {
  const int reach = order_ == 4 ? 2 : 1;
  const int begin = axis == 0 ? std::min(reach, size_.x) : 0, end = axis == 0 ? std::max(begin, size_.x - reach) : size_.x;
  const float* row = values_[std::size_t(c)].data() + at(0, y, z);
  const Stencil inner = first_stencil(axis, {begin < size_.x ? begin : 0, y, z});
  const std::ptrdiff_t stride = stride_[std::size_t(axis)];
  if (begin < end && inner.count == 2) {
    const float *low = row + inner.offset[0] * stride, *high = row + inner.offset[1] * stride;
    const double weight = inner.weight[1];
    for (int x = begin; x < end; ++x) out[x] = weight * (double(high[x]) - double(low[x]));
  } else {
    for (int x = begin; x < end; ++x) {
      double sum = 0;
      for (int i = 0; i < inner.count; ++i) sum += inner.weight[std::size_t(i)] * double(row[x + inner.offset[std::size_t(i)] * stride]);
      out[x] = sum;
    }
  }
  for (int x = 0; x < begin; ++x) out[x] = apply(first_stencil(axis, {x, y, z}), c, axis, {x, y, z});
  for (int x = end; x < size_.x; ++x) out[x] = apply(first_stencil(axis, {x, y, z}), c, axis, {x, y, z});
}

template class NodeSlab<ScalarGrid>;
template class NodeSlab<VectorGrid>;

}  // namespace catena::field
