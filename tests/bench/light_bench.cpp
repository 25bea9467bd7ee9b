// SPDX-License-Identifier: MIT
/// Cost of light on a grid of 256^3 voxels: filling the cells, one light, the environment; and images of 1024 x 768 by the fast raycast,
/// under the headlight and lit; a moving hand with and without its shadow. Compare with --benchmark_enable_random_interleaving
/// --benchmark_repetitions=9.
#include <benchmark/benchmark.h>

#include <cmath>

#include "render/light/light_sweep.h"
#include "render/passes/renderer.h"

namespace {

using namespace catena;
using namespace catena::render;

std::shared_ptr<const field::ScalarGrid> body() {
  static const auto grid = [] {
    constexpr int kEdge = 256;
    std::vector<float> values;
    values.reserve(std::size_t{kEdge} * kEdge * kEdge);
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
          const Vec3 p = (Vec3(x, y, z) - Vec3(127.5)) / 110.0;
          const double folds = std::sin(14 * p.x) * std::sin(13 * p.y) + std::sin(12 * p.z + 3 * p.x);
          values.push_back(float(1 / (1 + std::exp(20 * (norm(p) - 0.9 - 0.06 * folds))) + 0.1 * folds));
        }
    return field::make_scalar_grid("body", {}, {kEdge, kEdge, kEdge}, values, {});
  }();
  return grid;
}

FramePacket packet_of(bool is_shaded, bool is_lit) {
  FramePacket packet;
  packet.width = 1024, packet.height = 768;
  packet.view.position = {600, -500, 350};
  packet.view.target = Vec3(127.5);
  VolumeItem item;
  item.grid = body();
  item.transfer.colors = {{0, 0.4, 0.2, 0.2}, {1, 1, 0.9, 0.8}};
  item.transfer.extinctions = {{0.3, 0}, {1, 0.2}};
  item.is_shaded = is_shaded;
  packet.volumes = {item};
  packet.illumination.bounds = body()->world_bounds();
  if (!is_lit) return packet;
  packet.lights = {{{1, -0.6, 1}, {1, 1, 1}, false}};
  packet.illumination.shadows = true;
  packet.illumination.occlusion_reach = 25;
  return packet;
}

void cells(benchmark::State& state) {
  const FramePacket packet = packet_of(true, true);
  for (auto _ : state) benchmark::DoNotOptimize(make_light_cells(packet).extinction.data());
}

void shadow(benchmark::State& state) {
  const LightCells cells = make_light_cells(packet_of(true, true));
  for (auto _ : state) benchmark::DoNotOptimize(sweep_light(cells, direction(Vec3(1, -0.6, 1)), double(state.range(0))).data());
}

void environment(benchmark::State& state) {
  const LightCells cells = make_light_cells(packet_of(true, true));
  for (auto _ : state) benchmark::DoNotOptimize(sweep_environment(cells, 25)[0].data());
}

void image(benchmark::State& state, bool is_shaded, bool is_lit) {
  auto renderer = Renderer::create({});
  if (!renderer) return state.SkipWithError("no device");
  FramePacket packet = packet_of(is_shaded, is_lit);
  RenderSettings settings;
  settings.fast.emplace();
  settings.fast->smooth_gradients = is_shaded;
  double angle = 0;
  for (auto _ : state) {
    angle += 0.1;
    packet.view.position = Vec3(127.5) + Vec3(650 * std::cos(angle), 650 * std::sin(angle), 220);
    if (const auto drawn = (*renderer)->draw(packet, settings); !drawn) return state.SkipWithError(drawn.error().message.c_str());
  }
}

/// A moving hand over a volume or an isosurface that are lit and otherwise unchanged.
void hand(benchmark::State& state, bool is_volume, bool casts) {
  auto renderer = Renderer::create({});
  if (!renderer) return state.SkipWithError("no device");
  FramePacket packet = packet_of(true, true);
  packet.illumination.shadows = casts;
  packet.lights[0].angular_size_deg = 5;
  if (!is_volume) {
    packet.volumes.clear();
    packet.isosurfaces.push_back({body(), 0.5, {0.8f, 0.8f, 0.8f}});
  }
  CursorItem cursor;
  cursor.radius = 3.5;
  cursor.proxies.resize(3);
  cursor.link_active.assign(3, true);
  cursor.force_n = {1, -1, 1};
  packet.cursors.push_back(cursor);
  RenderSettings settings;
  settings.fast.emplace();
  settings.reuse_rays = true;
  for (int k = 0; k < 2; ++k)
    if (const auto drawn = (*renderer)->draw(packet, settings); !drawn) return state.SkipWithError(drawn.error().message.c_str());
  double angle = 0;
  for (auto _ : state) {
    angle += 0.02;
    CursorItem& moved = packet.cursors[0];
    moved.probe = Vec3(127.5) + 115.0 * direction(Vec3(1, 0.8 * std::sin(angle) - 0.6, 0.8 * std::cos(angle)));
    for (std::size_t k = 0; k < 3; ++k) moved.proxies[k] = moved.probe - Vec3(0, 0, 4.0 * double(k + 1));
    if (const auto drawn = (*renderer)->draw(packet, settings); !drawn) return state.SkipWithError(drawn.error().message.c_str());
  }
}

BENCHMARK(cells)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(shadow)->Arg(0)->Arg(5)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(environment)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(image, plain_headlight, false, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(image, plain_lit, false, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(image, shaded_headlight, true, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(image, shaded_lit, true, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(hand, volume, true, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(hand, volume_shadow, true, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(hand, surface, false, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(hand, surface_shadow, false, true)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
