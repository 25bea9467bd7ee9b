// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/flow_source.h"

namespace catena::flow {

namespace {

constexpr double kSlack = 1e-12;     ///< voxels: an excursion outside a face by less is rounding
constexpr double kSeedSlack = 1e-9;  ///< voxels: a seed this close to a face of the domain counts as inside

/// Returns the first theta in [0, 1] at which a coordinate (cubic polynomial c0 .. c3) of the piece passes `face` upward (`side` 1) or
/// downward (-1); 2 if there is none.
double first_passage(double c0, double c1, double c2, double c3, double face, double side) {
  const auto excess = [&](double theta) { return side * (c0 + theta * (c1 + theta * (c2 + theta * c3)) - face); };
  // monotonic intervals between the extrema
  double limits[4] = {0, 1, 1, 1};
  int count = 1;
  const double a = 3 * c3, b = c2, discriminant = b * b - a * c1;
  if (discriminant > 0) {
    const double root = std::sqrt(discriminant), stable_root = -(b + (b < 0 ? -root : root));
    double first = a != 0 ? stable_root / a : 2, second = stable_root != 0 ? c1 / stable_root : 2;
    if (first > second) std::swap(first, second);
    if (first > 0 && first < 1) limits[count++] = first;
    if (second > 0 && second < 1) limits[count++] = second;
  }
  limits[count++] = 1;
  double from = 0, value = excess(0);
  for (int i = 1; i < count; ++i) {
    const double next = excess(limits[i]);
    if (next > kSlack) return value >= 0 ? from : illinois_root(from, value, limits[i], next, excess);
    from = limits[i];
    value = next;
  }
  return 2;
}

}  // namespace

bool find_exit_of_box(const Hermite& piece, const Vec3& lower, const Vec3& upper, CellExit& exit) {
  exit.theta = 2;
  // the piece is within the hull of its Bezier points
  const Vec3 b1 = piece.c0 + piece.c1 / 3.0, b2 = b1 + (piece.c1 + piece.c2) / 3.0, b3 = piece.c0 + piece.c1 + piece.c2 + piece.c3;
  const Vec3 lo = glm::min(glm::min(piece.c0, b1), glm::min(b2, b3)), hi = glm::max(glm::max(piece.c0, b1), glm::max(b2, b3));
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side <= 1; side += 2) {
      const double face = side < 0 ? lower[axis] : upper[axis];
      if (side < 0 ? lo[axis] >= face : hi[axis] <= face) continue;
      const double theta = first_passage(piece.c0[axis], piece.c1[axis], piece.c2[axis], piece.c3[axis], face, side);
      if (theta < exit.theta) exit = {theta, axis, face, side};
    }
  return exit.theta <= 1;
}

CellFlowSource::CellFlowSource(const Flow& flow, field::Cursor* cursor)
    : flow_(flow),
      grid_(flow.field->grid()),
      mapping_(grid_->mapping()),
      box_(grid_->index_box()),
      shared_cursor_(cursor),
      cubic_(!flow.is_line_field && grid_->interpolation() == field::Interpolation::cubic) {
  constexpr double kFarIndex = 1 << 16;
  if (const Vec3 lo = box_.lo; max_abs(lo) > kFarIndex) {
    first_ = {static_cast<std::int32_t>(lo.x), static_cast<std::int32_t>(lo.y), static_cast<std::int32_t>(lo.z)};
    mapping_.origin = mapping_.world_from_index(lo);
    box_ = {box_.lo - lo, box_.hi - lo};
  }
  max_step_ = 2 * norm(world_difference(Vec3(1.0)));
  for (int axis = 0; axis < 3; ++axis) max_step_ = std::max(max_step_, 2 * norm(mapping_.world_from_index_linear[axis]));
}

glm::vec3 CellFlowSource::rounding_error(const Vec3& q) const {
  constexpr double kFar = 500;  // times L
  const Vec3 position = world(q);
  if (max_abs(position) <= kFar * grid_->domain_length()) return glm::vec3(0.0f);
  // exact rounding error of the sum (Knuth's TwoSum)
  const Vec3 within = world_difference(q), &origin = mapping_.origin, remainder = position - within;
  return glm::vec3((within - (position - remainder)) + (origin - remainder));
}

field::VectorCell CellFlowSource::load_cell(const field::Index3& base) {
  field::VectorCell cell = grid_->cell({base.x + first_.x, base.y + first_.y, base.z + first_.z}, cursor());
  cell.base = {cell.base.x - first_.x, cell.base.y - first_.y, cell.base.z - first_.z};
  return cell;
}

bool CellFlowSource::enter_cell(const field::Index3& base) {
  const field::VectorCell cell = this->load_cell(base);
  outside_status_ = !(cell.base == base) ? SampleStatus::outside_box : cell.valid ? SampleStatus::ok : SampleStatus::masked;
  for (const Vec3& v : cell.corner)
    if (!is_finite(v) && outside_status_ != SampleStatus::outside_box) outside_status_ = SampleStatus::not_finite;
  if (outside_status_ != SampleStatus::ok) return false;
  base_ = base;
  lo_ = Vec3(base.x, base.y, base.z);
  for (int axis = 0; axis < 3; ++axis) hi_[axis] = std::min(lo_[axis] + 1, box_.hi[axis]);
  if (flow_.is_line_field) {
    dyads_ = field::DyadCell(cell.corner);
    return true;
  }
  if (cubic_) {
    samples_ = *grid_->cubic_samples({base.x + first_.x, base.y + first_.y, base.z + first_.z}, cursor());
    return true;
  }
  const auto& c = cell.corner;
  const Vec3 x00 = c[1] - c[0], x10 = c[3] - c[2], x01 = c[5] - c[4], x11 = c[7] - c[6];
  const Vec3 y0 = c[2] - c[0], y1 = c[6] - c[4];
  polynomial_ = {c[0], x00, y0, x10 - x00, c[4] - c[0], x01 - x00, y1 - y0, (x11 - x01) - (x10 - x00)};
  for (Vec3& v : polynomial_) v *= sign_;
  return true;
}

bool CellFlowSource::start(const Vec3& seed, const Vec3& u, double sign, Vec3& q) {
  q = mapping_.index_from_world(seed);
  const field::Box& box = box_;
  outside_status_ = is_finite(q) ? SampleStatus::outside_box : SampleStatus::not_finite;
  if (!is_finite(q) || !box.contains(q, kSeedSlack)) return false;
  for (int axis = 0; axis < 3; ++axis) q[axis] = std::clamp(q[axis], box.lo[axis], box.hi[axis]);
  reference_ = sign * u;
  sign_ = flow_.is_line_field ? 1 : sign;
  // tries the cell of the seed, then the cells that share the face, edge or corner on which it lies (within kSeedSlack)
  const field::Index3 found = grid_->cell_base(q + Vec3(first_.x, first_.y, first_.z));
  const field::Index3 base{found.x - first_.x, found.y - first_.y, found.z - first_.z};
  const std::int32_t bases[3] = {base.x, base.y, base.z};
  int neighbor_step[3];
  for (int axis = 0; axis < 3; ++axis)
    neighbor_step[axis] = q[axis] - bases[axis] <= kSeedSlack ? -1 : bases[axis] + 1 - q[axis] <= kSeedSlack ? 1 : 0;
  for (int c = 0; c < 8; ++c) {
    if (((c & 1) && neighbor_step[0] == 0) || ((c & 2) && neighbor_step[1] == 0) || ((c & 4) && neighbor_step[2] == 0)) continue;
    if (!enter_cell(
            {base.x + (c & 1 ? neighbor_step[0] : 0), base.y + (c & 2 ? neighbor_step[1] : 0), base.z + (c & 4 ? neighbor_step[2] : 0)}))
      continue;
    if (c != 0)
      for (int axis = 0; axis < 3; ++axis) q[axis] = std::clamp(q[axis], lo_[axis], hi_[axis]);
    return true;
  }
  return false;
}

StopReason CellFlowSource::seed_tangent_at(const Vec3& position, Vec3& u) {
  Vec3 q, w;
  if (!start(position, Vec3(0.0), 1, q)) return StopReason::outside;
  // for a line field the reference side is that of the nearest voxel
  if (flow_.is_line_field) reference_ = field::line_axis(load_cell(base_).corner, q - lo_).axis;
  return rate(q, w, u);
}

// inlines all calls, as direction_at() (flow.cpp) does
[[gnu::flatten]] StopReason CellFlowSource::rate(const Vec3& q, Vec3& w, Vec3& u) const {
  const Vec3 f = q - lo_;
  if (flow_.is_line_field) {
    const StopReason stop = axis_direction(dyads_.at(f), flow_.min_speed, reference_, u);
    w = mapping_.index_from_world_linear * u;
    return stop;
  }
  const StopReason stop = unit_direction(velocity(q), flow_.min_speed, u);
  w = mapping_.index_from_world_linear * u;
  return stop;
}

CellAdvance CellFlowSource::advance_cell(Vec3& q, const Vec3& w) {
  return advance_through_faces(q, w, lo_, hi_, [&](const CellExit& exit) { return cross_face(exit); });
}

bool CellFlowSource::cross_face(const CellExit& exit) {
  field::Index3 next = base_;
  (exit.axis == 0 ? next.x : exit.axis == 1 ? next.y : next.z) += exit.side;
  return enter_cell(next);
}

}  // namespace catena::flow
