// SPDX-License-Identifier: MIT
/// How often the shadow of a hand that touches an isosurface is in view, and how far from the contact: 200 seeded contacts and cameras.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "render/frame/camera.h"
#include "render/passes/renderer.h"

namespace {

using namespace catena;
using namespace catena::render;

/// A ball with folds, of about 110 voxels radius; the surface is at level 0.
double value_at(const Vec3& voxel) {
  const Vec3 p = (voxel - Vec3(127.5)) / 110.0;
  return 0.9 + 0.06 * (std::sin(14 * p.x) * std::sin(13 * p.y) + std::sin(12 * p.z + 3 * p.x)) - norm(p);
}

std::shared_ptr<const field::ScalarGrid> make_body() {
  constexpr int kEdge = 256;
  std::vector<float> values;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) values.push_back(float(value_at(Vec3(x, y, z))));
  return field::make_scalar_grid("body", {}, {kEdge, kEdge, kEdge}, values, {});
}

}  // namespace

int main() {
  auto renderer = Renderer::create({});
  if (!renderer) return 1;
  const auto body = make_body();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto random_direction = [&] {
    for (;;)
      if (const Vec3 d(uniform(random), uniform(random), uniform(random)); norm(d) > 0.1 && norm(d) < 1) return direction(d);
  };
  int contacts = 0, in_view = 0;
  std::vector<double> distances;
  while (contacts < 200) {
    FramePacket packet;
    packet.width = 1024, packet.height = 768;
    const Vec3 side = random_direction();
    packet.view.position = Vec3(127.5) + 700.0 * side;
    packet.view.target = Vec3(127.5);
    packet.isosurfaces.push_back({body, 0, {0.8f, 0.8f, 0.8f}});
    packet.lights = {{Vec3(1.2, -0.4, 1.2), {0.6f, 0.6f, 0.6f}, false, 8}};
    packet.illumination.shadows = packet.illumination.is_linear = true;
    packet.illumination.sky = packet.illumination.ground = {0.35f, 0.35f, 0.35f};
    packet.illumination.bounds = body->world_bounds();
    // contacts on the half that the camera sees
    const Vec3 outwards = direction(random_direction() + side);
    double r = 150;
    while (value_at(Vec3(127.5) + r * outwards) < 0) r -= 0.01;
    const Vec3 contact = Vec3(127.5) + r * outwards;
    CursorItem cursor;
    cursor.radius = 3.5;
    cursor.probe = contact - 2.0 * outwards;
    cursor.proxies = {contact};
    cursor.link_active = {true};
    cursor.force_n = 2.0 * outwards;
    cursor.id = 7;
    packet.cursors = {cursor};
    if (!(*renderer)->draw(packet, {})) return 1;
    const auto with = (*renderer)->read_back();
    const auto ids = (*renderer)->read_ids();
    packet.cursors[0].radius = 1e-6;
    if (!(*renderer)->draw(packet, {})) return 1;
    const auto without = (*renderer)->read_back();
    if (!with || !ids || !without) return 1;
    const auto at = project(make_camera(packet.view, 1024, 768, body->world_bounds()), contact);
    bool is_seen = false;
    double nearest = 1e9;
    for (std::uint32_t y = 0; y < 768; ++y)
      for (std::uint32_t x = 0; x < 1024; ++x) {
        if (ids->ids[std::size_t(y) * 1024 + x] == 7) {
          is_seen = true;
          continue;
        }
        if (int(without->pixel(x, y)[0]) - int(with->pixel(x, y)[0]) < 8) continue;
        nearest = std::min(nearest, std::hypot(x + 0.5 - at->x, y + 0.5 - at->y));
      }
    if (!is_seen) continue;  // the contact is on the far side
    ++contacts;
    if (nearest < 1e9) {
      ++in_view;
      distances.push_back(nearest);
    }
  }
  std::sort(distances.begin(), distances.end());
  std::printf("contacts,in_view,median_px,p90_px\n%d,%d,%.1f,%.1f\n", contacts, in_view, distances[distances.size() / 2],
              distances[distances.size() * 9 / 10]);
}
