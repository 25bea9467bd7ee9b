// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/vortex_core_criterion.h"

#include <algorithm>

#include "engine/geometry/flow/derivatives.h"

namespace catena::flow {
namespace {

constexpr double kMinSwirl = 0.01;       // minimum imaginary part of the complex pair, relative to |J|
constexpr double kMinVorticity = 1e-4;   // minimum |curl v|, relative to |J|
constexpr double kMinChange = 1e-6;      // minimum of L |J|, relative to |v|
constexpr double kAlongParticle = 1e-4;  // step of the central difference of the acceleration along v for formulas, as a fraction of L

double size_of(const Mat3& m) { return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2])); }

/// Computes the unit eigenvector of the real eigenvalue if the other two form a complex pair, and the pair's imaginary part `swirl`;
/// returns false if all three are real.
bool complex_pair(const Mat3& j, Vec3& axis, double& swirl) {
  const double size = size_of(j), trace = j[0][0] + j[1][1] + j[2][2];
  const double minors =
      j[0][0] * j[1][1] - j[1][0] * j[0][1] + j[0][0] * j[2][2] - j[2][0] * j[0][2] + j[1][1] * j[2][2] - j[2][1] * j[1][2];
  const double det = dot(j[0], cross(j[1], j[2]));
  const auto p = [&](double x) { return ((x - trace) * x + minors) * x - det; };
  // three real roots if the discriminant is not positive: x = trace / 3 + t, t^3 + 3 a t = 2 b
  const double third = trace / 3, a3 = minors / 3 - third * third, b2 = third * third * third - 0.5 * (third * minors - det);
  if (!(a3 * a3 * a3 + b2 * b2 > 0)) return false;
  // Newton's method within a bracket of a real root
  double lo = -2 * size, hi = 2 * size, x = trace / 3;
  for (int i = 0; i < 80; ++i) {
    const double value = p(x);
    if (value == 0) break;
    (value > 0 ? hi : lo) = x;
    double next = x - value / ((3 * x - 2 * trace) * x + minors);
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    const double change = std::fabs(next - x);
    x = next;
    if (change <= 1e-15 * size) break;
  }
  const double half = 0.5 * (x - trace), pair_product = minors + x * (x - trace), swirl2 = pair_product - half * half;
  if (!(swirl2 > kMinSwirl * kMinSwirl * size * size)) return false;
  swirl = std::sqrt(swirl2);
  // null space of J - x: the longest cross product of two rows
  const Vec3 a(j[0][0] - x, j[1][0], j[2][0]), b(j[0][1], j[1][1] - x, j[2][1]), c(j[0][2], j[1][2], j[2][2] - x);
  for (const Vec3& n : {cross(a, b), cross(b, c), cross(c, a)})
    if (dot(n, n) > dot(axis, axis)) axis = n;
  axis = direction(axis);
  return max_abs(axis) > 0;
}

}  // namespace

void perpendicular_basis(const Vec3& axis, Vec3& a, Vec3& b) {
  a = direction(cross(axis, std::fabs(axis.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
  b = cross(axis, a);
}

void NodeBlock::read(const field::VectorGrid& grid, const field::Index3& origin, int nodes) {
  n_ = nodes;
  const auto n = static_cast<std::size_t>(nodes), m = n - 1;
  cells_.resize(m * m * m);
  field::Cursor cursor;
  for (int k = 0; k + 1 < n_; ++k)
    for (int j = 0; j + 1 < n_; ++j)
      for (int i = 0; i + 1 < n_; ++i) {
        const Vec3 base(origin.x + i, origin.y + j, origin.z + k);
        bool valid = grid.index_box().contains(base) && grid.index_box().contains(base + 1.0);
        if (valid && grid.has_mask()) valid = grid.cell({origin.x + i, origin.y + j, origin.z + k}, cursor).valid;
        cells_[cell(i, j, k)] = valid;
      }
  valid_nodes_.assign(n * n * n, 0);
  xyz_.resize(3 * n * n * n);
  empty_ = std::ranges::none_of(cells_, [](std::uint8_t valid) { return valid != 0; });
  if (empty_) return;
  grid.read_block(origin, {nodes, nodes, nodes}, xyz_);
  for (int k = 0; k + 1 < n_; ++k)
    for (int j = 0; j + 1 < n_; ++j)
      for (int i = 0; i + 1 < n_; ++i)
        if (has_cell(i, j, k))
          for (int c = 0; c < 8; ++c) valid_nodes_[at(i + c % 2, j + c / 2 % 2, k + c / 4)] = 1;
  empty_ = std::equal(xyz_.begin() + 3, xyz_.end(), xyz_.begin());
}

bool NodeBlock::gradient(int i, int j, int k, Mat3& by_index) const {
  const int node[3] = {i, j, k};
  bool all = true;
  for (int c = 0; c < 27; ++c) all = all && valid_nodes_[at(i + c % 3 - 1, j + c / 3 % 3 - 1, k + c / 9 - 1)] != 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (all) {
      Vec3 sum(0.0);
      for (int c = 0; c < 9; ++c) {
        int up[3] = {i, j, k};
        up[(axis + 1) % 3] += c % 3 - 1;
        up[(axis + 2) % 3] += c / 3 - 1;
        int down[3] = {up[0], up[1], up[2]};
        ++up[axis];
        --down[axis];
        const double weight = (c % 3 == 1 ? 2 : 1) * (c / 3 == 1 ? 2 : 1);
        sum += (value(up[0], up[1], up[2]) - value(down[0], down[1], down[2])) * weight;
      }
      by_index[axis] = sum * (1.0 / 32);
      continue;
    }
    int up[3] = {i, j, k}, down[3] = {i, j, k};
    if (valid_nodes_[at(i + (axis == 0), j + (axis == 1), k + (axis == 2))] != 0) ++up[axis];
    if (valid_nodes_[at(i - (axis == 0), j - (axis == 1), k - (axis == 2))] != 0) --down[axis];
    const int distance = up[axis] - down[axis];
    if (distance == 0 || valid_nodes_[at(node[0], node[1], node[2])] == 0) return false;
    by_index[axis] = (value(up[0], up[1], up[2]) - value(down[0], down[1], down[2])) * (1.0 / distance);
  }
  return true;
}

CoreSample evaluate_criterion(CoreCriterion criterion, const CoreFlow& flow, const Vec3& second, double length) {
  CoreSample out;
  out.is_inside = true;
  const Mat3& j = flow.gradient;
  const double size = size_of(j), speed = norm(flow.v);
  if (!(size * length > kMinChange * speed) || !std::isfinite(size)) return out;
  if (criterion == CoreCriterion::vorticity) {
    const Vec3 w = curl(j);
    if (!(norm(w) > kMinVorticity * size)) return out;
    out.axis = direction(w);
  } else if (!complex_pair(j, out.axis, out.swirl)) {
    return out;
  }
  Vec3 a, b;
  perpendicular_basis(out.axis, a, b);
  const Vec3 ja = j * a, jb = j * b;
  const double aa = dot(a, ja), ab = dot(a, jb), ba = dot(b, ja), bb = dot(b, jb), det = aa * bb - ab * ba;
  const double discriminant = 4 * det - (aa + bb) * (aa + bb);
  if (!(discriminant > 4 * kMinSwirl * kMinSwirl * (aa * aa + ab * ab + ba * ba + bb * bb))) return out;
  if (criterion == CoreCriterion::vorticity) out.swirl = 0.5 * std::sqrt(discriminant);
  if (criterion == CoreCriterion::parallel_vectors) {
    // near a core line D^2 v / Dt^2 is -swirl^2 times the velocity orthogonal to it
    const Vec3 along = direction(flow.v);
    out.residual = (second - along * dot(second, along)) * (-1 / (out.swirl * out.swirl));
  } else {
    out.residual = flow.v - out.axis * dot(flow.v, out.axis);
  }
  const double fa = dot(a, out.residual), fb = dot(b, out.residual);
  out.step = a * ((ab * fb - bb * fa) / det) + b * ((ba * fa - aa * fb) / det);
  out.is_vortex = is_finite(out.step);
  return out;
}

CoreField::CoreField(const field::VectorField& field, CoreCriterion criterion, double scale)
    : field_(field),
      criterion_(criterion),
      scale_(scale),
      difference_step_(field.is_grid() ? field.max_voxel_edge() : kAlongParticle * field.domain_length()) {}

bool CoreField::sample_flow(const Vec3& world, CoreFlow& out) {
  if (!field_.is_grid()) {
    if (!field_.index_box().contains(field_.mapping().index_from_world(world))) return false;
    int evaluations = 0;
    const VelocityGradient found = compute_velocity_gradient(field_, world, cursor_, evaluations);
    const double ratio = found.scale / scale_;
    out = {found.v * ratio, found.gradient * ratio};
    return found.is_valid;
  }
  const field::VectorGrid& grid = *field_.grid();
  const field::VectorSample sample = grid.sample(world, cursor_);
  if (!sample.inside || !is_finite(sample.value)) return false;
  const Vec3 index = grid.mapping().index_from_world(world);
  const field::Index3 base = grid.cell_base(index);
  const Corners& corners = load_corners(base);
  if (!corners.usable) return false;
  const Vec3 f = index - Vec3(base.x, base.y, base.z);
  Mat3 sum(0.0);
  for (int c = 0; c < 8; ++c)
    sum +=
        corners.gradients[static_cast<std::size_t>(c)] * ((c % 2 ? f.x : 1 - f.x) * (c / 2 % 2 ? f.y : 1 - f.y) * (c / 4 ? f.z : 1 - f.z));
  out = {sample.value * (1 / scale_), sum * grid.mapping().index_from_world_linear * (1 / scale_)};
  return true;
}

const CoreField::Corners& CoreField::load_corners(const field::Index3& base) {
  constexpr std::size_t kKept = 1024;
  if (cached_corners_.empty()) cached_corners_.resize(kKept);
  const auto number = [](int i) { return static_cast<std::size_t>(i); };
  Corners& corners = cached_corners_[(number(base.x) + 11 * number(base.y) + 117 * number(base.z)) % kKept];
  if (corners.loaded && corners.base == base) return corners;
  block_.read(*field_.grid(), {base.x - 1, base.y - 1, base.z - 1}, 4);
  corners.base = base;
  corners.loaded = true;
  corners.usable = !block_.is_empty();
  for (int c = 0; c < 8 && corners.usable; ++c)
    corners.usable = block_.gradient(1 + c % 2, 1 + c / 2 % 2, 1 + c / 4, corners.gradients[static_cast<std::size_t>(c)]);
  return corners;
}

bool CoreField::acceleration(const Vec3& world, Vec3& out) {
  CoreFlow flow;
  if (!sample_flow(world, flow)) return false;
  out = flow.gradient * flow.v;
  return true;
}

CoreSample CoreField::evaluate(const Vec3& world, const CoreFlow& flow) {
  Vec3 second(0.0);
  if (criterion_ == CoreCriterion::parallel_vectors) {
    const double speed = norm(flow.v);
    if (speed > 0) {
      // difference along the particle's path, over a voxel to both sides, or one-sided at the boundary
      const Vec3 offset = direction(flow.v) * difference_step_, at_center = flow.gradient * flow.v;
      Vec3 ahead = at_center, behind = at_center;
      const bool is_ahead = acceleration(world + offset, ahead), is_behind = acceleration(world - offset, behind);
      const int distance = static_cast<int>(is_ahead) + static_cast<int>(is_behind);
      if (distance == 0) return {};
      second = (ahead - behind) * (speed / (distance * difference_step_));
    }
  }
  return evaluate_criterion(criterion_, flow, second, field_.domain_length());
}

CoreSample CoreField::sample_at(const Vec3& world) {
  CoreFlow flow;
  return sample_flow(world, flow) ? evaluate(world, flow) : CoreSample{};
}

}  // namespace catena::flow
