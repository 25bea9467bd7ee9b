// SPDX-License-Identifier: MIT
/// Times and depths of one opaque isosurface, with the fields and the camera of the comparison with VTK (raw float32 volumes, 1024 x 768).
///   isosurface_table RAW N LEVEL [VIEWS [DEPTH_FILE [MODE]]]      MODE: exact (default) | r16f | draft      see isosurface_vs_vtk.py
/// One JSON line: medians over an orbit of VIEWS images, wall and process CPU milliseconds (two threads: half of the CPU time is the
/// ideal wall time); `level_ms`: one-time cost of a new level. DEPTH_FILE: view depth at azimuth 30, raw float32, row 0 at the top.
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "engine/field/grid/grid.h"
#include "render/image/image.h"
#include "render/passes/renderer.h"

namespace {

using namespace catena;

double cpu_ms() { return 1e-6 * double(process_cpu_ns()); }

[[noreturn]] void fail(int code, const std::string& message) {
  fmt::print(stderr, "{}\n", message);
  std::exit(code);
}

/// The camera of the comparison, as in VTK.
render::View view_at(double azimuth_deg, int n) {
  const double a = azimuth_deg * M_PI / 180, e = 20 * M_PI / 180, centre = (n - 1) / 2.0, distance = 2.7 * n;
  render::View view;
  view.target = Vec3(centre);
  view.position = view.target + distance * Vec3(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
  view.up = {0, 0, 1};
  view.fovy_deg = 30;
  return view;
}

std::vector<float> values_of(const std::string& raw, int n) {
  std::vector<float> values(std::size_t(n) * n * n);
  std::ifstream in(raw, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
  if (!in) fail(2, fmt::format("{}: expected {}^3 floats", raw, n));
  return values;
}

render::RenderSettings settings_of(const std::string& mode) {
  if (mode == "draft") return render::draft_settings();
  render::RenderSettings s;
  if (mode == "r16f") s.texel_format = render::TexelFormat::r16f;
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) fail(2, "usage: isosurface_table RAW N LEVEL [VIEWS [DEPTH_FILE [MODE]]]");
  const std::string raw = argv[1];
  const int n = std::atoi(argv[2]);
  const double level = std::atof(argv[3]);
  const int views = argc > 4 ? std::atoi(argv[4]) : 10;
  const render::RenderSettings settings = settings_of(argc > 6 ? argv[6] : "exact");
  auto renderer = render::Renderer::create({});
  if (!renderer) fail(1, renderer.error().message);
  render::IsosurfaceItem item;
  item.grid = field::make_scalar_grid("density", {}, {n, n, n}, values_of(raw, n));
  item.color = {0.8f, 0.8f, 0.9f};
  render::FramePacket packet;
  packet.isosurfaces.push_back(item);
  const auto draw = [&](double azimuth, double at_level) {
    packet.isosurfaces[0].level = at_level;
    packet.view = view_at(azimuth, n);
    if (const auto drawn = (*renderer)->draw(packet, settings); !drawn) fail(1, drawn.error().message);
  };
  draw(0, level);
  draw(3, level);
  std::vector<double> wall, cpu;
  for (int i = 0; i < views; ++i) {
    const std::int64_t start = now_ns();
    const double used = cpu_ms();
    draw(360.0 / views * i + 7, level);
    wall.push_back(ms_since(start));
    cpu.push_back(cpu_ms() - used);
  }
  draw(30, level);
  if (argc > 5 && *argv[5]) {
    const auto depth = (*renderer)->read_depth();
    std::ofstream(argv[5], std::ios::binary)
        .write(reinterpret_cast<const char*>(depth->depth.data()), std::streamsize(depth->depth.size() * sizeof(float)));
  }
  if (const char* png = std::getenv("CATENA_PICTURE")) (void)render::write_png(png, (*renderer)->read_back().value(), false);
  double used = cpu_ms();
  draw(30, level + 1e-4);
  const double new_level = cpu_ms() - used;
  used = cpu_ms();
  draw(30, level + 1e-4);
  fmt::print("{{\"wall_ms\": {:.1f}, \"cpu_ms\": {:.1f}, \"level_cpu_ms\": {:.1f}, \"gpu_mib\": {:.0f}}}\n", quantile(wall, 0.5),
             quantile(cpu, 0.5), new_level - (cpu_ms() - used), double((*renderer)->stats().gpu_bytes) / (1 << 20));
  return 0;
}
