// SPDX-License-Identifier: MIT
/// Stated errors against an independent marcher that shares only the rays with the renderer: double precision, per cell, with the
/// transfer function's own points. Random functions over ranges up to 1e6 with features of all widths. CATENA_TRANSFER_FUNCTIONS=100
/// sets their number and prints them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "engine/base/symlog_scale.h"
#include "render/frame/camera.h"
#include "render/image/image_error.h"
#include "render/quality/quality.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::transfer_reference_test {

using namespace catena::render;
using Rows2 = std::vector<std::array<double, 2>>;
using Rows4 = std::vector<std::array<double, 4>>;

constexpr int kNodes = 14;
constexpr double kStep = 1.0 / 96;  // in voxels

template <class Rows>
double between(const Rows& rows, double v, std::size_t column, bool log) {
  if (v <= rows.front()[0]) return rows.front()[column];
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto &a = rows[i - 1], &b = rows[i];
    if (v > b[0]) continue;
    const double t = log ? std::log(v / a[0]) / std::log(b[0] / a[0]) : (v - a[0]) / (b[0] - a[0]);
    return a[column] + t * (b[column] - a[column]);
  }
  return rows.back()[column];
}

struct Case {
  std::vector<float> voxels;
  Rows2 extinctions;
  Rows4 colors;
  double ratio = 1;  ///< ratio of the range's ends
  bool log = false;  ///< true: logarithmic mapping
};

double trilinear(const Case& c, const Vec3& p) {
  int cell[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    cell[a] = std::clamp(int(std::floor(p[a])), 0, kNodes - 2);
    f[a] = std::clamp(p[a] - cell[a], 0.0, 1.0);
  }
  double sum = 0;
  for (int n = 0; n < 8; ++n) {
    const int i = n & 1, j = n >> 1 & 1, k = n >> 2;
    const double weight = (i ? f[0] : 1 - f[0]) * (j ? f[1] : 1 - f[1]) * (k ? f[2] : 1 - f[2]);
    sum += weight * double(c.voxels[std::size_t(((cell[2] + k) * kNodes + cell[1] + j) * kNodes + cell[0] + i)]);
  }
  return sum;
}

/// Image with straight alpha and 8 bits per channel, as the renderer's.
Image8 marched(const Case& c, const FramePacket& packet) {
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  Image8 rendered{packet.width, packet.height, {}};
  for (const auto& [x, y] : pixels_of(packet)) {
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const Vec3 way = (1 / norm(ray.direction)) * ray.direction;
    const auto [enter, leave] = ray_interval(*packet.volumes[0].grid, ray.origin, way);
    double through = 1;
    const int count = leave > enter ? int(std::ceil((leave - enter) / kStep)) : 0;
    double sum[3] = {};
    for (int k = 0; k < count && through > 1e-6; ++k) {
      const double h = (leave - enter) / count, v = trilinear(c, ray.origin + (enter + (k + 0.5) * h) * way);
      const double after = through * std::exp(-h * between(c.extinctions, v, 1, c.log));
      for (std::size_t b = 0; b < 3; ++b) sum[b] += (through - after) * between(c.colors, v, b + 1, c.log);
      through = after;
    }
    for (const double component : sum)
      rendered.rgba.push_back(through < 1 ? std::uint8_t(std::lround(255 * component / (1 - through))) : std::uint8_t(0));
    rendered.rgba.push_back(std::uint8_t(std::lround(255 * (1 - through))));
  }
  return rendered;
}

class TransferReference : public ImageTest {
 protected:
  double in(double lo, double hi) { return lo + (hi - lo) * (double(random_()) / 4294967296.0); }

  /// Smooth values, spread uniformly or over all decades; rises and falls as narrow as a millionth of the range.
  Case make_case(bool log) {
    Case c;
    c.log = log;
    c.ratio = std::pow(10, in(0.3, 6));
    const double lo = std::pow(10, in(-3, 3)), hi = lo * c.ratio;
    const bool decades = random_() % 2 == 0;
    const auto value = [&](double u) { return decades ? lo * std::pow(hi / lo, u) : lo + u * (hi - lo); };
    const double a = in(0.2, 0.7), b = in(0.2, 0.7), phase = in(0, 6);
    for (int z = 0; z < kNodes; ++z)
      for (int y = 0; y < kNodes; ++y)
        for (int x = 0; x < kNodes; ++x)
          c.voxels.push_back(float(value(0.5 + 0.5 * std::sin(a * x + 0.1 * y + phase) * std::cos(b * y + 0.3 * z))));
    std::vector<double> knots;
    for (int k = 0, count = int(in(1, 6)); k < count; ++k) {
      const double at = value(in(0, 1)), width = std::pow(10, in(-6, -0.5)) * at;
      knots.insert(knots.end(), {at, at + width});
    }
    std::ranges::sort(knots);
    const double max_spacing = std::pow(10, in(-1, 0.8)) / kNodes;
    for (const double at : knots) {
      if (c.extinctions.empty() || at > c.extinctions.back()[0]) c.extinctions.push_back({at, random_() % 3 == 0 ? 0 : in(0, max_spacing)});
      if (c.colors.empty() || at > c.colors.back()[0]) c.colors.push_back({at, in(0, 1), in(0, 1), in(0, 1)});
    }
    return c;
  }
  static FramePacket packet_for(const Case& c) {
    FramePacket packet = make_packet({34, -22, 20}, Vec3(0.5 * (kNodes - 1)), 26);
    set_size(packet, 96, 72);
    const field::Index3 size{kNodes, kNodes, kNodes};
    VolumeItem item;
    item.grid = field::make_scalar_grid("f", {}, size, c.voxels, {});
    // as render/extract derives it from a scene
    const double below = item.transfer.linear_below = c.log ? std::min(c.colors.front()[0], c.extinctions.front()[0]) : 0;
    item.transfer.colors = refine_for_symlog(c.colors, below, 1.0 / 32768);
    item.transfer.extinctions = refine_for_symlog(c.extinctions, below, 1.0 / 32768);
    packet.volumes = {item};
    packet.background = {0, 0, 0, 1};
    return packet;
  }
  double true_rmse(FramePacket packet, const RenderSettings& settings, const Image8& truth) {
    packet.background[3] = 0;
    return measure_error(draw(packet, settings), truth).rmse;
  }
  std::mt19937 random_{20};
};

TEST_F(TransferReference, StatedErrorsMatchAnIndependentMarcher) {
  const char* wanted = std::getenv("CATENA_TRANSFER_FUNCTIONS");
  const int count = wanted ? std::atoi(wanted) : 6;
  for (int k = 0; k < count; ++k) {
    const Case c = make_case(k % 3 == 2);
    const FramePacket packet = packet_for(c);
    const Image8 truth = marched(c, packet);
    const auto reference = half_step_difference(*renderer_, packet, reference_settings());
    ASSERT_TRUE(reference);
    const double min_rmse = 0.4;  // error of rounding to 8 bits (kMinReportedRmse)
    const double off = true_rmse(packet, reference_settings(), truth);
    EXPECT_LT(off, 1.5 * std::max(*reference, min_rmse)) << k;
    if (wanted)
      std::printf("%3d %s 1e%.1f points %zu reference stated %.3f true %.3f", k, c.log ? "log" : "linear", std::log10(c.ratio),
                  c.extinctions.size(), *reference, off);
    for (const auto& [goal, once] : {std::pair{2.0, false}, {0.8, false}, {2.0, true}}) {
      const auto choice = choose_quality(*renderer_, packet, {QualityGoal::Kind::error, goal, once});
      ASSERT_TRUE(choice);
      const double reached = true_rmse(packet, choice->settings, truth);
      EXPECT_LT(reached, 1.5 * std::max(choice->estimated_rmse, min_rmse)) << k << " " << describe(choice->settings);
      if (wanted)
        std::printf(" | error=%g%s stated %.3f true %.3f %s", goal, once ? " once" : "", choice->estimated_rmse, reached,
                    choice->settings.fast ? "fast" : "exact");
    }
    if (wanted) std::printf("\n");
  }
}

}  // namespace catena::test::transfer_reference_test
