// SPDX-License-Identifier: MIT
/// Samples of the image: fewer pixels, scaled up, and several samples per pixel, compared with 4 x 4 samples per pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/tuning/measure/format_number.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "render/quality/quality.h"
#include "render/quality/refinement.h"

namespace catena::app::tuning {
namespace {

render::FramePacket sized(const render::FramePacket& packet, double factor) {
  render::FramePacket p = packet;
  p.width = static_cast<std::uint32_t>(std::lround(packet.width * factor));
  p.height = static_cast<std::uint32_t>(std::lround(packet.height * factor));
  return p;
}

/// Resizes an image: the mean over a pixel's area, or linear between pixel centers; premultiplied.
render::Image8 resized(const render::Image8& from, std::uint32_t width, std::uint32_t height) {
  if (from.width == width && from.height == height) return from;
  render::Image8 to{width, height, std::vector<std::uint8_t>(std::size_t(4) * width * height)};
  const double sx = double(from.width) / width, sy = double(from.height) / height;
  const int n = std::max(1, static_cast<int>(std::lround(sx)));
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      double sum[4] = {}, weights = 0;
      const auto add = [&](double weight, long px, long py) {
        const std::uint8_t* p = from.pixel(static_cast<std::uint32_t>(std::clamp<long>(px, 0, from.width - 1)),
                                           static_cast<std::uint32_t>(std::clamp<long>(py, 0, from.height - 1)));
        for (int c = 0; c < 3; ++c) sum[c] += weight * p[c] * p[3] / 255;
        sum[3] += weight * p[3];
        weights += weight;
      };
      if (sx > 1) {
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) add(1, static_cast<long>(x) * n + i, static_cast<long>(y) * n + j);
      } else {
        const double u = (x + 0.5) * sx - 0.5, v = (y + 0.5) * sy - 0.5, fu = u - std::floor(u), fv = v - std::floor(v);
        const long px = static_cast<long>(std::floor(u)), py = static_cast<long>(std::floor(v));
        add((1 - fu) * (1 - fv), px, py), add(fu * (1 - fv), px + 1, py), add((1 - fu) * fv, px, py + 1), add(fu * fv, px + 1, py + 1);
      }
      std::uint8_t* out = to.rgba.data() + 4 * (std::size_t(y) * width + x);
      for (int c = 0; c < 3; ++c) out[c] = sum[3] > 0 ? static_cast<std::uint8_t>(std::lround(std::min(255.0, 255 * sum[c] / sum[3]))) : 0;
      out[3] = static_cast<std::uint8_t>(std::lround(sum[3] / weights));
    }
  return to;
}

}  // namespace

Result<std::vector<Curve>> measure_resolution(Workload& subject) {
  RenderWorkload& eye = *subject.rendering;
  const std::uint32_t width = eye.packet.width, height = eye.packet.height;
  Curve curve = make_rendering_curve(
      subject, "resolution", "Samples per pixel",
      fmt::format(
          "An image of {}x{} with several samples per pixel; for comparison, enlarged images of fewer pixels, which are never chosen: "
          "--size sets the size of the image.",
          width, height));
  curve.work_name = "samples";
  const render::RenderSettings settings = eye.has_raycast ? render::exact_level(1) : render::RenderSettings{};
  // the error of 4 x 4 samples is estimated from the difference to 3 x 3
  CATENA_TRY(const render::Image8 four, render_image(*eye.renderer, sized(eye.packet, 4), settings));
  CATENA_TRY(const render::Image8 three, render_image(*eye.renderer, sized(eye.packet, 3), settings));
  const render::Image8 truth = resized(four, width, height);
  const double apart = render::measure_error(resized(three, width, height), truth).rmse;
  curve.reference_error = std::max(apart, render::kMinReportedRmse);
  curve.reference_error_name = apart > render::kMinReportedRmse ? "the error of the reference" : "the rounding error of 8 bits";
  curve.reference = fmt::format(
      "the image of 4 x 4 samples per pixel, with the same rays; it differs from that of 3 x 3 by {}/255; errors below {}/255{} cannot be "
      "resolved",
      format_number(apart), format_number(curve.reference_error),
      apart > render::kMinReportedRmse ? "" : ", the rounding error of 8 bits,");
  curve.discretization_error = kNotMeasured;
  curve.discretization_error_name = Curve().discretization_error_name;
  curve.discretization_error_method = "The discretization error is the same for all settings.";
  std::vector<render::FramePacket> packets;
  struct Try {
    double factor;
    const char *words, *write;
    bool offered = true;
  };
  for (const Try& t : {Try{0.25, "a quarter of the pixels along each axis", "", false},
                       {0.5, "half of the pixels along each axis", "", false},
                       {1, "1 sample per pixel", "--antialias 1"},
                       {2, "2 x 2 samples per pixel", "--antialias 2"},
                       {3, "3 x 3 samples per pixel", "--antialias 3"}}) {
    packets.push_back(sized(eye.packet, t.factor));
    CATENA_TRY(const render::Image8 picture, render_image(*eye.renderer, packets.back(), settings));
    const render::ImageError error = render::measure_error(resized(picture, width, height), truth);
    curve.points.push_back({t.words,
                            t.write,
                            "",
                            error.rmse,
                            double(picture.width) * picture.height,
                            {},
                            kNotMeasured,
                            {error.p999, 100 * error.thin_retained, 100 * error.min_thin_retained},
                            t.offered});
  }
  curve.current = 2;
  std::vector<TimedRun> repeats;
  const auto last = std::make_shared<LastRendered>();
  for (const render::FramePacket& packet : packets) repeats.push_back(make_interleaved_render_run(*eye.renderer, packet, settings, last));
  CATENA_CHECK(time_points(curve, repeats, 0.5 * subject.effort.rendering_s, 9));
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
