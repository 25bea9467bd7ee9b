// SPDX-License-Identifier: MIT
/// Reads ParaView's exported color map: [{"Name", "ColorSpace", "HSVWrap", "RGBPoints": [x, r, g, b, ...], "Points": [x, a, middle,
/// sharpness, ...], ...}]. Keys that do not affect the colors are ignored. Between points ParaView interpolates in ColorSpace (default
/// RGB); other spaces than RGB are approximated by kPieces linear pieces. "Points" are opacities, straight lines only (middle 0.5,
/// sharpness 0), clamped to OpacityPoint::kMaxAlpha.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/readers.h"
#include "engine/schema/values.h"

namespace catena::scene {
namespace {

constexpr int kPieces = 32;

/// Reads a flat list of rows of four numbers; the first number of each row must rise.
Result<std::vector<std::array<double, 4>>> read_rows(const json::Node& node, std::string_view what) {
  if (node.kind != json::Kind::array || node.items.empty() || node.items.size() % 4 != 0)
    return json::error_at(node, in_quotes(what) + " is no list of rows; four numbers for each point were expected");
  std::vector<std::array<double, 4>> rows(node.items.size() / 4);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    CATENA_TRY(rows[i / 4][i % 4], json::as_number(node.items[i], node.items[i].label));
    if (i % 4 == 0 && i > 0 && !(rows[i / 4][0] > rows[i / 4 - 1][0]))
      return json::error_at(node.items[i], in_quotes(what) + " has the value " + to_text(rows[i / 4][0]) + " after " +
                                               to_text(rows[i / 4 - 1][0]) + "; strictly rising values were expected");
  }
  return rows;
}

Result<ColorSpace> read_space(const json::Node& map) {
  CATENA_TRY(const std::string name, json::get_string(map, "ColorSpace", "RGB"));
  if (name == "RGB") return ColorSpace::rgb;
  if (name == "HSV") {
    const json::Node* wrap = map.find("HSVWrap");
    if (wrap == nullptr) return ColorSpace::hsv;
    if (wrap->kind == json::Kind::boolean) return wrap->boolean ? ColorSpace::hsv_wrap : ColorSpace::hsv;
    CATENA_TRY(const int on, json::get_integer(map, "HSVWrap", 0, 0, 1));
    return on == 1 ? ColorSpace::hsv_wrap : ColorSpace::hsv;
  }
  if (name == "Lab" || name == "CIELAB") return ColorSpace::lab;
  if (name == "Diverging") return ColorSpace::diverging;
  return json::error_at(*map.find("ColorSpace"), "\"ColorSpace\" is " + in_quotes(name) + "; RGB, HSV, Lab or Diverging was expected");
}

Outcome read_rgb_points(const json::Node& node, ColorSpace space, TransferFunction& transfer) {
  CATENA_TRY(const auto rows, read_rows(node, "RGBPoints"));
  const auto color_of = [](const std::array<double, 4>& row) { return Vec3(row[1], row[2], row[3]); };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CATENA_TRY(const Color rgb, schema::as_color(color_of(rows[i]), node.items[4 * i], "RGBPoints"));
    const int pieces = i == 0 || space == ColorSpace::rgb ? 1 : kPieces;
    for (int k = 1; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces, value = (1 - t) * rows[i - 1][0] + t * rows[i][0];
      if (!(value > transfer.colors.back().value && value < rows[i][0])) continue;
      const Vec3 c = interpolate_colors(space, color_of(rows[i - 1]), color_of(rows[i]), t);
      transfer.colors.push_back({value, {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)}});
    }
    transfer.colors.push_back({rows[i][0], rgb});
  }
  return Done{};
}

Outcome read_opacity_points(const json::Node& node, TransferFunction& transfer) {
  CATENA_TRY(const auto rows, read_rows(node, "Points"));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [value, alpha, middle, sharpness] = rows[i];
    if (!(alpha >= 0 && alpha <= 1))
      return json::error_at(node.items[4 * i + 1],
                            "\"Points\" holds the opacity " + to_text(alpha) + "; a number from 0 to 1 was expected");
    if (i + 1 < rows.size() && (middle != 0.5 || sharpness != 0))
      return json::error_at(node.items[4 * i + 2], "\"Points\" holds a bent piece (" + to_text(middle) + ", " + to_text(sharpness) +
                                                       "); a straight one, 0.5, 0, was expected");
    transfer.opacities.push_back({value, std::min(alpha, TransferFunction::OpacityPoint::kMaxAlpha)});
  }
  return Done{};
}

}  // namespace

Result<TransferFunction> read_paraview_map(const json::Node& root) {
  if (root.items.size() != 1)
    return json::error_at(root, "holds " + std::to_string(root.items.size()) + " colour maps; an array of one was expected");
  const json::Node& map = root.items[0];
  CATENA_CHECK(json::expect_object(map, "the colour map"));
  const json::Node* points = map.find("RGBPoints");
  if (points == nullptr) return json::error_at(map, "the colour map has no \"RGBPoints\"; a list x, r, g, b, ... was expected");
  TransferFunction transfer;
  CATENA_TRY(const ColorSpace space, read_space(map));
  CATENA_CHECK(read_rgb_points(*points, space, transfer));
  if (const json::Node* opacities = map.find("Points")) CATENA_CHECK(read_opacity_points(*opacities, transfer));
  return transfer;
}

}  // namespace catena::scene
