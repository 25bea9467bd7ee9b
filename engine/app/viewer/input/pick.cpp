// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/pick.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/input/ray_span.h"
#include "engine/field/grid/grid.h"

namespace catena::app {

namespace {

constexpr int kMaxSteps = 4000;

struct Marched {
  const render::VolumeItem* item;
  RaySpan span;
  field::Cursor cursor{};

  /// Extinction at a point of the ray; zero outside the span, the domain and the mask.
  double sigma(const render::Ray& ray, double t) {
    if (t < span.enter || t > span.exit) return 0;
    const field::ScalarSample s = item->grid->sample(ray.origin + t * ray.direction, cursor);
    if (!s.inside || !std::isfinite(s.value)) return 0;
    const double sigma = extinction_at(item->transfer, s.value);
    if (!(sigma > 0) || item->transfer.gradient_factors.empty()) return sigma;
    return sigma * render::interpolate_piecewise(item->transfer.gradient_factors, norm(s.gradient), 1);
  }
};

bool is_extreme(render::Projection p) { return p == render::Projection::maximum || p == render::Projection::minimum; }

/// Point at which a projection takes its value.
std::optional<PickHit> pick_extreme(const render::VolumeItem& item, const render::Ray& ray, const RaySpan& span, double step) {
  field::Cursor cursor;
  const double sign = item.projection == render::Projection::maximum ? 1 : -1;
  double best = -kInfinity, at = 0;
  for (double t = span.enter; t <= span.exit; t += step) {
    const field::ScalarSample s = item.grid->sample(ray.origin + t * ray.direction, cursor);
    if (!s.inside || !(sign * s.value > best)) continue;
    best = sign * s.value;
    at = t;
  }
  if (!std::isfinite(best)) return std::nullopt;
  const double unit = item.transfer.opacity_length > 0 ? item.transfer.opacity_length : item.grid->mapping().min_voxel_edge();
  const double opacity = 1 - std::exp(-extinction_at(item.transfer, sign * best) * unit);
  if (opacity < kMinPickOpacity) return std::nullopt;
  return PickHit{ray.origin + at * ray.direction, item.id, true, opacity};
}

}  // namespace

double extinction_at(const render::TransferTable& table, double value) {
  return render::interpolate_piecewise(table.extinctions, value, 1);
}

std::optional<PickHit> pick_volume(const render::FramePacket& packet, const render::Ray& ray, double max_depth) {
  std::vector<Marched> marched;
  RaySpan all{kInfinity, -kInfinity};
  double edge = kInfinity;
  for (const render::VolumeItem& item : packet.volumes) {
    RaySpan span = domain_span(*item.grid, ray);
    if (item.is_clipped)
      for (const Plane& plane : packet.clip_planes) clip_to_plane(span, ray, plane);
    span.exit = std::min(span.exit, max_depth);
    if (span.is_empty()) continue;
    marched.push_back({&item, span});
    all = {std::min(all.enter, span.enter), std::max(all.exit, span.exit)};
    edge = std::min(edge, item.grid->mapping().min_voxel_edge());
  }
  if (marched.empty()) return std::nullopt;
  const double step = std::max(0.5 * edge, (all.exit - all.enter) / kMaxSteps);

  // a projection stands for its whole ray: the first one with a visible value is taken
  for (const Marched& m : marched)
    if (is_extreme(m.item->projection))
      if (const auto place = pick_extreme(*m.item, ray, m.span, step)) return place;

  const double target_depth = -std::log(1 - kHalfOpaque);
  double depth = 0, best = 0, best_at = 0;
  std::uint32_t best_id = 0;
  std::vector<double> before(marched.size(), 0);
  for (double t = all.enter; t < all.exit; t += step) {
    const double length = std::min(step, all.exit - t), middle = t + 0.5 * length;
    double sum = 0, max_contribution = 0;
    std::uint32_t id = 0;
    for (Marched& m : marched) {
      if (is_extreme(m.item->projection)) continue;
      const double sigma = m.sigma(ray, middle);
      sum += sigma;
      if (sigma > max_contribution) {
        max_contribution = sigma;
        id = m.item->id;
      }
    }
    if (depth + sum * length >= target_depth)
      return PickHit{ray.origin + (t + (target_depth - depth) / sum) * ray.direction, id, true, kHalfOpaque};
    const double contribution = std::exp(-depth) * (1 - std::exp(-sum * length)) / length;
    if (contribution > best) {
      best = contribution;
      best_at = middle;
      best_id = id;
    }
    depth += sum * length;
  }
  const double opacity = 1 - std::exp(-depth);
  if (opacity < kMinPickOpacity) return std::nullopt;
  return PickHit{ray.origin + best_at * ray.direction, best_id, true, opacity};
}

/// Returns the hit with its position in the world instead of the image's display units.
static std::optional<PickHit> in_world(std::optional<PickHit> hit, const render::FramePacket& packet) {
  if (hit) hit->world /= packet.view.stretch;
  return hit;
}

std::optional<PickHit> pick(const render::FramePacket& packet, double x, double y, double depth, std::uint32_t id) {
  const render::Camera camera = render::make_display_camera(packet.view, packet.width, packet.height, Bounds());
  const render::Ray ray = render::pixel_ray(camera, x, y);
  const bool opaque = std::isfinite(depth);
  const Vec3 behind = opaque ? render::unproject(camera, x, y, depth) : Vec3(0.0);
  const auto place = pick_volume(packet, ray, opaque ? dot(behind - ray.origin, ray.direction) : kInfinity);
  if (!opaque || (place && place->opacity >= kHalfOpaque)) return in_world(place, packet);
  return in_world(PickHit{behind, id, false}, packet);
}

std::optional<PickHit> pick_on_cpu(const render::FramePacket& packet, double x, double y) {
  const render::Camera camera = render::make_display_camera(packet.view, packet.width, packet.height, Bounds());
  const render::Ray ray = render::pixel_ray(camera, x, y);
  const auto solid = pick_solid(packet, ray, kInfinity);
  const auto place = pick_volume(packet, ray, solid ? dot(solid->world - ray.origin, ray.direction) : kInfinity);
  return in_world(solid && !(place && place->opacity >= kHalfOpaque) ? solid : place, packet);
}

std::string object_label(const render::FramePacket& packet, std::uint32_t id) {
  if (id == 0 || id > packet.objects.size()) return {};
  const render::ObjectName& object = packet.objects[id - 1];
  return object.name.empty() ? object.kind : object.kind + " " + object.name;
}

}  // namespace catena::app
