// SPDX-License-Identifier: MIT
#include "render/image/image_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"

namespace catena::render {
namespace {

constexpr int kRadius = 3;                  // radius of the opening, in pixels
constexpr float kMinTopHat = 8;             // minimum top-hat value of a thin part, in 1/255
constexpr std::size_t kMinPartPixels = 20;  // minimum size of a thin part, in pixels

bool is_covered(const Image8& a, const Image8& b, std::size_t i) { return a.rgba[4 * i + 3] > 0 || b.rgba[4 * i + 3] > 0; }

/// Returns the minimum or maximum (by `better`) over a disc about each pixel, clipped to the image.
template <class Better>
std::vector<float> of_disc(const std::vector<float>& from, int width, int height, Better&& better) {
  std::vector<float> to = from;
  parallel_for(std::size_t(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int dy = -std::min(kRadius, y); dy <= std::min(kRadius, height - 1 - y); ++dy)
        for (int dx = -kRadius; dx <= kRadius; ++dx) {
          if (dx * dx + dy * dy > kRadius * kRadius) continue;
          float* here = &to[std::size_t(y) * width];
          const float* there = &from[std::size_t(y + dy) * width];
          for (int x = std::max(0, -dx); x < std::min(width, width - dx); ++x) here[x] = better(here[x], there[x + dx]);
        }
  });
  return to;
}

std::vector<float> top_hat(const Image8& rendered) {
  const int width = int(rendered.width), height = int(rendered.height);
  std::vector<float> bright(rendered.rgba.size() / 4);
  for (std::size_t i = 0; i < bright.size(); ++i)
    bright[i] = float(rendered.rgba[4 * i] + rendered.rgba[4 * i + 1] + rendered.rgba[4 * i + 2]) / 3;
  const auto eroded = of_disc(bright, width, height, [](float a, float b) { return b < a ? b : a; });
  const auto opened = of_disc(eroded, width, height, [](float a, float b) { return b > a ? b : a; });
  for (std::size_t i = 0; i < bright.size(); ++i) bright[i] -= opened[i];
  return bright;
}

void measure_thin_parts(const Image8& rendered, const Image8& converged, ImageError& error) {
  const int width = int(converged.width), height = int(converged.height);
  const std::vector<float> truth = top_hat(converged), have = top_hat(rendered);
  std::vector<bool> visited(truth.size());
  std::vector<std::size_t> part;
  double all = 0, all_retained = 0;
  for (std::size_t first = 0; first < truth.size(); ++first) {
    if (visited[first] || !(truth[first] > kMinTopHat)) continue;
    part.assign(1, first);
    visited[first] = true;
    double sum = 0, retained = 0;
    for (std::size_t n = 0; n < part.size(); ++n) {
      const std::size_t i = part[n];
      sum += double(truth[i]);
      retained += double(std::min(truth[i], have[i]));
      const int x = int(i % std::size_t(width)), y = int(i / std::size_t(width));
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
          const std::size_t j = std::size_t(y + dy) * width + std::size_t(x + dx);
          if (visited[j] || !(truth[j] > kMinTopHat)) continue;
          visited[j] = true;
          part.push_back(j);
        }
    }
    if (part.size() < kMinPartPixels) continue;
    ++error.thin_feature_count;
    error.min_thin_retained = std::min(error.min_thin_retained, retained / sum);
    all += sum;
    all_retained += retained;
  }
  if (all > 0) error.thin_retained = all_retained / all;
}

/// Adds the squared changes of the error (image - converged image) between two frames, and the count of values, over covered pixels.
void add_changes(const Image8& last, const Image8& last_converged, const Image8& now, const Image8& converged, double& sum, double& count) {
  for (std::size_t i = 0; i < now.rgba.size() / 4; ++i) {
    if (!is_covered(now, converged, i) && !is_covered(last, last_converged, i)) continue;
    for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
      const double change = double(now.rgba[c]) - converged.rgba[c] - last.rgba[c] + last_converged.rgba[c];
      sum += change * change;
    }
    count += 3;
  }
}

}  // namespace

Image8 composite_over(const Image8& rendered, const std::array<float, 3>& background) {
  Image8 out = rendered;
  for (std::size_t i = 0; i < out.rgba.size(); i += 4) {
    const float alpha = float(out.rgba[i + 3]) / 255;
    for (std::size_t c = 0; c < 3; ++c)
      out.rgba[i + c] = std::uint8_t(std::lround(float(out.rgba[i + c]) * alpha + 255 * background[c] * (1 - alpha)));
  }
  return out;
}

PixelErrors compute_covered_errors(const Image8& rendered, const Image8& converged) {
  PixelErrors errors;
  for (std::size_t i = 0; i < rendered.rgba.size() / 4; ++i) {
    if (!is_covered(rendered, converged, i)) continue;
    double square = 0, max_difference = 0;
    for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
      const double d = std::fabs(double(rendered.rgba[c]) - converged.rgba[c]);
      square += d * d / 3;
      max_difference = std::max(max_difference, d);
    }
    errors.squared.push_back(square);
    errors.max_channel.push_back(max_difference);
  }
  return errors;
}

ImageError measure_error(const Image8& rendered_rgba, const Image8& converged_rgba, const std::array<float, 3>& background) {
  CATENA_ASSERT(rendered_rgba.width == converged_rgba.width && rendered_rgba.height == converged_rgba.height);
  const Image8 rendered = composite_over(rendered_rgba, background), converged = composite_over(converged_rgba, background);
  ImageError error;
  PixelErrors errors = compute_covered_errors(rendered, converged);
  if (errors.squared.empty()) return error;
  const auto count = double(errors.squared.size());
  error.rmse = std::sqrt(std::accumulate(errors.squared.begin(), errors.squared.end(), 0.0) / count);
  error.covered_share = count / (double(rendered.rgba.size()) / 4);
  error.p999 = quantile(errors.max_channel, 0.999);
  measure_thin_parts(rendered, converged, error);
  return error;
}

double measure_frame_flicker(const Image8& last, const Image8& last_converged, const Image8& now, const Image8& converged) {
  double sum = 0, count = 0;
  add_changes(last, last_converged, now, converged, sum, count);
  return count > 0 ? std::sqrt(sum / count) : 0;
}

double measure_flicker(const std::vector<Image8>& frames, const std::vector<Image8>& converged, const std::array<float, 3>& background) {
  CATENA_ASSERT(frames.size() == converged.size() && frames.size() >= 2);
  double sum = 0, count = 0;
  std::array<Image8, 2> last;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    std::array<Image8, 2> now{composite_over(frames[n], background), composite_over(converged[n], background)};
    if (n > 0) add_changes(last[0], last[1], now[0], now[1], sum, count);
    last = std::move(now);
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace catena::render
