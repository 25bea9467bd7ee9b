// SPDX-License-Identifier: MIT
#include "engine/scene/classify_scalar.h"

#include <filesystem>

#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::classify_scalar_test {

constexpr int kSize = 48;

/// Repeatable noise from -1 to 1.
double noise(int i) {
  auto x = static_cast<std::uint32_t>(i) * 2654435761u;
  x ^= x >> 15;
  x *= 2246822519u;
  x ^= x >> 13;
  return x / 2147483648.0 - 1;
}

/// The grid of value(p, n), with p from -1 to 1 and n the index of the voxel.
template <class Value>
std::shared_ptr<const field::ScalarGrid> grid_of(const Value& value, double edge = 1) {
  std::vector<float> values;
  int n = 0;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) values.push_back(static_cast<float>(value((2.0 / (kSize - 1)) * Vec3(x, y, z) - Vec3(1.0), n++)));
  return field::make_scalar_grid("g", field::Mapping::from_linear(Mat3(edge), Vec3(0.0)), {kSize, kSize, kSize}, values);
}

DataKind kind(const std::shared_ptr<const field::ScalarGrid>& grid, const field::Units& units = {}) {
  return classify_scalar(compute_scalar_stats(*grid, units));
}

const field::Units kPatient{"", "mm", true, false};

double head(const Vec3& p, int n, double air, double tissue, double bone) {
  const double r = norm(p);
  return (r > 0.9 ? air : r > 0.7 ? bone : tissue) + 0.03 * (tissue - air) * noise(n);
}

TEST(DataClassification, CtIsRecognizedByItsScaleOrUnit) {
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int n) { return head(p, n, -1000, 40, 900); })), DataKind::ct);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int n) { return head(p, n, 0, 40, 900); }), {"HU", "", false, false}), DataKind::ct);
  EXPECT_NE(kind(grid_of([](const Vec3& p, int n) { return head(p, n, -100, 4, 90); })), DataKind::ct);
}

TEST(DataClassification, OnlyScansInPatientCoordinatesAreMr) {
  const auto scan = grid_of([](const Vec3& p, int n) { return std::max(0.0, head(p, n, 0, 100, 60)); });
  EXPECT_EQ(kind(scan, kPatient), DataKind::mr);
  EXPECT_NE(kind(scan), DataKind::mr);
}

TEST(DataClassification, LabelMapsAreIntegersWithEqualNeighbours) {
  const auto label = [](const Vec3& p) { return norm(p) > 0.9 ? 0 : 1 + int(3 * (p.x + 1)) + 10 * int(3 * (p.y + 1)); };
  EXPECT_EQ(kind(grid_of([&](const Vec3& p, int) { return label(p); }), kPatient), DataKind::label_map);
  // Regions of one voxel's thickness are label regions; random integers are not, however few values there are.
  const auto sheets = [](const Vec3&, int n) { return n / (kSize * kSize) == 20 ? 3 : n / kSize % kSize == 30 ? 5 : 0; };
  EXPECT_EQ(kind(grid_of(sheets)), DataKind::label_map);
  for (const int max_value : {2, 4, 9})
    EXPECT_NE(kind(grid_of([&](const Vec3&, int n) { return std::floor(max_value * (0.5 + 0.499 * noise(n))); })), DataKind::label_map)
        << max_value;
  // Integers alone do not make a label map: an 8-bit scan.
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int n) { return std::round(std::max(0.0, head(p, n, 0, 100, 60))); }), kPatient), DataKind::mr);
}

TEST(DataClassification, AngiogramsHaveFewBrightRoughVoxels) {
  const auto vessel = [](const Vec3& p, int n) {
    const double d = std::hypot(p.y - 0.4 * std::sin(3 * p.x), p.z);
    return 100 + 20 * noise(n) + (d < 0.06 ? 500 : 0);
  };
  EXPECT_EQ(kind(grid_of(vessel)), DataKind::angiogram);
  EXPECT_EQ(kind(grid_of(vessel), kPatient), DataKind::angiogram);
  // Small and bright but smooth data are no vessels, even on a coarse grid.
  const auto coarse = *field::make_analytic("gaussian");
  EXPECT_EQ(kind(field::sample_on_grid(*coarse.scalar, 24, -2, 2)), DataKind::simulation);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return std::exp(-30 * dot(p, p)); })), DataKind::simulation);
}

TEST(DataClassification, LevelSetsHaveUnitSlopeAndBothSigns) {
  const double edge = 2.0 / (kSize - 1);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return norm(p) - 0.6; }, edge)), DataKind::level_set);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return norm(p); }, edge)), DataKind::simulation);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return 2 * (norm(p) - 0.6); }, edge)), DataKind::simulation);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return dot(p, p); }), {"", "", false, true}), DataKind::level_set)
      << "the file declares it";
}

TEST(DataClassification, SolidsCloudsAndSimulations) {
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return 1 / (1 + std::exp(60 * (norm(p) - 0.6))); })), DataKind::solid);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return std::max(0.0, 0.5 - norm(p)) * (1.5 + std::sin(9 * p.x)); })), DataKind::cloud);
  EXPECT_EQ(kind(grid_of([](const Vec3& p, int) { return std::sin(3 * p.x) + p.y * p.z; })), DataKind::simulation);
  EXPECT_EQ(kind(grid_of([](const Vec3&, int) { return 7; })), DataKind::simulation) << "one value";
}

TEST(DataClassification, StatisticsDecadesAndTwoPhases) {
  const auto wave = [](const Vec3& p, int) { return norm(p) > 0.9 ? 0 : 3 * std::sin(5 * p.x) * std::cos(4 * p.y + p.z); };
  EXPECT_EQ(kind(grid_of(wave), kPatient), DataKind::statistic);
  EXPECT_NE(kind(grid_of(wave)), DataKind::statistic) << "no patient";
  EXPECT_NE(kind(grid_of([&](const Vec3& p, int n) { return std::fabs(wave(p, n)); }), kPatient), DataKind::statistic) << "one sign";
  const auto tail = [](const Vec3& p, int n) { return std::exp(2 * std::sin(7 * p.x + p.z) * std::cos(8 * p.y) + 1.5 * noise(n)); };
  EXPECT_EQ(kind(grid_of(tail)), DataKind::decades);
  EXPECT_EQ(kind(grid_of([&](const Vec3& p, int n) { return 30 + tail(p, n); })), DataKind::simulation) << "within a power of ten";
  const auto rock = [](const Vec3& p, int n) {
    return (std::sin(7 * p.x) + std::sin(8 * p.y) + std::sin(6 * p.z) > 0 ? 200 : 100) + 50 * noise(n);
  };
  EXPECT_EQ(kind(grid_of(rock)), DataKind::two_phases);
  EXPECT_EQ(kind(grid_of([](const Vec3&, int n) { return 50 * noise(n); })), DataKind::simulation) << "noise alone";
}

TEST(DataClassification, ExplainsTheKind) {
  const ScalarStats facts = compute_scalar_stats(*grid_of([](const Vec3& p, int n) { return head(p, n, -1000, 40, 900); }), {});
  const std::string reason = explain_kind(classify_scalar(facts), facts);
  EXPECT_NE(reason.find(" % of the values are near -1000 (air)"), std::string::npos) << reason;
  EXPECT_GT(facts.air_share, 0.3);
  EXPECT_GT(facts.threshold, -1000);
  EXPECT_LT(facts.threshold, 900);
}

// The thresholds were tuned on other files: ch2, ch2bet, aal, JHU-WhiteMatter-labels-1mm, brodmann, cranium_ct, combustor_cfd,
// weather_uvt.
TEST(DataClassification, RealFilesBeyondTheTuningSet) {
  int seen = 0;
  const auto look = [&](const std::string& path, const std::string& grid, DataKind expected) {
    if (path.empty() || !std::filesystem::exists(path)) return;
    field::LoadRequest request;
    request.path = path;
    request.grid = grid;
    const auto any = field::load(request);
    ASSERT_TRUE(any) << any.error().message;
    const ScalarStats facts = compute_scalar_stats(*any->scalar->grid(), field::read_units(path, grid));
    EXPECT_EQ(classify_scalar(facts), expected)
        << path << ": " << to_string(classify_scalar(facts)) << ", " << explain_kind(classify_scalar(facts), facts);
    ++seen;
  };
  const std::string templates = "/usr/share/mricron/templates/";
  for (const char* name : {"ch2better", "inia19-t1-brain"}) look(templates + name + ".nii.gz", "", DataKind::mr);
  for (const char* name :
       {"AICHAmc", "HarvardOxford-cort-maxprob-thr0-1mm", "JHU-WhiteMatter-labels-2mm", "jhu189", "natbrainlab", "inia19-NeuroMaps"})
    look(templates + name + ".nii.gz", "", DataKind::label_map);
  look(test::shared_data("colin27_brain_mr.vdb"), "density", DataKind::mr);
  look(test::shared_data("carotid_flow.vdb"), "density", DataKind::angiogram);
  look(test::shared_data("ideal_lv_fibres.vdb"), "transmural", DataKind::simulation);
  look(test::shared_data("synth_abc.vdb"), "speed", DataKind::simulation);
  look(test::shared_data("synth_helix.vdb"), "density", DataKind::simulation);
  if (seen == 0) GTEST_SKIP() << "no such files";
}

}  // namespace catena::scene::classify_scalar_test
