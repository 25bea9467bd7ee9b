#include "engine/scene/first_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/field/label_surface.h"
#include "engine/flow/seeds.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/data_kind.h"
#include "engine/scene/flow_kind.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/transfer.h"
#include "engine/scene/write_values.h"

namespace catena::scene {
namespace {

constexpr Color kBackdrop{0.13f, 0.15f, 0.18f};
constexpr Color kBone{0.94f, 0.89f, 0.79f}, kSkin{0.87f, 0.67f, 0.56f}, kTissue{0.86f, 0.76f, 0.69f}, kSolid{0.72f, 0.77f, 0.84f};
constexpr double kSkinLevel = -300, kBoneLevel = 250, kSkinOpacity = 0.25, kShellOpacity = 0.2;
constexpr double kMeanDepth = 3.5, kMostDepth = 12, kLowDepth = 0.5;                         // optical depths of a ray across the domain
constexpr double kMostlyEmpty = 0.5;                                                         // of the values: the background
constexpr double kApart = 1.0 / 17, kLineWidth = 0.0035, kLineLength = 2, kNarrowest = 0.3;  // of lines: by the domain's diagonal
constexpr Color kFibre{0.90f, 0.62f, 0.42f};
constexpr double kFlat = 1, kWide = 7;  // cells: a single image has at most so many one way, and at least so many the others
constexpr const char* kQuantityMap = "viridis";

/// A level that a surface can have: within the values.
bool has_level(const field::ScalarGrid& grid, double level) {
  const DisplayRange& range = display_range(grid);
  return level > range.lo && level < range.hi;
}

/// With as many digits as say it to a thousandth of the range.
double rounded(double value, const DataFacts& facts) {
  const double step = std::pow(10, std::floor(std::log10(std::max(facts.hi - facts.lo, 1e-30))) - 2);
  return std::round(value / step) * step;
}

double three_digits(double value) { return rounded_to(value, 3); }

std::string surface(const std::string& field, double level, const Color& color, double opacity = 1) {
  return "{\"field\": " + field + ", \"level\": " + text_of(level) + ", \"color\": " + text_of(color) +
         (opacity < 1 ? ", \"opacity\": " + text_of(opacity) : "") + "}";
}

std::string surfaces(const std::vector<std::string>& items) {
  std::string text = "  \"isosurfaces\": [";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i > 0 ? ",\n                  " : "") + items[i];
  return text + "]";
}

/// Its title is the name of what is shown, with its unit.
std::string bar_of(const std::string& what, bool box = true) {
  return ",\n  \"scalar_bars\": [{" + what + "}]" + (box ? ",\n  \"bounding_box\": true" : "");
}

/// In the colours that are asked for. A map that is named without a range reaches over the values that the opacity follows, not over all.
std::string colored_volume(const std::string& field, const field::ScalarGrid& grid, NamedColors colors) {
  if (!colors.map.empty() && !colors.range) {
    TransferFunction transfer;
    transfer.named.mapping = colors.mapping;
    complete_transfer(transfer, grid);
    const double lo = transfer.colors.front().value, hi = transfer.colors.back().value;
    if (is_color_range(lo, hi)) colors.range = {lo, hi};
  }
  return "  \"volumes\": [{\"field\": " + field + color_members(colors) + ", \"shade\": true}]";
}

std::string quantity(const std::string& field, const field::ScalarGrid& grid, const DataFacts& facts) {
  double lo = rounded(facts.lo, facts), hi = rounded(facts.hi, facts);
  if (!is_color_range(lo, hi)) return colored_volume(field, grid, {kQuantityMap, {}});
  // what is empty is left out; without an empty part the low values can be seen, too
  const bool empty = facts.background_share > kMostlyEmpty;
  const double clear = 1 / std::max(grid.length(), 1e-300);
  std::string text = "  \"volumes\": [{\"field\": " + field + ", \"color\": " + text_of(kQuantityMap) +
                     ", \"range\": " + text_of(std::array<double, 2>{lo, hi}) + ",\n               \"extinction\": ";
  std::string rows = "[";
  const double mean = std::max((facts.mean - facts.lo) / (facts.hi - facts.lo), 1e-3);
  const double most = std::clamp(kMeanDepth / mean, kMeanDepth, kMostDepth);
  for (const auto& [share, depth] : {std::pair{0.0, empty ? 0.0 : kLowDepth}, {0.1, kLowDepth}, {1.0, most}})
    rows += (share > 0 ? ", [" : "[") + text_of(rounded(lo + share * (hi - lo), facts)) + ", " + text_of(three_digits(depth * clear)) + "]";
  text += rows + "]}]";
  return text + bar_of("\"volume\": 0");
}

std::string computed_tomography(const std::string& field, const field::ScalarGrid& grid, const DataFacts& facts) {
  std::vector<std::string> items;
  const bool bone = has_level(grid, kBoneLevel);
  if (bone) items.push_back(surface(field, kBoneLevel, kBone));
  if (has_level(grid, kSkinLevel)) items.push_back(surface(field, kSkinLevel, kSkin, bone ? kSkinOpacity : 1));
  return items.empty() ? quantity(field, grid, facts) : surfaces(items);
}

/// All labels in one surface: what lies between two of them is hidden, and a surface for each would be many times the work.
void show_labels(const std::string& field, FirstLook& look) {
  const std::string name = field.substr(1, field.size() - 2) + "_labels";
  const std::string surface = json::string_text(name);
  look.labels = true;
  look.fields = ",\n             " + surface + ": {\"label\": \"*\", \"of\": " + field + "}";
  look.parts =
      surfaces({"{\"field\": " + surface + ", \"level\": " + text_of(field::kLabelLevel) + ", \"color_by\": {\"field\": " + field + "}}"}) +
      bar_of("\"field\": " + field, false);
}

std::string angiogram(const std::string& field, const DataFacts& facts) {
  const double lo = rounded(facts.background, facts), hi = rounded(facts.hi, facts);
  return "  \"volumes\": [{\"field\": " + field + ", \"color\": \"grey\", \"range\": " + text_of(std::array<double, 2>{lo, hi}) +
         ", \"opacity\": [[" + text_of(lo) + ", 0], [" + text_of(hi) + ", 0.95]], \"projection\": \"maximum\"}]";
}

/// The axis along which the grid is a single image, or -1.
int flat_axis(const field::ScalarGrid& grid) {
  const Vec3 size = grid.index_box().hi - grid.index_box().lo;
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] <= kFlat && std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]) >= kWide) return axis;
  return -1;
}

/// A single image: as it is, from lo to hi in grey.
std::string image(const std::string& field, const field::ScalarGrid& grid, int axis, const DataFacts& facts, NamedColors colors) {
  const Vec3 middle = grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi));
  if (colors.map.empty()) colors.map = "grey";
  if (!colors.range && is_color_range(rounded(facts.lo, facts), rounded(facts.hi, facts)))
    colors.range = {rounded(facts.lo, facts), rounded(facts.hi, facts)};
  const Vec3 normal = direction(grid.mapping().world_gradient(Vec3(axis == 0, axis == 1, axis == 2)));
  return "  \"slices\": [{\"field\": " + field + ", \"point\": " + text_of(middle) + ", \"normal\": " + text_of(normal) +
         color_members(colors) + "}]" + bar_of("\"slice\": 0", false);
}

}  // namespace

std::string soft_background() { return "  \"background\": " + text_of(kBackdrop); }

std::string color_members(const NamedColors& colors) {
  std::string text;
  for (const auto& [key, value] : scale_members({}, colors)) text += ", \"" + key + "\": " + value;
  return text;
}

FirstLook first_look(const std::string& field, const field::ScalarGrid& grid, const field::Units& units, NamedColors colors) {
  const DataFacts facts = data_facts(grid, units);
  DataKind kind = kind_of(facts);
  // by a part of the voxels it may look like one
  if (kind == DataKind::label_map && !field::label_counts(grid)) kind = DataKind::solid;
  FirstLook look;
  look.whole = facts.masked && (kind == DataKind::ct || kind == DataKind::mr || kind == DataKind::solid);
  look.note = "looks like " + std::string(kind_word(kind)) + ": " + why(kind, facts);
  const DisplayRange& range = display_range(grid);
  const bool one_value = !(range.lo < range.hi);
  if (one_value) look.note = std::string(range.is_cut() ? "every other value is " : "every value is ") + readable(range.lo);
  const auto level = [&](double value) {
    return has_level(grid, rounded(value, facts)) ? rounded(value, facts) : 0.5 * (range.lo + range.hi);
  };
  const auto body = [&](double at) {
    look.shell = surfaces({surface(field, at, kSolid, kShellOpacity)});
    return surfaces({surface(field, at, kSolid)});
  };
  if (const int axis = flat_axis(grid); axis >= 0) {
    look.note = "is a single image";
    look.parts = image(field, grid, axis, facts, std::move(colors)) + ",\n" + soft_background();
    return look;
  }
  if (!colors.is_default() || one_value) {
    look.parts = colored_volume(field, grid, colors);
  } else {
    switch (kind) {
      case DataKind::ct:
        look.parts = computed_tomography(field, grid, facts);
        break;
      case DataKind::mr:
        look.parts = surfaces({surface(field, level(0.5 * (facts.background + facts.threshold)), kTissue)});
        break;
      case DataKind::label_map:
        show_labels(field, look);
        break;
      case DataKind::solid:
        look.parts = body(level(facts.threshold));
        break;
      case DataKind::level_set:
        look.parts = body(level(0));
        break;
      case DataKind::angiogram:
        // black, as its least values are: on anything lighter its outline would be a dark rag
        look.parts = angiogram(field, facts) + ",\n  \"background\": [0, 0, 0]";
        return look;
      case DataKind::cloud:
        look.parts = colored_volume(field, grid, {"grey", {}});
        break;
      case DataKind::simulation:
        look.parts = quantity(field, grid, facts);
        break;
    }
  }
  look.parts += ",\n" + soft_background();
  return look;
}

FirstLook first_look(const std::string& field, const field::VectorGrid& grid, const NamedColors& colors) {
  const FlowFacts facts = flow_facts(grid);
  const double diagonal = grid.world_bounds().diagonal();
  // where most of the field stands still, what moves is narrow
  const bool narrow = facts.middle < kStill * facts.fast;
  const double size = narrow ? std::clamp(std::cbrt(facts.moving), kNarrowest, 1.0) : 1;
  const double distance = three_digits(kApart * size * diagonal), radius = three_digits(kLineWidth * std::sqrt(size) * diagonal);
  const bool named = !colors.is_default(), plain = (facts.unit || facts.axes) && !named;
  FirstLook look;
  look.fibres = facts.unit;
  look.note = facts.unit   ? "looks like fibres: all vectors are as long"
              : facts.axes ? "looks like fibres: neighbours point to either side"
                           : "looks like a flow";
  NamedColors shown = colors;
  if (colors.map.empty() && !colors.range) shown.map = kQuantityMap;
  const std::array<double, 2> speeds{three_digits(facts.slow), three_digits(facts.fast)};
  if (!shown.range && is_color_range(speeds[0], speeds[1])) shown.range = speeds;

  // a line must begin somewhere, and be as long as lines are apart
  const double still = narrow ? three_digits(kStill * facts.fast) : 0;
  flow::EvenlySpaced spacing{distance, 0.5, facts.fastest, 1};
  flow::BatchOptions options;
  options.length = three_digits(kLineLength * diagonal);
  if (!(facts.fast > 0)) {
    look.note = "looks like a flow that stands still";
    look.parts = soft_background();
  } else if (flow::evenly_spaced({&grid, facts.axes, still}, spacing, options).empty()) {
    const Vec3 middle = grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi));
    look.parts = "  \"slices\": [";
    for (int axis = 0; axis < 3; ++axis)
      look.parts += std::string(axis > 0 ? ",\n             " : "") + "{\"field\": " + field + ", \"axis\": \"" + "xyz"[axis] +
                    "\", \"at\": " + text_of(middle[axis]) + color_members(shown) + "}";
    look.parts += "]" + bar_of("\"slice\": 0") + ",\n" + soft_background();
  } else {
    look.parts = "  \"streamlines\": [{\"field\": " + field;
    if (facts.axes) look.parts += ", \"kind\": \"line\"";
    if (still > 0) look.parts += ", \"min_speed\": " + text_of(still);
    look.parts += plain ? ", \"color\": " + text_of(kFibre) : ", \"color_by\": {\"quantity\": \"speed\"" + color_members(shown) + "}";
    look.parts += ", \"radius\": " + text_of(radius) + ", \"length\": " + text_of(options.length) +
                  ",\n                   \"seeds\": {\"evenly_spaced\": {\"distance\": " + text_of(distance) +
                  ",\n                                               \"start\": " + text_of(facts.fastest) + "}}}]";
    if (!plain) look.parts += bar_of("\"streamlines\": 0");
    look.parts += ",\n" + soft_background();
  }
  return look;
}

}  // namespace catena::scene
