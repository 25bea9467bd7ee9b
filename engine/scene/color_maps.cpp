// SPDX-License-Identifier: MIT
#include "engine/scene/color_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"
#include "engine/base/text.h"

namespace catena::scene {
namespace {

/// One entry of a published color map of 256 entries; the map is linear between anchors.
struct Anchor {
  int entry;
  std::uint32_t rgb;
};

constexpr Anchor kViridis[] = {{0, 0x440154},   {17, 0x481a6c},  {34, 0x472f7d},  {52, 0x404588},  {81, 0x32648e},  {120, 0x23898e},
                               {141, 0x1e9d89}, {153, 0x22a884}, {166, 0x2fb47c}, {179, 0x44bf70}, {192, 0x5ec962}, {209, 0x86d549},
                               {236, 0xcde11d}, {243, 0xdfe318}, {248, 0xece51b}, {253, 0xf8e621}, {255, 0xfde725}};
constexpr Anchor kCividis[] = {{0, 0x00224e},   {20, 0x003070},  {23, 0x013271},  {28, 0x123570},  {35, 0x203a6f},
                               {53, 0x38476c},  {85, 0x575d6d},  {134, 0x828079}, {167, 0xa29975}, {199, 0xc3b369},
                               {225, 0xdfca57}, {242, 0xf2da44}, {251, 0xfde334}, {254, 0xfee636}, {255, 0xfee838}};
constexpr Anchor kInferno[] = {{0, 0x000004},   {3, 0x010108},   {11, 0x060419},  {22, 0x120a32},  {31, 0x1f0c48},  {40, 0x2f0a5b},
                               {49, 0x3e0966},  {61, 0x520e6d},  {76, 0x6a176e},  {94, 0x87216b},  {117, 0xab2f5e}, {137, 0xc83f4b},
                               {155, 0xdf5337}, {175, 0xf1711f}, {193, 0xfa9008}, {199, 0xfb9b06}, {204, 0xfca50a}, {213, 0xfbb61a},
                               {225, 0xf8cd37}, {235, 0xf4e156}, {244, 0xf1f179}, {251, 0xf6fa96}, {255, 0xfcffa4}};
constexpr Anchor kMagma[] = {{0, 0x000004},   {5, 0x02020b},   {16, 0x0a0822},  {32, 0x1d1147},  {45, 0x311165},  {54, 0x400f74},
                             {66, 0x54137d},  {90, 0x792282},  {117, 0xa5317e}, {139, 0xc83e73}, {154, 0xdf4a68}, {167, 0xee5b5e},
                             {179, 0xf7705c}, {190, 0xfb8560}, {206, 0xfea36f}, {229, 0xfecd90}, {255, 0xfcfdbf}};
constexpr Anchor kPlasma[] = {{0, 0x0d0887},   {7, 0x20068f},   {26, 0x43039e},  {49, 0x6700a8},  {62, 0x7b02a8},
                              {73, 0x8b0aa5},  {92, 0xa51f99},  {124, 0xc8437b}, {161, 0xe76e5b}, {191, 0xf89441},
                              {216, 0xfeb82c}, {233, 0xfbd324}, {250, 0xf3f027}, {254, 0xf0f724}, {255, 0xf0f921}};
constexpr Anchor kTurbo[] = {
    {0, 0x30123b},   {7, 0x38276d},   {14, 0x3f3b97},  {22, 0x4451bf},  {29, 0x4664da},  {36, 0x4776ee},  {43, 0x4687fb},  {48, 0x4294ff},
    {54, 0x3aa3fc},  {61, 0x2eb4f2},  {72, 0x1ccdd8},  {79, 0x18dbc5},  {84, 0x19e3b9},  {90, 0x22ebaa},  {98, 0x38f491},  {110, 0x65fd69},
    {120, 0x8bff4b}, {126, 0x9ffd3f}, {132, 0xaffa37}, {140, 0xc3f134}, {150, 0xdbe236}, {160, 0xeecf3a}, {169, 0xf9bc39}, {178, 0xfea732},
    {188, 0xfd8a26}, {199, 0xf56918}, {210, 0xe84b0c}, {221, 0xd63506}, {233, 0xbc2002}, {246, 0x980e01}, {255, 0x7a0403}};
constexpr Anchor kHot[] = {{0, 0x0b0000}, {93, 0xff0000}, {190, 0xfffe00}, {199, 0xffff22}, {255, 0xffffff}};
constexpr Anchor kJet[] = {{0, 0x000080},   {28, 0x0000ff},  {32, 0x0000ff},  {86, 0x00d8ff},  {87, 0x00dcfe},
                           {89, 0x00e4f8},  {95, 0x13fce4},  {96, 0x16ffe1},  {163, 0xeeff09}, {166, 0xf8f500},
                           {168, 0xfeed00}, {177, 0xffcc00}, {227, 0xff1300}, {232, 0xe80000}, {255, 0x800000}};
constexpr Anchor kGrey[] = {{0, 0x000000}, {255, 0xffffff}};

/// Dusk blue over green to ivory: light enough on a black background, dark enough on a white one.
constexpr Color kDusk[] = {{0.16f, 0.24f, 0.52f}, {0.15f, 0.47f, 0.62f}, {0.33f, 0.66f, 0.58f},
                           {0.72f, 0.79f, 0.52f}, {0.95f, 0.80f, 0.55f}, {0.99f, 0.96f, 0.90f}};

constexpr int kCoolWarmSteps = 256;  // green decreases steeply at the warm end of the map

struct ColorMap {
  std::string_view name;
  std::vector<ColorPoint> points;  ///< values 0 to 1
};

std::vector<ColorPoint> from_anchors(std::span<const Anchor> anchors) {
  std::vector<ColorPoint> points;
  const auto component = [](std::uint32_t rgb, int shift) { return static_cast<float>((rgb >> shift) & 255u) / 255.0f; };
  for (const auto& [entry, rgb] : anchors) points.push_back({entry / 255.0, {component(rgb, 16), component(rgb, 8), component(rgb, 0)}});
  return points;
}

std::vector<ColorPoint> dusk() {
  std::vector<ColorPoint> points;
  for (const Color& rgb : kDusk) points.push_back({static_cast<double>(points.size()) / (std::size(kDusk) - 1), rgb});
  return points;
}

std::vector<ColorPoint> cool_warm() {
  const Vec3 cool = srgb_from_lab(lab_from_msh({80, 1.08, -1.1})), warm = srgb_from_lab(lab_from_msh({80, 1.08, 0.5}));
  std::vector<ColorPoint> points;
  for (int i = 0; i <= kCoolWarmSteps; ++i) {
    const double t = static_cast<double>(i) / kCoolWarmSteps;
    const Vec3 c = interpolate_colors(ColorSpace::diverging, cool, warm, t);
    points.push_back({t, {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)}});
  }
  return points;
}

const std::vector<ColorMap>& color_maps() {
  static const std::vector<ColorMap> maps = {{"viridis", from_anchors(kViridis)},
                                             {"cividis", from_anchors(kCividis)},
                                             {"inferno", from_anchors(kInferno)},
                                             {"magma", from_anchors(kMagma)},
                                             {"plasma", from_anchors(kPlasma)},
                                             {"cool-warm", cool_warm()},
                                             {"turbo", from_anchors(kTurbo)},
                                             {"hot", from_anchors(kHot)},
                                             {"jet", from_anchors(kJet)},
                                             {"grey", from_anchors(kGrey)},
                                             {"dusk", dusk()}};
  return maps;
}

const ColorMap* find_map(std::string_view name) {
  if (name.ends_with("_r")) name.remove_suffix(2);
  for (const ColorMap& map : color_maps())
    if (map.name == name) return &map;
  return nullptr;
}

Color mixed(const Color& a, const Color& b, float t) { return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)}; }

Color middle_of(const std::vector<ColorPoint>& points) {
  std::size_t i = 1;
  while (points[i].value < 0.5) ++i;
  return mixed(points[i - 1].color, points[i].color,
               static_cast<float>((0.5 - points[i - 1].value) / (points[i].value - points[i - 1].value)));
}

}  // namespace

const std::vector<std::string_view>& color_map_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const ColorMap& map : color_maps()) all.push_back(map.name);
    return all;
  }();
  return names;
}

bool is_color_map(std::string_view name) { return find_map(name) != nullptr; }

std::string_view color_map_warning(std::string_view name) {
  const ColorMap* map = find_map(name);
  if (map == nullptr || map->name != "jet") return {};
  return "jet misleads: its lightness rises and falls, which shows edges where the values have none; turbo has its colours without this";
}

std::string unknown_color_map_message(std::string_view name) {
  return in_quotes(name) + " is not a colour map; one of " + join_words(color_map_names()) +
         ", or one of these names with \"_r\", was expected" + suggestion(name, color_map_names());
}

std::vector<ColorPoint> make_color_map(std::string_view name, double lo, double hi, double linear_below) {
  const ColorMap* map = find_map(name);
  CATENA_ASSERT(map != nullptr && std::isfinite(lo) && std::isfinite(hi));
  if (!(lo < hi)) return {{lo, middle_of(map->points)}};
  std::vector<ColorPoint> points;
  const bool reversed = name.ends_with("_r");
  const std::size_t count = map->points.size();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const ColorPoint& point = map->points[reversed ? count - 1 - i : i];
    const double t = reversed ? 1 - point.value : point.value, value = symlog_interpolate(lo, hi, i == 0 ? 0 : t, linear_below);
    // neighboring values become equal if the range spans only a few floating-point numbers
    if (i == 0 || (value > points.back().value && value < hi)) points.push_back({value, point.color});
  }
  points.push_back({hi, map->points[reversed ? 0 : count - 1].color});
  return points;
}

bool is_color_range(double lo, double hi) {
  constexpr double maximum = std::numeric_limits<float>::max();
  return std::fabs(lo) <= maximum && std::fabs(hi) <= maximum && static_cast<float>(lo) < static_cast<float>(hi);
}

double linear_below(const ValueMapping& mapping, double lo, double hi) {
  constexpr double kShown = 1e-3;  // fraction of the largest magnitude
  if (mapping.kind == ValueMapping::Kind::linear) return 0;
  if (mapping.kind == ValueMapping::Kind::log) return std::max(lo, 0.0);
  return mapping.linear_below > 0 ? mapping.linear_below : kShown * std::max(std::fabs(lo), std::fabs(hi));
}

double linear_below(const TransferFunction& transfer) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  const auto extend_range = [&](const auto& points) {
    for (const auto& p : points) lo = std::min(lo, p.value), hi = std::max(hi, p.value);
  };
  extend_range(transfer.colors);
  extend_range(transfer.opacities);
  extend_range(transfer.extinctions);
  return lo <= hi ? linear_below(transfer.named.mapping, lo, hi) : 0;
}

std::string mapping_error(const ValueMapping& mapping, double lo, const std::string& what) {
  if (mapping.kind != ValueMapping::Kind::log || lo > 0) return {};
  return "\"mapping\" is \"log\", but " + what + " begins at " + to_text(lo) +
         "; values above 0 were expected, or \"symlog\", which allows 0 and both signs";
}

Outcome check_mapping(const json::Node& item, const ValueMapping& mapping, double lo) {
  const std::string problem = mapping_error(mapping, lo, "the range of the values");
  return problem.empty() ? Outcome(Done{})
                         : json::error_at(json::member_or_parent(item, "mapping"), problem + " (\"range\" sets another range)");
}

Outcome check_mapping(const ColorBy& by, double lo) {
  return by.colors.empty() && !by.named.range ? check_mapping(by.where, by.named.mapping, lo) : Outcome(Done{});
}

std::vector<ColorPoint> make_color_points(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                          std::string_view fallback) {
  if (!table.empty()) return table;
  const std::string_view name = named.map.empty() ? fallback : std::string_view(named.map);
  if (named.range) std::tie(lo, hi) = std::pair((*named.range)[0], (*named.range)[1]);
  if (!(lo <= hi)) lo = 0, hi = 1;
  return make_color_map(name, lo, hi, linear_below(named.mapping, lo, hi));
}

std::vector<ColorPoint> make_color_table(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                         std::string_view fallback) {
  constexpr double kOff = 1.0 / 2048;
  std::vector<ColorPoint> points = make_color_points(table, named, lo, hi, fallback);
  if (named.mapping.kind == ValueMapping::Kind::linear) return points;
  std::vector<std::array<double, 4>> rows;
  for (const ColorPoint& p : points) rows.push_back({p.value, p.color.r, p.color.g, p.color.b});
  points.clear();
  for (const auto& row : refine_for_symlog(rows, linear_below(named.mapping, rows.front()[0], rows.back()[0]), kOff))
    points.push_back({row[0], {static_cast<float>(row[1]), static_cast<float>(row[2]), static_cast<float>(row[3])}});
  return points;
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWhiteX = 0.9505, kWhiteZ = 1.089;  // D65 white point, Y = 1
constexpr double kUnsaturated = 0.05;                // Msh saturation s below which the hue is meaningless
constexpr double kMinWhite = 88;

double linear_of(double v) { return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92; }
double encoded(double v) { return v > 0.0031308 ? 1.055 * std::pow(v, 1 / 2.4) - 0.055 : 12.92 * v; }

double lab_curve(double v) { return v > 216.0 / 24389 ? std::cbrt(v) : (24389.0 / 27 * v + 16) / 116; }
double lab_curve_back(double v) { return v * v * v > 216.0 / 24389 ? v * v * v : (116 * v - 16) * 27 / 24389; }

/// Hue of a saturated color, turned as it approaches a white of Msh magnitude `white`.
double turned_hue(const Vec3& msh, double white) {
  if (msh.x >= white) return msh.z;
  const double spin = msh.y * std::sqrt(white * white - msh.x * msh.x) / (msh.x * std::sin(msh.y));
  return msh.z > -kPi / 3 ? msh.z + spin : msh.z - spin;
}

double angle_between(double a, double b) {
  const double d = std::fabs(std::remainder(a - b, 2 * kPi));
  return d;
}

Vec3 diverging(Vec3 a, Vec3 b, double t) {
  const bool distinct_hues = a.y > kUnsaturated && b.y > kUnsaturated && angle_between(a.z, b.z) > kPi / 3;
  if (distinct_hues) {
    const Vec3 white(std::max({a.x, b.x, kMinWhite}), 0.0, 0.0);
    (t < 0.5 ? b : a) = white;
    t = t < 0.5 ? 2 * t : 2 * t - 1;
  }
  if (a.y < kUnsaturated && b.y > kUnsaturated)
    a.z = turned_hue(b, a.x);
  else if (b.y < kUnsaturated && a.y > kUnsaturated)
    b.z = turned_hue(a, b.x);
  return (1 - t) * a + t * b;
}

Vec3 hsv_from_rgb(const Vec3& c) {
  const double maximum = std::max({c.x, c.y, c.z}), span = maximum - std::min({c.x, c.y, c.z});
  double hue = 0;
  if (span > 0) {
    if (maximum == c.x)
      hue = std::fmod((c.y - c.z) / span + 6, 6);
    else
      hue = maximum == c.y ? 2 + (c.z - c.x) / span : 4 + (c.x - c.y) / span;
  }
  return {hue / 6, maximum > 0 ? span / maximum : 0, maximum};
}

Vec3 rgb_from_hsv(const Vec3& c) {
  const auto component = [&](double n) {
    const double k = std::fmod(n + 6 * c.x, 6);
    return c.z * (1 - c.y * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return {component(5), component(3), component(1)};
}

Vec3 hsv_between(const Vec3& a, const Vec3& b, double t, bool wrap) {
  const double hue_difference = wrap ? std::remainder(b.x - a.x, 1.0) : b.x - a.x, hue = a.x + t * hue_difference;
  return {hue - std::floor(hue), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

}  // namespace

Vec3 lab_from_srgb(const Vec3& rgb) {
  const double r = linear_of(rgb.x), g = linear_of(rgb.y), b = linear_of(rgb.z);
  const double x = lab_curve((0.4124 * r + 0.3576 * g + 0.1805 * b) / kWhiteX), y = lab_curve(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = lab_curve((0.0193 * r + 0.1192 * g + 0.9505 * b) / kWhiteZ);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3 srgb_from_lab(const Vec3& lab) {
  const double fy = (lab.x + 16) / 116;
  const double x = kWhiteX * lab_curve_back(fy + lab.y / 500), y = lab_curve_back(fy), z = kWhiteZ * lab_curve_back(fy - lab.z / 200);
  const Vec3 rgb(encoded(3.2406 * x - 1.5372 * y - 0.4986 * z), encoded(-0.9689 * x + 1.8758 * y + 0.0415 * z),
                 encoded(0.0557 * x - 0.2040 * y + 1.0570 * z));
  const double maximum = std::max({rgb.x, rgb.y, rgb.z, 1.0});
  return {std::max(rgb.x, 0.0) / maximum, std::max(rgb.y, 0.0) / maximum, std::max(rgb.z, 0.0) / maximum};
}

Vec3 msh_from_lab(const Vec3& lab) {
  const double m = norm(lab);
  return {m, m > 1e-3 ? std::acos(std::clamp(lab.x / m, -1.0, 1.0)) : 0, m > 1e-3 ? std::atan2(lab.z, lab.y) : 0};
}

Vec3 lab_from_msh(const Vec3& msh) {
  return {msh.x * std::cos(msh.y), msh.x * std::sin(msh.y) * std::cos(msh.z), msh.x * std::sin(msh.y) * std::sin(msh.z)};
}

Vec3 interpolate_colors(ColorSpace space, const Vec3& a, const Vec3& b, double t) {
  switch (space) {
    case ColorSpace::rgb:
      return a + t * (b - a);
    case ColorSpace::hsv:
    case ColorSpace::hsv_wrap:
      return rgb_from_hsv(hsv_between(hsv_from_rgb(a), hsv_from_rgb(b), t, space == ColorSpace::hsv_wrap));
    case ColorSpace::lab:
      return srgb_from_lab((1 - t) * lab_from_srgb(a) + t * lab_from_srgb(b));
    case ColorSpace::diverging:
      return srgb_from_lab(lab_from_msh(diverging(msh_from_lab(lab_from_srgb(a)), msh_from_lab(lab_from_srgb(b)), t)));
  }
  return a;
}

}  // namespace catena::scene
