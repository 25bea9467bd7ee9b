// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include <limits>

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {
namespace {

struct BoxShape {
  Vec3 center;
  Vec3 half;
  Mat3 world_from_box;  // orthonormal
  bool catches;         // free side above: the proxy must not tunnel through a thin box
};

/// Face of the box: axis 0..2, sign -1 or +1; sign 0: no face.
struct Face {
  std::int32_t axis, sign;
};

class BoxSurface final : public ContactSurface {
 public:
  using Shape = BoxShape;
  struct Memory {
    Face face;
  };
  BoxSurface(const Shape& shape, Memory& memory, const SideMemory& last) : shape_(shape), memory_(memory), last_(last) {}

  static bool is_sane(const Shape&, const Memory& m) noexcept {
    return m.face.axis >= 0 && m.face.axis <= 2 && m.face.sign >= -1 && m.face.sign <= 1;
  }
  SideValue evaluate_side(const Vec3& at) noexcept override { return {value(to_box(at)), true, false}; }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    const Vec3 y = to_box(probe);
    memory_.face = nearest_face(y);
    return hold(y);
  }
  SurfaceHold slide(const Vec3& probe) noexcept override {
    const Vec3 y = to_box(probe);
    if (last_.initialized && !shape_.catches && value(y) <= 0) {
      const Vec3 before = to_box(last_.probe);
      const Face entry = value(before) > 0 ? entry_face(before, y) : Face{0, 0};
      if (entry.sign != 0) memory_.face = entry;
    }
    return memory_.face.sign == 0 ? project_probe(probe) : hold(y);
  }

  SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept override {
    const Vec3 a = to_box(from), b = to_box(probe);
    const double before = value(a);
    Face face{0, 0};
    if (before > 0 || (before == 0 && shape_.catches)) face = entry_face(a, b);
    if (before <= 0 && face.sign == 0) face = exit_face(a, b);
    if (face.sign == 0) return {};
    memory_.face = face;
    return hold(b);
  }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    return std::fabs(value(to_box(probe))) <= limit ? project_probe(probe) : SurfaceHold{};
  }
  Vec3 normal() const noexcept override { return normal_; }
  bool may_tunnel() const noexcept override { return true; }
  double domain_length() const noexcept override { return std::max(kDefaultDomainLength, 2 * max_abs(shape_.half)); }

  /// Computes the plane of the held face; from outside, the line of the edge or the point of the corner.
  bool primitive(const Vec3& at, Primitive& out) noexcept {
    const Vec3 y = to_box(at);
    const SurfaceHold held = slide(at);
    int beyond = 0, along = 0;
    for (int i = 0; i < 3; ++i) {
      if (std::fabs(y[i]) > shape_.half[i])
        ++beyond;
      else
        along = i;
    }
    if (beyond < 2)
      out = {Primitive::Kind::plane, held.proxy, normal_};
    else if (beyond == 2)
      out = {Primitive::Kind::line, held.proxy, shape_.world_from_box[along]};
    else
      out = {Primitive::Kind::point, held.proxy, Vec3(0.0)};
    return true;
  }

 private:
  Vec3 to_box(const Vec3& at) const {
    const Vec3 w = at - shape_.center;
    return {dot(shape_.world_from_box[0], w), dot(shape_.world_from_box[1], w), dot(shape_.world_from_box[2], w)};
  }
  Vec3 turned(const Vec3& y) const {
    return shape_.world_from_box[0] * y.x + shape_.world_from_box[1] * y.y + shape_.world_from_box[2] * y.z;
  }
  Vec3 beyond(const Vec3& y) const {
    Vec3 out;
    for (int i = 0; i < 3; ++i) out[i] = std::max(std::fabs(y[i]) - shape_.half[i], 0.0);
    return out;
  }
  double value(const Vec3& y) const {
    const Vec3 out = beyond(y);
    if (max_abs(out) > 0) return norm(out);
    return std::max(std::max(std::fabs(y.x) - shape_.half.x, std::fabs(y.y) - shape_.half.y), std::fabs(y.z) - shape_.half.z);
  }
  static int sign_of(double v) { return v < 0 ? -1 : 1; }

  /// Returns the face with the largest |y_i| - h_i: from inside the nearest face, from outside the face whose plane the point is farthest
  /// in front of.
  Face nearest_face(const Vec3& y) const {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::fabs(y[i]) - shape_.half[i] > std::fabs(y[axis]) - shape_.half[axis]) axis = i;
    return {axis, sign_of(y[axis])};
  }

  /// Returns the face through which the segment a-b leaves the box; sign 0 if there is none.
  Face exit_face(const Vec3& a, const Vec3& b) const {
    Face face{0, 0};
    double first = 2;
    for (int i = 0; i < 3; ++i) {
      if (!(std::fabs(b[i]) > shape_.half[i])) continue;
      const double at = (sign_of(b[i]) * shape_.half[i] - a[i]) / (b[i] - a[i]);
      if (at < first) first = at, face = {i, sign_of(b[i])};
    }
    return face;
  }

  /// Returns the face through which a segment from outside, or from the surface, enters the box; sign 0 if there is none.
  Face entry_face(const Vec3& a, const Vec3& b) const {
    Face face{0, 0};
    double in = -1, out = 1;
    for (int i = 0; i < 3; ++i) {
      const int side = sign_of(a[i]);
      const double h = shape_.half[i], way = b[i] - a[i];
      if (std::fabs(a[i]) >= h && side * b[i] < h) {
        const double at = (side * h - a[i]) / way;
        if (at > in) in = at, face = {i, side};
      } else if (std::fabs(a[i]) > h) {
        return {0, 0};
      }
      if (std::fabs(b[i]) > h) out = std::min(out, (sign_of(b[i]) * h - a[i]) / way);
    }
    return in <= out ? face : Face{0, 0};
  }

  /// Returns the closest point that is reachable from the held face; y in the axes of the box.
  SurfaceHold hold(const Vec3& y) noexcept {
    Face& face = memory_.face;
    Vec3 lateral = beyond(y);
    lateral[face.axis] = 0;
    Vec3 q, n(0.0);
    for (int i = 0; i < 3; ++i) q[i] = std::clamp(y[i], -shape_.half[i], shape_.half[i]);
    if (max_abs(lateral) > 0 || (!shape_.catches && value(y) > 0)) {
      if (!(face.sign * y[face.axis] >= shape_.half[face.axis])) face = nearest_face(y);
      n = direction(y - q);
    } else {
      q[face.axis] = face.sign * shape_.half[face.axis];
      n[face.axis] = face.sign;
    }
    normal_ = turned(n);
    const Vec3 proxy = shape_.center + turned(q);
    return {true, proxy, std::fabs(value(to_box(proxy))), LinkStatus::ok};
  }

  const Shape& shape_;
  Memory& memory_;
  const SideMemory& last_;
  Vec3 normal_{0.0};
};

Mat3 orthonormal(const Mat3& m) {
  const Vec3 x = direction(m[0]), z = direction(cross(x, m[1]));
  return Mat3(x, direction(cross(z, x)), z);
}

Result<std::shared_ptr<const Constraint>> build_box(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 center, json::require_vec3(link, "center"));
  CATENA_TRY(const Vec3 size, json::require_vec3(link, "size"));
  if (!(size.x > 0 && size.y > 0 && size.z > 0))
    return json::error_at(*link.find("size"), "\"size\" has an edge that is not > 0; three lengths > 0 were expected");
  Mat3 rotation(1.0);
  if (const json::Node* node = link.find("rotation")) {
    CATENA_TRY(const Mat3 given, json::as_rotation(*node, "rotation"));
    rotation = orthonormal(given);
  }
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return make_closed_form<BoxSurface>({center, size * 0.5, rotation, rules.free == FreeSide::above}, rules);
}

}  // namespace

ConstraintType box_constraint() {
  return {"box",
          "Holds the proxy on the surface of a box, or on one side of it.",
          "section 3",
          {schema::vec3("center", "world", "Centre of the box.").required(),
           schema::vec3("size", "world", "Edge lengths of the box.").positive().with_initial_value("0.2 L").required(),
           schema::rotation("rotation", "Rotation from box axes to world axes, written as `rotation` of `workspace`.").with_default("none"),
           free_key("outside")},
          build_box,
          true};
}

}  // namespace catena::haptics
