// SPDX-License-Identifier: MIT
#include "render/extract/linear_colors.h"

#include <algorithm>
#include <cmath>

#include "render/frame/linear_color.h"

namespace catena::render {
namespace {

using ColorPoints = std::vector<std::array<double, 4>>;  // value, r, g, b

constexpr double kStep = 1.0 / 24;  // largest change of a component between points: the conversion is linear in between to 0.0005

ColorPoints linear(const ColorPoints& points, double factor) {
  ColorPoints out;
  const auto add = [&](std::array<double, 4> point) {
    for (std::size_t c = 1; c < 4; ++c) point[c] = factor * to_linear(point[c]);
    out.push_back(point);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i]);
    if (i + 1 == points.size()) break;
    const auto &a = points[i], &b = points[i + 1];
    double change = 0;
    for (std::size_t c = 1; c < 4; ++c) change = std::max(change, std::fabs(b[c] - a[c]));
    const int parts = b[0] > a[0] ? std::max(1, int(std::ceil(change / kStep))) : 1;
    for (int k = 1; k < parts; ++k) {
      std::array<double, 4> point;
      for (std::size_t c = 0; c < 4; ++c) point[c] = a[c] + (b[c] - a[c]) * k / parts;
      add(point);
    }
  }
  return out;
}

/// Labels have values of their own, without points in between.
ColorPoints linear_labels(ColorPoints points, double factor) {
  for (auto& point : points)
    for (std::size_t c = 1; c < 4; ++c) point[c] = factor * to_linear(point[c]);
  return points;
}

ColorPoints linear(const ColorPoints& points, bool is_categorical, double factor = 1) {
  return is_categorical ? linear_labels(points, factor) : linear(points, factor);
}

void convert(std::optional<ColorSource>& source, double factor = 1) {
  if (source) source->colors = linear(source->colors, source->is_categorical, factor);
}

}  // namespace

void make_colors_linear(FramePacket& packet) {
  if (packet.fog) packet.fog->color = to_linear(packet.fog->color);
  for (VolumeItem& item : packet.volumes) {
    item.transfer.colors = linear(item.transfer.colors, item.transfer.is_categorical, item.scattering.albedo);
    convert(item.color_by, item.scattering.albedo);
  }
  for (IsosurfaceItem& item : packet.isosurfaces) {
    item.color = to_linear(item.color);
    convert(item.color_by);
  }
  for (SliceItem& item : packet.slices) {
    item.colors = linear(item.colors, false);
    item.line_color = to_linear(item.line_color);
  }
}

}  // namespace catena::render
