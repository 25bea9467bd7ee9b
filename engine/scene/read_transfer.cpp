// SPDX-License-Identifier: MIT
#include "engine/scene/readers.h"
#include "engine/schema/values.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/symlog_scale.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"

namespace catena::scene {
namespace {

using Pair = std::array<double, 2>;

/// Reads a table of rows [value, ...]; at least one row, values strictly rising.
Result<std::vector<std::vector<double>>> read_table(const json::Node& node, std::string_view what, std::size_t width) {
  CATENA_TRY(auto rows, json::as_rows(node, what, width));
  if (rows.empty())
    return json::error_at(node, in_quotes(what) + " is empty; at least one row of " + std::to_string(width) + " numbers was expected");
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i][0] > rows[i - 1][0]))
      return json::error_at(node.items[i], in_quotes(what) + " has the value " + to_text(rows[i][0]) + " after " + to_text(rows[i - 1][0]) +
                                               "; strictly rising values were expected");
  return rows;
}

/// Reads "threshold": [lo, hi], or two such ranges that rise.
Result<Threshold> read_threshold(const json::Node& object) {
  const json::Node* node = object.find("threshold");
  if (node == nullptr) return Threshold();
  const auto refused = [](const json::Node& at) {
    return json::error_at(at, "\"threshold\" is no range; [lo, hi] with lo <= hi, or two such ranges one above the other, were expected");
  };
  if (node->kind != json::Kind::array || node->items.empty()) return refused(*node);
  const bool is_one = node->items.front().kind == json::Kind::number;
  Threshold threshold;
  for (std::size_t i = 0; i < (is_one ? 1 : node->items.size()); ++i) {
    const json::Node& row = is_one ? *node : node->items[i];
    if (row.kind != json::Kind::array || row.items.size() != 2 || i == kMaxThresholdRanges) return refused(row);
    CATENA_TRY(const double lo, json::as_number(row.items[0], "threshold"));
    CATENA_TRY(const double hi, json::as_number(row.items[1], "threshold"));
    if (lo > hi || (!threshold.empty() && lo <= threshold.back()[1])) return refused(row);
    threshold.push_back({lo, hi});
  }
  return threshold;
}

/// Reads "mapping" and "linear_below"; nullopt if neither is given.
Result<std::optional<ValueMapping>> read_mapping(const json::Node& object) {
  const json::Node* below = object.find("linear_below");
  CATENA_TRY(const int kind, json::get_choice(object, "mapping", 0, {std::begin(kMappingNames), std::end(kMappingNames)}));
  ValueMapping mapping{static_cast<ValueMapping::Kind>(kind), 0};
  if (below != nullptr && mapping.kind != ValueMapping::Kind::symlog)
    return json::error_at(*below, "\"linear_below\" is given, but \"mapping\" is " + in_quotes(to_string(mapping.kind)) +
                                      "; \"symlog\" was expected with it");
  CATENA_TRY(mapping.linear_below, json::get_number(object, "linear_below", 0, json::NumberRange::positive));
  return object.find("mapping") == nullptr ? std::nullopt : std::optional(mapping);
}

/// Checks the mapping against explicit values; automatic ones are checked when the data are loaded.
Outcome check_mapping(const json::Node& object, const TransferFunction& transfer) {
  double minimum = std::numeric_limits<double>::infinity();
  std::string what;
  const auto update_minimum = [&](const auto& points, const char* key) {
    if (!points.empty() && points.front().value < minimum) minimum = points.front().value, what = in_quotes(key);
  };
  update_minimum(transfer.colors, "color");
  update_minimum(transfer.opacities, "opacity");
  update_minimum(transfer.extinctions, "extinction");
  if (transfer.named.range && (*transfer.named.range)[0] < minimum) minimum = (*transfer.named.range)[0], what = "\"range\"";
  const std::string problem = mapping_error(transfer.named.mapping, minimum, what);
  return problem.empty() ? Outcome(Done{}) : json::error_at(json::member_or_parent(object, "mapping"), problem);
}

/// Reads "color", "range" and "mapping".
Outcome read_colors(const json::Node& object, std::vector<ColorPoint>& colors, NamedColors& named) {
  CATENA_TRY(named.range, read_range(object, "range"));
  CATENA_TRY(const std::optional<ValueMapping> mapping, read_mapping(object));
  named.mapping = mapping.value_or(ValueMapping{});
  const json::Node* color = object.find("color");
  if (color == nullptr) return Done{};
  if (color->kind == json::Kind::string) {
    if (!is_color_map(color->string)) return json::error_at(*color, "\"color\": " + unknown_color_map_message(color->string));
    named.map = color->string;
    return Done{};
  }
  CATENA_TRY(colors, read_color_table(*color, "color"));
  if (named.range)
    return json::error_at(
        *object.find("range"),
        "\"range\" is given beside a table \"color\", whose rows say their values; a colour map's name was expected there");
  return Done{};
}

Outcome read_gradient_opacity(const json::Node& object, TransferFunction& transfer) {
  const json::Node* node = object.find("gradient_opacity");
  if (node == nullptr) return Done{};
  CATENA_TRY(const auto rows, read_table(*node, "gradient_opacity", 2));
  transfer.gradient_factors.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!(rows[i][0] >= 0))
      return json::error_at(node->items[i],
                            "\"gradient_opacity\" holds the gradient " + to_text(rows[i][0]) + "; a length >= 0 was expected");
    if (!(rows[i][1] >= 0 && rows[i][1] <= 1))
      return json::error_at(node->items[i],
                            "\"gradient_opacity\" holds the factor " + to_text(rows[i][1]) + "; a number from 0 to 1 was expected");
    transfer.gradient_factors.push_back({rows[i][0], rows[i][1]});
  }
  return Done{};
}

/// Reads "opacity", "opacity_length", "extinction", "gradient_opacity".
Outcome read_opacities(const json::Node& object, TransferFunction& transfer) {
  const json::Node *opacity = object.find("opacity"), *extinction = object.find("extinction"), *unit = object.find("opacity_unit");
  if (opacity != nullptr && extinction != nullptr)
    return json::error_at(*extinction, "both \"opacity\" and \"extinction\" are given; one of them was expected");
  if (unit != nullptr && opacity == nullptr)
    return json::error_at(*unit, "\"opacity_unit\" is given without \"opacity\"; the table \"opacity\" was expected beside it");
  if (opacity != nullptr) {
    CATENA_TRY(const auto rows, read_table(*opacity, "opacity", 2));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!(rows[i][1] >= 0 && rows[i][1] <= 1))
        return json::error_at(opacity->items[i], "\"opacity\" holds " + to_text(rows[i][1]) + "; an opacity 0 <= a <= 1 was expected");
      const double alpha = rows[i][1] < 1 ? rows[i][1] : TransferFunction::OpacityPoint::kMaxAlpha;
      transfer.opacities.push_back({rows[i][0], alpha});
    }
    CATENA_TRY(transfer.opacity_unit, json::get_number(object, "opacity_unit", 0, json::NumberRange::positive));
  }
  if (extinction != nullptr) {
    CATENA_TRY(const auto rows, read_table(*extinction, "extinction", 2));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!(rows[i][1] >= 0))
        return json::error_at(extinction->items[i], "\"extinction\" holds " + to_text(rows[i][1]) + "; a sigma >= 0 was expected");
      transfer.extinctions.push_back({rows[i][0], rows[i][1]});
    }
  }
  return read_gradient_opacity(object, transfer);
}

/// Calls each(value) for every value of the tables, and of the range of a named map.
template <class Each>
void each_value(TransferFunction& transfer, Each&& each) {
  for (auto& p : transfer.colors) each(p.value);
  for (auto& p : transfer.opacities) each(p.value);
  for (auto& p : transfer.extinctions) each(p.value);
  if (transfer.named.range)
    for (double& v : *transfer.named.range) each(v);
}

bool rises(const TransferFunction& transfer) {
  const auto not_rising = [](const auto& a, const auto& b) { return !(a.value < b.value); };
  return std::adjacent_find(transfer.colors.begin(), transfer.colors.end(), not_rising) == transfer.colors.end() &&
         std::adjacent_find(transfer.opacities.begin(), transfer.opacities.end(), not_rising) == transfer.opacities.end() &&
         std::adjacent_find(transfer.extinctions.begin(), transfer.extinctions.end(), not_rising) == transfer.extinctions.end();
}

/// Moves the values of the tables from their own range to `range`: each keeps its relative position, measured on the scale of the file's
/// mapping and set on the scale of `mapping`.
Outcome stretch_to_range(TransferFunction& transfer, const Pair& range, const ValueMapping& mapping, const json::Node& where) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  each_value(transfer, [&](const double& v) { lo = std::min(lo, v), hi = std::max(hi, v); });
  if (const std::string problem = mapping_error(mapping, range[0], "\"range\""); !problem.empty()) return json::error_at(where, problem);
  if (lo <= hi) {
    const double from = linear_below(transfer.named.mapping, lo, hi), to = linear_below(mapping, range[0], range[1]);
    each_value(transfer, [&](double& v) {
      const double t = (symlog(v, from) - symlog(lo, from)) / (symlog(hi, from) - symlog(lo, from));
      v = symlog_interpolate(range[0], range[1], t, to);
    });
    // a single value, or values that become equal
    if (!(lo < hi) || !std::isfinite(hi - lo) || !rises(transfer))
      return json::error_at(where, "\"range\" cannot hold the values of the transfer file, which reach from " + to_text(lo) + " to " +
                                       to_text(hi) + "; a wider range was expected");
  }
  if (transfer.colors.empty()) transfer.named.range = range;
  return Done{};
}

/// Reads the file that "transfer" names.
Result<TransferFunction> read_transfer_file(const std::string& scene_path, const json::Node& object) {
  const json::Node& node = *object.find("transfer");
  for (const char* key : {"color", "opacity", "extinction"})
    if (const json::Node* other = object.find(key))
      return json::error_at(*other,
                            "both \"transfer\" and " + in_quotes(key) + " are given; a transfer file that says all, or none, was expected");
  CATENA_TRY(const std::string name, json::as_string(node, "transfer"));
  const std::string path = resolve_path(scene_path, name);
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code))
    return json::error_at(node, "\"transfer\": " + in_quotes(path) +
                                    (std::filesystem::exists(path, code) ? " is not a file" : " does not exist") +
                                    "; a transfer file (JSON) was expected");
  CATENA_TRY(const std::string text, read_text_file(path, "a transfer file (JSON)", kMaxJsonBytes));
  CATENA_TRY(TransferFunction transfer, parse_transfer(text, path));
  transfer.file = path;
  CATENA_TRY(const std::optional<Pair> range, read_range(object, "range"));
  CATENA_TRY(const std::optional<ValueMapping> explicit_mapping, read_mapping(object));
  const ValueMapping mapping = explicit_mapping.value_or(transfer.named.mapping);
  if (range) CATENA_CHECK(stretch_to_range(transfer, *range, mapping, *object.find("range")));
  transfer.named.mapping = mapping;
  CATENA_CHECK(check_mapping(object, transfer));
  return transfer;
}

}  // namespace

Result<std::optional<Pair>> read_range(const json::Node& object, std::string_view key) {
  const json::Node* node = object.find(key);
  if (node == nullptr) return std::optional<Pair>();
  const std::string expected = "two rising numbers [lo, hi] were expected";
  if (node->kind != json::Kind::array || node->items.size() != 2) return json::error_at(*node, in_quotes(key) + " is no pair; " + expected);
  CATENA_TRY(const double lo, json::as_number(node->items[0], std::string(key) + "[0]"));
  CATENA_TRY(const double hi, json::as_number(node->items[1], std::string(key) + "[1]"));
  if (!is_color_range(lo, hi)) return json::error_at(*node, in_quotes(key) + " is [" + to_text(lo) + ", " + to_text(hi) + "]; " + expected);
  return std::optional<Pair>({lo, hi});
}

Result<std::vector<ColorPoint>> read_color_table(const json::Node& node, std::string_view what) {
  std::vector<ColorPoint> colors;
  CATENA_TRY(const auto rows, read_table(node, what, 4));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CATENA_TRY(const Color rgb, schema::as_color({rows[i][1], rows[i][2], rows[i][3]}, node.items[i], what));
    colors.push_back({rows[i][0], rgb});
  }
  return colors;
}

Result<ColorScale> read_color_scale(const std::string& scene_path, const json::Node& object) {
  ColorScale scale;
  CATENA_TRY(const Threshold threshold, read_threshold(object));
  if (object.find("transfer") == nullptr) {
    CATENA_CHECK(read_colors(object, scale.colors, scale.named));
    scale.named.threshold = threshold;
    TransferFunction explicit_values;
    explicit_values.colors = scale.colors;
    explicit_values.named = scale.named;
    CATENA_CHECK(check_mapping(object, explicit_values));
    return scale;
  }
  CATENA_TRY(TransferFunction transfer, read_transfer_file(scene_path, object));
  if (transfer.colors.empty() && transfer.named.map.empty())
    return json::error_at(*object.find("transfer"),
                          "\"transfer\": " + in_quotes(transfer.file) + " holds no colours; \"color\" was expected in it");
  scale.colors = std::move(transfer.colors);
  scale.named = std::move(transfer.named);
  scale.named.threshold = threshold;
  return scale;
}

Result<TransferFunction> read_transfer(const std::string& scene_path, const json::Node& object) {
  CATENA_TRY(const Threshold threshold, read_threshold(object));
  if (object.find("transfer") == nullptr) {
    TransferFunction transfer;
    CATENA_CHECK(read_colors(object, transfer.colors, transfer.named));
    transfer.named.threshold = threshold;
    CATENA_CHECK(read_opacities(object, transfer));
    CATENA_CHECK(check_mapping(object, transfer));
    return transfer;
  }
  CATENA_TRY(TransferFunction transfer, read_transfer_file(scene_path, object));
  transfer.named.threshold = threshold;
  if (const json::Node* unit = object.find("opacity_unit")) {
    if (transfer.opacities.empty())
      return json::error_at(*unit, "\"opacity_unit\" is given, but the transfer file holds no \"opacity\"; one in it was expected");
    CATENA_TRY(transfer.opacity_unit, json::get_number(object, "opacity_unit", 0, json::NumberRange::positive));
  }
  CATENA_CHECK(read_gradient_opacity(object, transfer));
  return transfer;
}

Result<TransferFunction> parse_transfer(std::string_view text, const std::string& path) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  if (root.kind == json::Kind::array) return read_paraview_map(root);
  CATENA_CHECK(json::expect_object(root, "the transfer function"));
  CATENA_CHECK(json::check_known_keys(
      root, {"color", "range", "mapping", "linear_below", "opacity", "opacity_unit", "extinction", "gradient_opacity"}));
  TransferFunction transfer;
  CATENA_CHECK(read_colors(root, transfer.colors, transfer.named));
  CATENA_CHECK(read_opacities(root, transfer));
  CATENA_CHECK(check_mapping(root, transfer));
  if (root.members.empty())
    return json::error_at(root, "the transfer function is empty; \"color\", \"opacity\" or \"extinction\" was expected");
  return transfer;
}

}  // namespace catena::scene
