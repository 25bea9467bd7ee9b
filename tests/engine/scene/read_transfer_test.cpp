// SPDX-License-Identifier: MIT
/// Colors and opacities of a scene: named maps, ranges, transfer files and ParaView's color maps.
#include <cmath>

#include "engine/scene/auto_transfer.h"
#include "engine/scene/color_maps.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::read_transfer_test {

class ReadTransfer : public InFolder {
 protected:
  /// A scene with one volume, whose keys begin on line 2; the transfer file in its folder is t.json.
  Result<Scene> volume(const std::string& keys) {
    return parse_scene(
        "{\"fields\": {\"ball\": {\"analytic\": \"sphere\", \"resolution\": 9}}, \"volumes\": [{\"field\": \"ball\",\n" + keys + "}]}",
        folder_ / "s.json");
  }
  TransferFunction transfer_of(const std::string& keys) { return only<Volume>(value_of(volume(keys))).transfer; }
  /// The transfer function of the volume from the file t.json.
  TransferFunction file_of(const std::string& text, const std::string& more = "") {
    test::write_file(folder_ / "t.json", text);
    return transfer_of("\"transfer\": \"t.json\"" + more);
  }
  void refused(const std::string& keys, const std::string& start, const std::vector<std::string>& parts) {
    expect_error(volume(keys), (folder_ / start) + ": ", parts);
  }
  void file_refused(const std::string& text, int line, const std::vector<std::string>& parts) {
    test::write_file(folder_ / "t.json", text);
    refused("\"transfer\": \"t.json\"", "t.json:" + std::to_string(line), parts);
  }
};

TEST_F(ReadTransfer, ReadsMapsByName) {
  TransferFunction transfer = transfer_of("\"color\": \"cividis_r\", \"range\": [-1, 2.5]");
  EXPECT_TRUE(transfer.colors.empty());
  EXPECT_EQ(transfer.named.map, "cividis_r");
  EXPECT_EQ(*transfer.named.range, (std::array<double, 2>{-1, 2.5}));
  EXPECT_FALSE(transfer_of("\"color\": \"grey\"").named.range);
  refused("\"color\": \"virdis\"", "s.json:2", {"not a colour map", "viridis, cividis", "did you mean \"viridis\"?"});
  refused("\"color\": 3", "s.json:2", {"expected"});
  refused("\"color\": \"grey\",\n\"range\": [1, 1]", "s.json:3", {"two rising numbers [lo, hi] were expected"});
  refused("\"color\": \"grey\", \"range\": [1, 2, 3]", "s.json:2", {"two rising numbers [lo, hi] were expected"});
  refused("\"color\": \"grey\", \"range\": [1, 1e39]", "s.json:2", {"0 or a number of magnitude 1e-30 to 1e30 was expected"});
  refused("\"color\": \"grey\", \"range\": [0, null]", "s.json:2", {"finite number was expected"});
  refused("\"color\": [[0, 0, 0, 0]],\n\"range\": [0, 1]", "s.json:3", {"beside a table", "expected"});
}

TEST_F(ReadTransfer, MappingsReadBackAndALogarithmNeedsPositiveValues) {
  const TransferFunction log = transfer_of("\"color\": \"grey\", \"range\": [0.01, 10], \"mapping\": \"log\"");
  EXPECT_EQ(log.named.mapping.kind, ValueMapping::Kind::log);
  const TransferFunction symlog = transfer_of("\"mapping\": \"symlog\", \"linear_below\": 0.5");
  EXPECT_EQ(symlog.named.mapping, (ValueMapping{ValueMapping::Kind::symlog, 0.5}));
  refused("\"mapping\": \"logarithm\"", "s.json:2", {"linear", "symlog", "expected"});
  refused("\"mapping\": \"log\",\n\"linear_below\": 1", "s.json:3", {"\"log\"", "\"symlog\" was expected"});
  refused("\"mapping\": \"symlog\", \"linear_below\": -1", "s.json:2", {"-1", "expected"});
  for (const char* what : {"\"color\": \"grey\", \"range\": [0, 1]", "\"extinction\": [[0, 1], [2, 3]]", "\"opacity\": [[-2, 0], [1, 0.5]]",
                           "\"color\": [[-1, 0, 0, 0], [1, 1, 1, 1]]"})
    refused(std::string(what) + ",\n\"mapping\": \"log\"", "s.json:3", {"\"log\"", "begins at", "values above 0", "symlog"});
  // The mapping of the file, the scene's override, and a range that places the points anew on the scale.
  const std::string file = R"({"mapping": "log", "extinction": [[0.1, 0], [1, 1], [100, 2]]})";
  EXPECT_EQ(file_of(file).named.mapping.kind, ValueMapping::Kind::log);
  EXPECT_EQ(file_of(file, ", \"mapping\": \"linear\"").named.mapping.kind, ValueMapping::Kind::linear);
  EXPECT_NEAR(file_of(file, ", \"range\": [1, 1000000]").extinctions.at(1).value, 100, 1e-9);
  EXPECT_NEAR(
      file_of(R"({"extinction": [[0, 0], [0.5, 1], [1, 2]]})", ", \"mapping\": \"log\", \"range\": [1, 100]").extinctions.at(1).value, 10,
      1e-9);
}

/// The automatic opacity follows the mapping; data with values of 0 and below are refused once they are loaded.
TEST_F(ReadTransfer, AutomaticOpacityFollowsTheMapping) {
  Scene scene = value_of(volume("\"color\": \"grey\", \"range\": [0.1, 10], \"mapping\": \"log\""));
  ASSERT_TRUE(resolve_rendered_field(scene, find_field(scene, "ball"), {}));
  const auto rows = only<Volume>(scene).transfer.extinctions;
  ASSERT_GT(rows.size(), 8u);
  EXPECT_NEAR(rows[rows.size() / 2].value, 1, 1e-6) << "halfway by the logarithm";
  scene = value_of(volume("\"color\": \"grey\",\n\"mapping\": \"log\""));
  expect_error(resolve_rendered_field(scene, find_field(scene, "ball"), {}), folder_ / "s.json:3: ", {"begins at"});
}

TEST_F(ReadTransfer, ReadsGradientOpacity) {
  const TransferFunction transfer = transfer_of("\"gradient_opacity\": [[0, 0], [2, 0.5], [4, 1]]");
  ASSERT_EQ(transfer.gradient_factors.size(), 3u);
  EXPECT_EQ(transfer.gradient_factors[1].gradient, 2);
  EXPECT_EQ(transfer.gradient_factors[1].factor, 0.5);
  refused("\"gradient_opacity\": [[-1, 0]]", "s.json:2", {"gradient -1", ">= 0 was expected"});
  refused("\"gradient_opacity\": [[0, 0],\n[1, 1.5]]", "s.json:3", {"factor 1.5", "from 0 to 1 was expected"});
  refused("\"gradient_opacity\": [[0, 0], [0, 1]]", "s.json:2", {"strictly rising"});
  refused("\"gradient_opacity\": []", "s.json:2", {"empty", "expected"});
}

TEST_F(ReadTransfer, ATransferFileHasTheKeysOfAVolume) {
  const TransferFunction transfer = file_of(
      R"({"color": [[0, 1, 0, 0], [2, 0, 0, 1]], "opacity": [[0, 0], [1, 0.5]], "opacity_unit": 0.25, "gradient_opacity": [[0, 0.5]]})");
  ASSERT_EQ(transfer.colors.size(), 2u);
  EXPECT_EQ(transfer.colors[1].color.b, 1);
  EXPECT_EQ(transfer.opacities.at(1).alpha, 0.5);
  EXPECT_EQ(transfer.opacity_unit, 0.25);
  EXPECT_EQ(transfer.gradient_factors.size(), 1u);
  EXPECT_EQ(transfer.file, folder_ / "t.json");
  // Keys in the scene override those of the file.
  const TransferFunction beside = transfer_of("\"transfer\": \"t.json\", \"opacity_unit\": 3, \"gradient_opacity\": [[0, 0], [1, 1]]");
  EXPECT_EQ(beside.opacity_unit, 3);
  EXPECT_EQ(beside.gradient_factors.size(), 2u);
  EXPECT_EQ(file_of(R"({"color": "inferno", "extinction": [[0, 3]]})").named.map, "inferno");
}

TEST_F(ReadTransfer, ARangeRescalesTheTablesOfAFile) {
  const std::string tables = R"({"color": [[0, 1, 0, 0], [1, 0, 1, 0], [4, 0, 0, 1]], "extinction": [[2, 0], [3, 7]]})";
  const TransferFunction transfer = file_of(tables, ", \"range\": [10, 12]");
  EXPECT_EQ(std::tuple(transfer.colors[0].value, transfer.colors[1].value, transfer.colors[2].value), std::tuple(10, 10.5, 12));
  EXPECT_EQ(transfer.extinctions[0].value, 11);
  EXPECT_EQ(transfer.extinctions[1].sigma, 7);
  const TransferFunction named = file_of(R"({"color": "grey", "range": [0, 1], "extinction": [[0.5, 2]]})", ", \"range\": [2, 6]");
  EXPECT_EQ(*named.named.range, (std::array<double, 2>{2, 6}));
  EXPECT_EQ(named.extinctions[0].value, 4);
  test::write_file(folder_ / "t.json", R"({"extinction": [[1, 2]]})");
  refused("\"transfer\": \"t.json\",\n\"range\": [0, 1]", "s.json:3", {"wider range was expected"});
}

TEST_F(ReadTransfer, ErrorsNameTheTransferFilesLine) {
  file_refused("{\"color\": [[0, 0, 0, 0],\n[0, 1, 1, 1]]}", 2, {"strictly rising"});
  file_refused("{\n\"colour\": \"grey\"}", 2, {"unknown key \"colour\"", "did you mean \"color\"?"});
  file_refused("{\n\"color\": \"gray\"}", 2, {"did you mean \"grey\"?"});
  file_refused("{\"transfer\": \"t.json\"}", 1, {"unknown key"});
  file_refused("{}", 1, {"empty", "was expected"});
  file_refused("3", 1, {"object {...} was expected"});
  file_refused("{\"color\": ", 1, {"JSON", "expected"});
  refused("\"transfer\": \"none.json\"", "s.json:2", {"does not exist", "expected"});
  refused("\"transfer\": \".\"", "s.json:2", {"is not a file", "expected"});
  refused("\"transfer\": 3", "s.json:2", {"expected"});
  refused("\"transfer\": \"t.json\",\n\"opacity\": [[0, 0]]", "s.json:3", {"both \"transfer\" and \"opacity\"", "expected"});
  test::write_file(folder_ / "t.json", R"({"color": "grey"})");
  refused("\"transfer\": \"t.json\",\n\"opacity_unit\": 2", "s.json:3", {"no \"opacity\"", "expected"});
}

TEST_F(ReadTransfer, ReadsParaViewsColourMaps) {
  const TransferFunction transfer = file_of(R"([{"Name": "bone", "ColorSpace": "RGB", "NanColor": [1, 0, 0], "Creator": "someone",
    "RGBPoints": [-100, 0, 0, 0, 300, 1, 0.5, 0.25], "Points": [-100, 0, 0.5, 0, 300, 1, 0.5, 0]}])");
  ASSERT_EQ(transfer.colors.size(), 2u);
  EXPECT_EQ(transfer.colors[0].value, -100);
  EXPECT_EQ(transfer.colors[1].color.g, 0.5f);
  ASSERT_EQ(transfer.opacities.size(), 2u);
  EXPECT_EQ(transfer.opacities[0].alpha, 0);
  EXPECT_EQ(transfer.opacities[1].alpha, 0.999);
  EXPECT_EQ(transfer.opacity_unit, 0) << "one voxel";
}

/// ParaView's "Cool to Warm": two saturated ends and grey between, which gives Moreland's table.
TEST_F(ReadTransfer, ParaViewsSpacesBecomeLinearPieces) {
  const auto map = [](const std::string& space, const std::string& points) {
    return "[{\"ColorSpace\": \"" + space + "\", \"RGBPoints\": [" + points + "]}]";
  };
  const auto colors = file_of(map("Diverging", "0, 0.2298, 0.2987, 0.7537, 1, 0.8654, 0.8654, 0.8654, 2, 0.7057, 0.0156, 0.1502")).colors;
  const auto table = make_color_map("cool-warm", 0, 2);
  ASSERT_GT(colors.size(), 60u);
  for (const ColorPoint& point : colors) {
    const auto near = std::min_element(table.begin(), table.end(), [&](const auto& a, const auto& b) {
      return std::fabs(a.value - point.value) < std::fabs(b.value - point.value);
    });
    EXPECT_NEAR(near->color.r, point.color.r, 0.006) << point.value;
    EXPECT_NEAR(near->color.g, point.color.g, 0.006) << point.value;
    EXPECT_NEAR(near->color.b, point.color.b, 0.006) << point.value;
  }
  const auto hues = file_of(map("HSV", "0, 1, 0, 0, 1, 0, 1, 0")).colors;
  EXPECT_EQ(hues.size(), 33u);
  EXPECT_NEAR(hues[16].color.r, 1, 1e-6);
  EXPECT_NEAR(hues[16].color.g, 1, 1e-6) << "through yellow";
  const auto lab = file_of(map("Lab", "0, 0, 0, 0, 1, 1, 1, 1")).colors;
  EXPECT_NEAR(lab[16].color.g, 0.4663, 2e-3) << "half the lightness";
}

/// The colors of vtkColorTransferFunction (9.1) between two points: out-of-range colors, and hues in both directions.
TEST_F(ReadTransfer, ParaViewsSpacesEqualVtks) {
  const auto expect_colors = [&](const std::string& keys, const std::array<Vec3, 3>& quarters) {
    const auto colors = file_of("[{" + keys + "}]").colors;
    ASSERT_EQ(colors.size(), 33u);
    for (std::size_t i = 0; i < 3; ++i) {
      const Color& c = colors[8 * (i + 1)].color;
      EXPECT_LT(norm(Vec3(c.r, c.g, c.b) - quarters[i]), 0.004) << keys << " at quarter " << i + 1;
    }
  };
  expect_colors("\"ColorSpace\": \"Diverging\", \"RGBPoints\": [0, 0.2, 0.3, 0.9, 1, 0.9, 0.8, 0.1]",
                {Vec3(0.4887, 0.6734, 1), Vec3(1, 1, 1), Vec3(1, 0.9211, 0.6334)});
  const std::string pink_to_yellow = "\"ColorSpace\": \"HSV\", \"RGBPoints\": [0, 0.9, 0, 0.45, 1, 0.9, 0.9, 0]";
  const std::array<Vec3, 3> long_way{Vec3(0.3375, 0, 0.9), Vec3(0, 0.675, 0.9), Vec3(0, 0.9, 0.1125)};
  const std::array<Vec3, 3> short_way{Vec3(0.9, 0, 0.1125), Vec3(0.9, 0.225, 0), Vec3(0.9, 0.5625, 0)};
  expect_colors(pink_to_yellow, long_way);
  expect_colors(pink_to_yellow + ", \"HSVWrap\": 0", long_way);
  expect_colors(pink_to_yellow + ", \"HSVWrap\": 1", short_way);
  expect_colors(pink_to_yellow + ", \"HSVWrap\": true", short_way);
  file_refused("[{\"RGBPoints\": [0, 0, 0, 0],\n\"ColorSpace\": \"HSV\",\n\"HSVWrap\": 2}]", 3, {"HSVWrap", "was expected"});
}

TEST_F(ReadTransfer, ErrorsInParaViewsMapsNameTheLine) {
  file_refused("[]", 1, {"0 colour maps", "array of one was expected"});
  file_refused("[{}, {}]", 1, {"2 colour maps"});
  file_refused("[{\"Name\": \"a\"}]", 1, {"RGBPoints", "expected"});
  file_refused("[{\n\"RGBPoints\": [0, 0, 0]}]", 2, {"four numbers for each point were expected"});
  file_refused("[{\"RGBPoints\": [0, 0, 0, 0,\n0, 1, 1, 1]}]", 2, {"strictly rising"});
  file_refused("[{\"RGBPoints\": [0, 0, 2, 0]}]", 1, {"colour components from 0 to 1"});
  file_refused("[{\"RGBPoints\": [0, 0, 0, 0],\n\"ColorSpace\": \"Step\"}]", 2, {"RGB, HSV, Lab or Diverging was expected"});
  file_refused("[{\"RGBPoints\": [0, 0, 0, 0],\n\"Points\": [0, 2, 0.5, 0]}]", 2, {"opacity 2", "from 0 to 1"});
  file_refused("[{\"RGBPoints\": [0, 0, 0, 0],\n\"Points\": [0, 0, 0.3, 0, 1, 1, 0.5, 0]}]", 2, {"bent", "was expected"});
}

TEST_F(ReadTransfer, ColorByOfStreamlinesHasTheSameKeys) {
  const auto lines = [&](const std::string& keys) {
    return parse_scene(
        "{\"fields\": {\"v\": {\"analytic\": \"circle\"}}, \"streamlines\": [{\"field\": \"v\", \"seeds\": [[1, 0, 0]],\n" + keys + "}]}",
        folder_ / "s.json");
  };
  const auto by = [&](const std::string& keys) {
    return *only<StreamlineSet>(value_of(lines("\"color_by\": {\"quantity\": \"speed\", " + keys + "}"))).color_by;
  };
  EXPECT_EQ(by("\"color\": \"plasma\"").named.map, "plasma");
  EXPECT_EQ((*by("\"range\": [0, 3]").named.range)[1], 3);
  test::write_file(folder_ / "t.json", R"({"color": [[0, 1, 0, 0], [2, 0, 0, 1]]})");
  EXPECT_EQ(by("\"transfer\": \"t.json\"").colors.size(), 2u);
  for (const char* keys : {"\"color\": \"plasma\"", "\"color\": [[0, 0, 0, 0]]"})
    expect_error(lines(keys), folder_ / "s.json:2: ", {"\"color_by\""});
  test::write_file(folder_ / "t.json", R"({"extinction": [[0, 1]]})");
  expect_error(lines("\"color_by\": {\"quantity\": \"speed\",\n\"transfer\": \"t.json\"}"), folder_ / "s.json:3: ", {"no colours"});
}

/// |x| on a cube of side 4 has values from 0 to 2 sqrt(3).
TEST_F(ReadTransfer, AMapCoversTheValuesOrTheRange) {
  const auto drawn = [&](const std::string& keys) {
    Scene scene = value_of(volume(keys));
    value_of(resolve_rendered_field(scene, find_field(scene, "ball"), {}));
    return only<Volume>(scene).transfer;
  };
  const TransferFunction all = drawn("\"color\": \"viridis\"");
  EXPECT_EQ(all.colors.front().value, 0);
  EXPECT_NEAR(all.colors.back().value, std::sqrt(12.0), 1e-6);
  EXPECT_FALSE(all.extinctions.empty());
  const TransferFunction part = drawn("\"color\": \"viridis\", \"range\": [1, 2]");
  EXPECT_EQ(part.colors.front().value, 1);
  EXPECT_EQ(part.colors.back().value, 2);
  EXPECT_EQ(part.extinctions.front().value, 1) << "the ramp of the opacity lies there too";
  EXPECT_EQ(part.extinctions.back().value, 2);
  const TransferFunction plain = drawn("\"range\": [1, 2]");
  EXPECT_EQ(plain.colors.size(), 6u) << "the default map";
  EXPECT_EQ(plain.colors.front().value, 1);
  const TransferFunction both = drawn("\"color\": \"grey\", \"extinction\": [[0, 2]]");
  EXPECT_EQ(both.extinctions.size(), 1u);
}

}  // namespace catena::scene::read_transfer_test
