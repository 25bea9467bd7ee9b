/// The table of times and errors of volumes: one JSON line a setting, on the fields, camera and transfer functions of the comparison
/// with VTK (raw float32 volumes, 1024 x 768).   volume_table RAW N SHADE(0|1) [MODE ...]      see tests/bench/README.md
///   MODE: error=E | time=MS | draft | balanced | reference | exact=STEP | fast=STEP,SPACING,REFINE_HALF,REFINE_FULL[,smooth] (1/255; < 0
///   nowhere)
/// Times are medians over an orbit of 10 views, wall and process CPU (two threads: half of it is the ideal wall time); errors are
/// against our own converged picture at azimuth 30, over a black background (render/image/measure.h).
#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "engine/field/grid.h"
#include "render/image/measure.h"
#include "render/quality/quality.h"

namespace {

using namespace catena;

constexpr int kFinePoints = 64;  // from one opacity point to the next
constexpr double kPi = 3.14159265358979323846;

double cpu_ms() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  const auto ms = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
  return ms(use.ru_utime) + ms(use.ru_stime);
}

std::vector<std::array<double, 2>> opacity_of(const std::string& raw) {
  const std::string file = raw.substr(raw.find_last_of('/') + 1);
  if (std::getenv("CATENA_SPIKE")) return {{0, 0}, {.38, 0}, {.4, .5}, {.42, 0}, {1, 0}};
  if (file.starts_with("ml")) return {{0, 0}, {.3, 0}, {.5, .05}, {1, .2}};
  if (file.starts_with("fog")) return {{0, 0}, {.01, .005}, {1, .3}};
  return {{0, 0}, {.02, 0}, {1, .1}};
}

render::FramePacket packet_of(const std::string& raw, int n, bool shade) {
  std::vector<float> values(std::size_t(n) * n * n);
  std::ifstream in(raw, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
  if (!in) {
    fmt::print(stderr, "{}: expected {}^3 floats\n", raw, n);
    std::exit(2);
  }
  render::VolumeItem item;
  item.grid = field::make_scalar_grid("density", {}, {n, n, n}, values);
  item.transfer.colors = {{0, .1, .1, .4}, {.35, .1, .6, .8}, {.6, .9, .8, .3}, {1, .9, .2, .1}};
  // VTK interpolates opacity, not extinction
  const auto opacity = opacity_of(raw);
  for (std::size_t i = 0; i + 1 < opacity.size(); ++i)
    for (int k = i == 0 ? 0 : 1; k <= kFinePoints; ++k) {
      const double f = double(k) / kFinePoints, alpha = std::lerp(opacity[i][1], opacity[i + 1][1], f);
      item.transfer.extinctions.push_back({std::lerp(opacity[i][0], opacity[i + 1][0], f), -std::log1p(-alpha) / (n / 128.0)});
    }
  item.shade = shade;
  render::FramePacket packet;
  packet.volumes.push_back(item);
  packet.background[3] = 0;
  return packet;
}

/// VTK's camera of the comparison.
render::View view_at(double azimuth_deg, int n) {
  const double a = azimuth_deg * kPi / 180, e = 20 * kPi / 180, centre = (n - 1) / 2.0, distance = 2.7 * n;
  render::View view;
  view.target = Vec3(centre);
  view.position = view.target + distance * Vec3(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
  view.up = {0, 0, 1};
  view.fovy_deg = 30;
  return view;
}

render::RenderSettings settings_of(const std::string& mode) {
  render::RenderSettings s;
  if (mode == "draft") return render::draft_settings();
  if (mode == "balanced") return render::balanced_settings();
  if (mode == "reference") return render::reference_settings();
  if (mode.starts_with("exact=")) {
    s.step_voxels = std::atof(mode.c_str() + 6);
  } else {
    render::FastSettings f;
    unsigned spacing = 1;
    if (std::sscanf(mode.c_str(), "fast=%lf,%u,%lf,%lf", &f.step_voxels, &spacing, &f.refine_half_255, &f.refine_full_255) < 2) {
      fmt::print(stderr, "{}: expected exact=STEP or fast=STEP,SPACING,REFINE_HALF,REFINE_FULL\n", mode);
      std::exit(2);
    }
    f.spacing = spacing;
    f.smooth_gradients = mode.ends_with(",smooth");
    s.fast = f;
  }
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "usage: volume_table RAW N SHADE(0|1) MODE ...\n");
    return 2;
  }
  const std::string raw = argv[1];
  const int n = std::atoi(argv[2]);
  const bool shade = std::atoi(argv[3]) != 0;
  auto renderer = render::Renderer::create({});
  if (!renderer) {
    fmt::print(stderr, "{}\n", renderer.error().message);
    return 1;
  }
  render::FramePacket packet = packet_of(raw, n, shade);
  const auto draw = [&](double azimuth, const render::RenderSettings& settings) {
    packet.view = view_at(azimuth, n);
    const auto drawn = (*renderer)->draw(packet, settings);
    if (!drawn) {
      fmt::print(stderr, "{}\n", drawn.error().message);
      std::exit(1);
    }
  };
  const char* folder = std::getenv("CATENA_PICTURES");
  const std::string stem = raw.substr(raw.find_last_of('/') + 1) + (std::getenv("CATENA_SPIKE") ? "-spike" : "") + (shade ? "-shaded" : "");
  const std::string kept = folder ? std::string(folder) + "/" + stem + "-converged.png" : "";
  render::Picture converged;
  if (auto read = folder ? render::read_png(kept) : Result<render::Picture>(Error{""})) {
    converged = *read;
  } else {
    draw(30, render::reference_settings());
    converged = (*renderer)->read_back().value();
    if (folder) (void)render::write_png(kept, converged, true);
  }
  for (int k = 4; k < argc; ++k) {
    const std::string mode = argv[k];
    render::RenderSettings settings;
    double estimated = 0;
    if (mode.starts_with("error=") || mode.starts_with("time=")) {
      using Kind = render::QualityGoal::Kind;
      packet.view = view_at(30, n);
      const bool error = mode.starts_with("error=");
      const auto choice =
          render::choose_quality(**renderer, packet, {error ? Kind::error : Kind::time, std::atof(mode.c_str() + (error ? 6 : 5))});
      if (!choice) {
        fmt::print(stderr, "{}\n", choice.error().message);
        return 1;
      }
      settings = choice->settings;
      estimated = choice->estimated_rmse;
    } else {
      settings = settings_of(mode);
    }
    draw(0, settings);
    draw(3, settings);
    std::vector<double> wall, cpu;
    const char* views = std::getenv("CATENA_VIEWS");
    const int many = views ? std::atoi(views) : 10;
    for (int i = 0; i < many; ++i) {
      const std::int64_t start = now_ns();
      const double used = cpu_ms();
      draw(360.0 / many * i + 7, settings);
      wall.push_back(ms_since(start));
      cpu.push_back(cpu_ms() - used);
    }
    draw(30, settings);
    const render::Picture picture = (*renderer)->read_back().value();
    if (folder) (void)render::write_png(std::string(folder) + "/" + stem + "-" + mode + ".png", picture, false);
    const render::PictureError error = render::measure_error(picture, converged);
    fmt::print(
        "{{\"field\": \"{}\", \"shade\": {}, \"mode\": \"{}\", \"wall_ms\": {:.1f}, \"half_cpu_ms\": {:.1f}, \"rmse_covered\": {:.3f}, "
        "\"p999\": {:.0f}, \"thin_least_kept\": {:.3f}, \"thin_kept\": {:.3f}, \"estimated\": {:.3f}, \"what\": \"{}\", \"gpu_mib\": "
        "{:.0f}}}\n",
        stem, shade ? 1 : 0, mode, quantile(wall, 0.5), 0.5 * quantile(cpu, 0.5), error.rmse, error.p999, error.least_kept, error.kept,
        estimated, describe(settings), double((*renderer)->stats().gpu_bytes) / (1 << 20));
    std::fflush(stdout);
  }
  return 0;
}
