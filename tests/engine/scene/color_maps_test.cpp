// SPDX-License-Identifier: MIT
#include "engine/scene/color_maps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::scene::color_maps_test {

struct Published {
  int at;
  double r, g, b;
};

/// The color of a table at `value`, by definition: linear between neighbors.
Vec3 at(const std::vector<ColorPoint>& table, double value) {
  for (std::size_t i = 1; i < table.size(); ++i)
    if (value <= table[i].value) {
      const auto& [u, a] = table[i - 1];
      const auto& [v, b] = table[i];
      const double t = (value - u) / (v - u);
      return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
    }
  return {table.back().color.r, table.back().color.g, table.back().color.b};
}

double off(const std::vector<ColorPoint>& table, double value, const Published& p) {
  const Vec3 d = at(table, value) - Vec3(p.r, p.g, p.b);
  return std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
}

/// Entries of the published tables of 256 colors (matplotlib's _cm_listed.py).
TEST(ColorMaps, EqualThePublishedTables) {
  const std::vector<Published> viridis{
      {0, 0.267004, 0.004874, 0.329415},   {30, 0.280255, 0.165693, 0.476498},  {77, 0.204903, 0.375746, 0.553533},
      {108, 0.154815, 0.493313, 0.557840}, {128, 0.127568, 0.566949, 0.550556}, {165, 0.180653, 0.701402, 0.488189},
      {203, 0.468053, 0.818921, 0.323998}, {226, 0.699415, 0.867117, 0.175971}, {255, 0.993248, 0.906157, 0.143936}};
  const std::vector<Published> cividis{
      {0, 0.000000, 0.135112, 0.304751},   {30, 0.087465, 0.214879, 0.437342},  {77, 0.313287, 0.343120, 0.425120},
      {108, 0.421748, 0.428531, 0.446640}, {128, 0.488697, 0.485318, 0.471008}, {165, 0.628576, 0.595104, 0.459641},
      {203, 0.781795, 0.717074, 0.401966}, {226, 0.879378, 0.796687, 0.336241}, {255, 0.995737, 0.909344, 0.217772}};
  const std::vector<Published> inferno{
      {0, 0.001462, 0.000466, 0.013866},   {30, 0.116656, 0.047574, 0.272321},  {77, 0.422549, 0.092501, 0.432714},
      {108, 0.615513, 0.161817, 0.391219}, {128, 0.735683, 0.215906, 0.330245}, {165, 0.912966, 0.381636, 0.169755},
      {203, 0.987337, 0.637890, 0.034916}, {226, 0.971468, 0.813122, 0.227658}, {255, 0.988362, 0.998364, 0.644924}};
  const std::vector<Published> magma{
      {0, 0.001462, 0.000466, 0.013866},   {30, 0.102815, 0.063010, 0.257854},  {77, 0.396467, 0.102902, 0.502658},
      {108, 0.588158, 0.173652, 0.502035}, {128, 0.716387, 0.214982, 0.475290}, {165, 0.925937, 0.346844, 0.374959},
      {203, 0.994309, 0.616999, 0.422950}, {226, 0.996571, 0.783977, 0.547233}, {255, 0.987053, 0.991438, 0.749504}};
  const std::vector<Published> plasma{
      {0, 0.050383, 0.029803, 0.527975},   {30, 0.287076, 0.010855, 0.627295},  {77, 0.568201, 0.055778, 0.639477},
      {108, 0.719181, 0.191729, 0.542663}, {128, 0.798216, 0.280197, 0.469538}, {165, 0.915471, 0.448807, 0.342890},
      {203, 0.987332, 0.646633, 0.214648}, {226, 0.991897, 0.784239, 0.151042}, {255, 0.940015, 0.975158, 0.131326}};
  const std::vector<Published> turbo{
      {0, 0.189950, 0.071760, 0.232170},   {30, 0.275090, 0.400720, 0.866920},  {77, 0.095320, 0.844550, 0.792990},
      {108, 0.365810, 0.987020, 0.436880}, {128, 0.643620, 0.989990, 0.233560}, {165, 0.960490, 0.771810, 0.228110},
      {203, 0.945380, 0.366380, 0.074610}, {226, 0.799710, 0.170550, 0.015200}, {255, 0.479600, 0.015830, 0.010550}},
      hot{{0, 0.041600, 0.000000, 0.000000},   {30, 0.350445, 0.000000, 0.000000},  {77, 0.834303, 0.000000, 0.000000},
          {108, 1.000000, 0.153432, 0.000000}, {128, 1.000000, 0.359314, 0.000000}, {165, 1.000000, 0.740196, 0.000000},
          {203, 1.000000, 1.000000, 0.197058}, {226, 1.000000, 1.000000, 0.552205}, {255, 1.000000, 1.000000, 1.000000}},
      jet{{0, 0.000000, 0.000000, 0.500000},   {30, 0.000000, 0.000000, 1.000000},  {77, 0.000000, 0.707843, 1.000000},
          {108, 0.237192, 1.000000, 0.730550}, {128, 0.490196, 1.000000, 0.477546}, {165, 0.958254, 0.973856, 0.009488},
          {203, 1.000000, 0.421932, 0.000000}, {226, 1.000000, 0.087872, 0.000000}, {255, 0.500000, 0.000000, 0.000000}};
  for (const auto& [name, entries] : {std::pair{"turbo", &turbo},
                                      {"hot", &hot},
                                      {"jet", &jet},
                                      {"viridis", &viridis},
                                      {"cividis", &cividis},
                                      {"inferno", &inferno},
                                      {"magma", &magma},
                                      {"plasma", &plasma}})
    for (const Published& entry : *entries)
      EXPECT_LE(off(make_color_map(name, 0, 255), entry.at, entry), 1 / 255.0) << name << " " << entry.at;
}

/// Eight of the 33 points of Moreland's table, CoolWarmFloat33.csv.
TEST(ColorMaps, CoolWarmEqualsMorelandsTable) {
  const Published points[] = {{0, 0.229806, 0.298718, 0.753683},  {5, 0.424370, 0.558148, 0.945620},  {11, 0.681291, 0.788965, 0.990363},
                              {16, 0.865395, 0.865410, 0.865396}, {21, 0.967328, 0.734133, 0.628752}, {27, 0.899046, 0.439559, 0.343230},
                              {31, 0.752535, 0.157246, 0.184115}, {32, 0.705673, 0.015556, 0.150233}};
  for (const Published& point : points) EXPECT_LE(off(make_color_map("cool-warm", 0, 32), point.at, point), 0.3 / 255) << point.at;
}

TEST(ColorMaps, CoverTheRangeFromTheMinimumToTheMaximum) {
  for (const std::string_view name : color_map_names())
    for (const auto& [lo, hi] : {std::pair{0.0, 1.0}, std::pair{-1024.0, 2986.0}, std::pair{1.0, std::nextafter(1.0, 2.0)},
                                 std::pair{1.0, 1 + 1e-14}, std::pair{-3e38, 3e38}, std::pair{0.0, 1e-45}}) {
      const auto table = make_color_map(name, lo, hi), back = make_color_map(std::string(name) + "_r", lo, hi);
      EXPECT_EQ(table.front().value, lo);
      EXPECT_EQ(table.back().value, hi);
      for (std::size_t i = 1; i < table.size(); ++i) ASSERT_GT(table[i].value, table[i - 1].value) << name << " " << lo << " " << hi;
      // A reversed map has swapped ends.
      EXPECT_EQ(back.front().color.r, table.back().color.r);
      EXPECT_EQ(back.back().color.b, table.front().color.b);
      for (const ColorPoint& point : table)
        for (const float c : {point.color.r, point.color.g, point.color.b}) EXPECT_TRUE(c >= 0 && c <= 1);
    }
}

TEST(ColorMaps, ReversedIsTheMirrorImage) {
  for (const std::string_view name : color_map_names()) {
    const auto table = make_color_map(name, 2, 4), back = make_color_map(std::string(name) + "_r", 2, 4);
    for (double v = 2; v <= 4; v += 0.037) EXPECT_LT(norm(at(table, v) - at(back, 6 - v)), 1e-6) << name << " " << v;
  }
}

TEST(ColorMaps, OneValueHasTheMiddleColour) {
  const auto table = make_color_map("viridis", 7, 7);
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].value, 7);
  EXPECT_NEAR(table[0].color.g, 0.5669, 2 / 255.0);
}

TEST(ColorMaps, UnknownNamesAreRefusedWithASuggestion) {
  EXPECT_TRUE(is_color_map("cividis") && is_color_map("cool-warm_r"));
  for (const char* name : {"", "_r", "Viridis", "viridis_r_r", "rainbow"}) EXPECT_FALSE(is_color_map(name)) << name;
  EXPECT_NE(unknown_color_map_message("virdis").find("did you mean \"viridis\"?"), std::string::npos);
}

TEST(ColorMaps, ATableOverridesAName) {
  const std::vector<ColorPoint> table = {{5, {1, 0, 0}}};
  EXPECT_EQ(make_color_table(table, {"grey", {}}, 0, 1).size(), 1u);
  EXPECT_EQ(make_color_table({}, {"grey", {}}, 2, 3).front().value, 2);
  EXPECT_EQ(make_color_table({}, {"grey", {{-1, 1}}}, 2, 3).front().value, -1);
  EXPECT_EQ(make_color_table({}, {}, 3, 2).back().value, 1) << "no values at all: 0 to 1";
}

/// Colors at values by closed forms: the decades of a logarithm have equal lengths; symlog is odd, and linear about 0.
TEST(ColorMaps, FollowTheValueMapping) {
  using Kind = ValueMapping::Kind;
  const auto grey_at = [](const std::vector<ColorPoint>& table, double value) { return at(table, value).x; };
  const NamedColors log{"grey", {{0.001, 1000}}, {Kind::log, 0}}, symlog{"grey", {{-100, 100}}, {Kind::symlog, 1}};
  const auto decades = make_color_table({}, log, 0, 0), both = make_color_table({}, symlog, 0, 0);
  for (int power = -3; power <= 3; ++power) EXPECT_NEAR(grey_at(decades, std::pow(10.0, power)), (power + 3) / 6.0, 1e-3) << power;
  EXPECT_NEAR(grey_at(decades, std::sqrt(10.0)), 3.5 / 6, 1e-3) << "between the points, too";
  const double far = 1 + std::log(100.0);
  for (const auto& [value, place] :
       {std::pair{-100.0, -far}, {-10.0, -1 - std::log(10.0)}, {-0.5, -0.5}, {0.0, 0.0}, {1.0, 1.0}, {100.0, far}})
    EXPECT_NEAR(grey_at(both, value), 0.5 + 0.5 * place / far, 1e-3) << value;
  // The same for a table of values; without linear_below, a thousandth of the maximum magnitude.
  const std::vector<ColorPoint> rows{{0.01, {0, 0, 0}}, {100, {1, 0, 0}}};
  EXPECT_NEAR(grey_at(make_color_table(rows, {"", {}, {Kind::log, 0}}, 0, 0), 1), 0.5, 1e-3);
  EXPECT_EQ(linear_below({Kind::symlog, 0}, -7, 2), 7e-3);
  EXPECT_FALSE(mapping_error({Kind::log, 0}, 0, "x").empty());
  EXPECT_TRUE(mapping_error({Kind::symlog, 0}, 0, "x").empty());
}

TEST(ColorSpaces, LabAndMshOfKnownColoursAreRight) {
  const Vec3 white = lab_from_srgb({1, 1, 1}), red = lab_from_srgb({1, 0, 0});
  EXPECT_LT(norm(white - Vec3(100, 0, 0)), 0.02);
  EXPECT_LT(norm(red - Vec3(53.24, 80.09, 67.20)), 0.05);
  for (const Vec3& c : {Vec3(0.2, 0.5, 0.9), Vec3(0, 0, 0), Vec3(0.01, 0.99, 0.4), Vec3(1, 1, 1)}) {
    EXPECT_LT(norm(srgb_from_lab(lab_from_srgb(c)) - c), 1e-3);
    EXPECT_LT(norm(lab_from_msh(msh_from_lab(lab_from_srgb(c))) - lab_from_srgb(c)), 1e-9);
  }
}

TEST(ColorSpaces, HsvTakesTheShorterHuePathOnlyWithWrapping) {
  // From red to blue through magenta, or through green without wrapping around red.
  EXPECT_LT(norm(interpolate_colors(ColorSpace::hsv_wrap, {1, 0, 0}, {0, 0, 1}, 0.5) - Vec3(1, 0, 1)), 1e-12);
  EXPECT_LT(norm(interpolate_colors(ColorSpace::hsv, {1, 0, 0}, {0, 0, 1}, 0.5) - Vec3(0, 1, 0)), 1e-12);
  EXPECT_LT(norm(interpolate_colors(ColorSpace::hsv, {1, 0, 0}, {0, 1, 0}, 0.5) - Vec3(1, 1, 0)), 1e-12);
  for (const ColorSpace space : {ColorSpace::rgb, ColorSpace::hsv, ColorSpace::hsv_wrap, ColorSpace::lab, ColorSpace::diverging})
    for (const double t : {0.0, 1.0})
      EXPECT_LT(norm(interpolate_colors(space, {0.1, 0.8, 0.3}, {0.9, 0.2, 0.4}, t) - (t == 0 ? Vec3(0.1, 0.8, 0.3) : Vec3(0.9, 0.2, 0.4))),
                1e-3);
}

}  // namespace catena::scene::color_maps_test
