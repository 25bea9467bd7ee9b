// SPDX-License-Identifier: MIT
/// DICOM files, written element by element, against the values and positions in their headers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "engine/io/volume/units.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/dicom_files.h"

namespace catena::field::dicom_test {

using namespace test::vtk_files;

using Words = std::vector<std::uint16_t>;

class DicomFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    test::write_file(folder_ / name, bytes);
  }
  Result<AnyField> open(const std::string& name, const std::string& grid = {}) {
    auto field = load(test::request_for(folder_ / name, grid));
    notes_ = field ? fmt::format("{}", fmt::join(field->notes, "\n")) : field.error().message;
    return field;
  }
  /// Values at positions along z, at the first pixel; NaN outside.
  std::vector<double> along_z(const std::string& name, const std::vector<double>& zs, const std::string& grid = {}) {
    const auto field = open(name, grid);
    std::vector<double> values;
    if (!field) return values;
    for (const double z : zs) {
      const ScalarSample sample = test::sample_at(*field, {0, 0, z});
      values.push_back(sample.inside ? std::round(1e4 * sample.value) / 1e4 : NAN);
    }
    return values;
  }
  std::string error(const std::string& name) { return open(name) ? "loaded" : notes_; }
  bool noted(const std::string& words) const { return notes_.find(words) != std::string::npos; }

  test::TemporaryFolder folder_;
  std::string notes_;
};

/// The pixels of frames: six pixels of each value.
Words frames_of(const Words& values) {
  Words pixels;
  for (const std::uint16_t v : values) pixels.insert(pixels.end(), 6, v);
  return pixels;
}

Dicom enhanced(const std::vector<double>& zs, const Words& values, const std::vector<double>& slopes) {
  Dicom d = dicom_image(frames_of(values)).without(kPosition).without(kOrientation).without(kPixelSpacing);
  std::vector<Dicom> groups;
  for (std::size_t n = 0; n < zs.size(); ++n)
    groups.push_back(Dicom()
                         .sequence(0x00209113, {Dicom().decimals(kPosition, {0, 0, zs[n]})})
                         .sequence(0x00289145, {Dicom().decimals(kSlope, {slopes[n]}).decimals(kIntercept, {10})}));
  const Dicom shared = Dicom()
                           .sequence(0x00209116, {Dicom().decimals(kOrientation, {1, 0, 0, 0, 1, 0})})
                           .sequence(0x00289110, {Dicom().decimals(kPixelSpacing, {0.5, 0.25})});
  return d.decimals(kFrames, {double(zs.size())}, "IS").sequence(0x52009229, {shared}).sequence(0x52009230, groups);
}

Dicom dose(const std::vector<double>& offsets, double z) {
  Dicom d = dicom_image(frames_of({100, 400, 200, 900}), {0, 0, z}).text(kModality, "CS", "RTDOSE").text(0x30040002, "CS", "GY");
  return d.decimals(kFrames, {4}, "IS").decimals(0x3004000c, offsets).decimals(0x3004000e, {0.001});
}

TEST_F(DicomFiles, FramesHaveThePositionsOfTheHeader) {
  const Dicom frames = dicom_image(frames_of({10, 20, 40}), {0, 0, 5}).decimals(kFrames, {3}, "IS");
  Dicom nuclear = Dicom(frames).without(kPosition).without(kOrientation).text(kModality, "CS", "NM").words(0x00540080, {3, 1, 2});
  nuclear.decimals(0x00180088, {-4})
      .sequence(0x00540022, {Dicom().decimals(kPosition, {0, 0, 9}).decimals(kOrientation, {1, 0, 0, 0, 1, 0})});
  struct Case {
    const char* name;
    std::string bytes;
    std::vector<double> at, values;
  };
  for (const Case& c : {
           Case{"dose.dcm", dose({0, 2, 4, 7}, 5).file(), {5, 7, 9, 12}, {0.1, 0.4, 0.2, 0.9}},
           Case{"dose z.dcm", dose({5, 7, 9, 12}, 5).file(), {5, 7, 9, 12}, {0.1, 0.4, 0.2, 0.9}},
           Case{"dose down.dcm", dose({0, -2, -4, -7}, 5).file(), {5, 3, 1, -2}, {0.1, 0.4, 0.2, 0.9}},
           Case{"order.dcm", enhanced({4, 0, 2}, {1, 2, 3}, {1, 0.5, 3}).file(), {0, 2, 4}, {11, 19, 11}},
           Case{"uneven.dcm", enhanced({0, 2, 3.5}, {1, 2, 3}, {1, 1, 1}).file(), {0, 2, 3.5}, {11, 12, 13}},
           Case{"steps.dcm", Dicom(frames).decimals(0x00180088, {3}).file(), {5, 8, 11}, {10, 20, 40}},
           Case{"nuclear.dcm", nuclear.file(), {1, 5, 9}, {10, 40, 20}},
           Case{"big.dcm", enhanced({4, 0, 2}, {300, 2, 3}, {1, 0.5, 3}).file(true), {0, 2, 4}, {11, 19, 310}},
       }) {
    write(c.name, c.bytes);
    EXPECT_EQ(along_z(c.name, c.at), c.values) << c.name << ": " << notes_;
  }
  EXPECT_EQ(read_units(folder_ / "dose.dcm", "dose").value, "Gy");
  // A compressed frame of a dose grid whose offsets are those of several frames: a segment for each byte, six times 400 = 0x0190.
  const std::string row = std::string("\xfb\0", 2), segments = row + row + "\xfb\x01" + "\xfb\x90";
  Words rle{4, 0, 64, 0, 66, 0, 68, 0, 70, 0};
  rle.resize(32);
  for (std::size_t n = 0; n < segments.size(); n += 2)
    rle.push_back(static_cast<std::uint16_t>(static_cast<unsigned char>(segments[n]) | static_cast<unsigned char>(segments[n + 1]) << 8));
  const Dicom one = dose({0, 2, 4, 7}, 5).without(kFrames).words(0x00280100, {32}).words(0x00280101, {32}).words(0x00280102, {31});
  write("rle.dcm", Dicom(one).text(0x00280009, "CS", std::string("\x04\x30\x0c\0", 4)).rle(rle).file());
  EXPECT_EQ(along_z("rle.dcm", {5}), (std::vector<double>{0.4})) << notes_;
  // A missing distance is not invented.
  for (const auto& [name, bytes, words] :
       {std::tuple{"none.dcm", frames.file(), "has no distance between the 3 frames"},
        {"time.dcm", Dicom(frames).words(0x00280009, {0x18, 0x1063}).decimals(0x00180088, {3}).file(), "are a time series"},
        {"offsets.dcm", dose({1, 2, 4, 7}, 5).file(), "GridFrameOffsetVector begins with 1"}}) {
    write(name, bytes);
    EXPECT_TRUE(test::has(error(name), words)) << notes_;
  }
}

TEST_F(DicomFiles, ValuesAreScaledByTheHeader) {
  const Dicom lut = Dicom().words(0x00283002, {3, 0xffff, 16}).words(0x00283006, {7, 70, 700});
  const auto ct = [](const Words& pixels) { return dicom_image(pixels).decimals(kSlope, {2}).decimals(kIntercept, {-1000}); };
  struct Case {
    const char* name;
    Dicom file;
    double first, second;  // values of the first two pixels
    const char* note;
  };
  const Words minus{0x0fff, 5, 0, 0, 0, 0};  // -1 in 12 bits
  for (const Case& c : {
           Case{"inverse", ct({21, 22, 0, 0, 0, 0}).text(0x00280004, "CS", "MONOCHROME1").words(0x00280101, {12}).words(0x00280102, {11}),
                -958, -956, "MONOCHROME1"},
           Case{"signed", ct(minus).words(0x00280101, {12}).words(0x00280102, {11}).words(0x00280103, {1}), -1002, -990, ""},
           Case{"shifted", ct({0xfff0, 0x50, 0, 0, 0, 0}).words(0x00280101, {12}).words(0x00280103, {1}), -1002, -990, ""},
           Case{"overlay", ct({0xf015, 0x16, 0, 0, 0, 0}).words(0x00280101, {12}).words(0x00280102, {11}), -958, -956, ""},
           Case{"padding", ct({21, 22, 63536, 0, 0, 0}).words(0x00280103, {1}).numbers<std::int16_t>(0x00280120, "SS", {-2000}), -958, NAN,
                "1 pixels with the PixelPaddingValue"},
           Case{"table", dicom_image({0xffff, 1, 0, 0, 0, 0}).words(0x00280103, {1}).sequence(0x00283000, {lut}), 7, 700, ""},
           Case{"mapped",
                dicom_image({21, 22, 0, 0, 0, 0})
                    .sequence(0x00409096, {Dicom().numbers<double>(0x00409224, "FD", {1}).numbers<double>(0x00409225, "FD", {0.5})}),
                11.5, 12, "real world value mapping"},
           Case{"float", dicom_image({}).without(kPixels).numbers<float>(0x7fe00008, "OF", {1.5f, -2.5f, 0, 0, 0, 0}), 1.5, -2.5, ""},
           Case{"bytes", dicom_image({0x0403, 0, 0}).words(0x00280100, {8}).words(0x00280101, {8}).words(0x00280102, {7}), 3, 4, ""},
           Case{"bits", dicom_image({0x0002}).words(0x00280100, {1}).words(0x00280101, {1}).words(0x00280102, {0}), 0, 1, ""},
       }) {
    write(c.name + std::string(".dcm"), c.file.file());
    const auto field = open(c.name + std::string(".dcm"));
    ASSERT_TRUE(field) << c.name << ": " << notes_;
    EXPECT_EQ(test::sample_at(*field, Vec3(0.0)).value, c.first) << c.name;
    const ScalarSample second = test::sample_at(*field, {std::isnan(c.second) ? -0.5 : -0.25, 0, 0});
    EXPECT_TRUE(std::isnan(c.second) ? !second.inside : second.value == c.second) << c.name << ": " << second.value;
    EXPECT_TRUE(noted(c.note)) << c.name << ": " << notes_;
  }
  // Refused files, and files with a note.
  const std::string plain = dicom_image({1, 2, 3, 4, 5, 6}).file();
  const std::size_t syntax = plain.find(std::string("\x02\0\x10\0UI", 6));
  write("meta.dcm", std::string(plain).replace(syntax, 4, std::string("\x02\0\x12\0", 4)));
  EXPECT_TRUE(test::has(error("meta.dcm"), "damaged files: meta.dcm (the header has no transfer syntax)")) << notes_;
  for (const auto& [name, bytes, words] :
       {std::tuple{"short.dcm", dicom_image({1, 2, 3}).file(), "truncated"},
        {"colours.dcm", dicom_image({1, 2, 3, 4, 5, 6, 7, 8, 9}).words(0x00280002, {3}).text(0x00280004, "CS", "RGB").file(),
         "colour image (\"RGB\")"},
        {"mosaic.dcm", dicom_image({1, 2, 3, 4, 5, 6}).text(0x00080008, "CS", "ORIGINAL\\MOSAIC").file(), "mosaic"},
        {"axes.dcm", dicom_image({1, 2, 3, 4, 5, 6}).decimals(kOrientation, {1, 0, 0, 1, 0, 0}).file(), "two orthogonal unit vectors"}}) {
    write(name, bytes);
    EXPECT_TRUE(test::has(error(name), words)) << name << ": " << notes_;
  }
}

TEST_F(DicomFiles, EachSliceHasItsOwnRescalingAndPosition) {
  for (int k = 0; k < 4; ++k) {
    Dicom d = dicom_image(frames_of({100}), {0, 0.5 * k, 2.0 * k}, 9 - k).decimals(kSlope, {1.0 + k}).text(kModality, "CS", "PT");
    write(fmt::format("pet/{}", k), d.text(0x00541001, "CS", "BQML").file());
  }
  write("pet/notes.txt", "nothing of DICOM");
  write("pet/cut", dicom_image({1, 2, 3, 4, 5, 6}).file().substr(0, 180));
  write("pet/plan", dicom_image({}).without(0x00280010).without(kPixels).text(kModality, "CS", "RTSTRUCT").file());
  const auto field = open("pet");
  ASSERT_TRUE(field) << notes_;
  for (int k = 0; k < 4; ++k)  // a sheared stack: slices are shifted along y
    EXPECT_EQ(test::sample_at(*field, {0, -0.5 * k, 2.0 * k}).value, 100 * (1 + k));
  EXPECT_TRUE(noted("not images were left out: 1 RTSTRUCT") && noted("damaged files were left out: cut")) << notes_;
  EXPECT_EQ(read_units(folder_ / "pet", "").value, "Bq/mL");
}

TEST_F(DicomFiles, ASeriesWithSeveralStacksIsSeveralGrids) {
  const auto slice = [](int number, double z, std::uint16_t value) { return dicom_image(frames_of({value}), {0, 0, z}, number); };
  for (int k = 0; k < 4; ++k) write(fmt::format("two/a{}", k), slice(k + 2, 2.0 * k, static_cast<std::uint16_t>(10 + k)).file());
  write("two/localizer", slice(1, 3, 77).decimals(kOrientation, {1, 0, 0, 0, 0, -1}).file());
  EXPECT_EQ(along_z("two", {0, 2, 4, 6}), (std::vector<double>{10, 11, 12, 13}));
  EXPECT_TRUE(noted("the largest of 2 volumes is shown, 1.1 \"Chest 1.2.3\" (4 images)")) << notes_;
  for (const char* grid : {"1.2", "Chest 1.2.3, coronal"}) EXPECT_EQ(along_z("two", {3}, grid), (std::vector<double>{77})) << notes_;
  // Two acquisitions with two echoes each.
  for (int n = 0; n < 16; ++n) {
    Dicom d = slice(n, 2.0 * (n % 4), static_cast<std::uint16_t>(100 + n)).decimals(0x00200012, {1.0 + n / 8}, "IS");
    write(fmt::format("four/{}", n), d.decimals(0x00180081, {n / 4 % 2 == 0 ? 20.0 : 3.5}).file());
  }
  const auto grids = test::value_of(describe_grids(folder_ / "four"));
  ASSERT_EQ(grids.size(), 4u);
  EXPECT_EQ(grids[3].name, "Chest 1.2.3, acquisition 2, echo time 20 ms");
  EXPECT_EQ(grids[3].series_number, "1.4");
  EXPECT_EQ(grids[3].image_count, 4);
  EXPECT_EQ(along_z("four", {0, 6}, "1.4"), (std::vector<double>{108, 111})) << notes_;
  EXPECT_EQ(along_z("four", {0, 6}, "Chest 1.2.3, acquisition 1, echo time 3.5 ms"), (std::vector<double>{104, 107})) << notes_;
  EXPECT_FALSE(open("four", "5"));
  EXPECT_TRUE(noted("there is no grid \"5\", expected one of: 1.1 \"Chest")) << notes_;
  // Series with explicit numbers.
  for (int k = 0; k < 3; ++k) write(fmt::format("many/a{}", k), slice(k, k, 1).decimals(0x00200011, {7}, "IS").file());
  for (int k = 0; k < 2; ++k)
    write(fmt::format("many/b{}", k), dicom_image(frames_of({2}), {0, 0, 1.0 * k}, k, "1.2.4").decimals(0x00200011, {3}, "IS").file());
  EXPECT_EQ(along_z("many", {0}), (std::vector<double>{1}));
  EXPECT_EQ(along_z("many", {0}, "3"), (std::vector<double>{2}));
  EXPECT_EQ(read_units(folder_ / "many", "3").value, "HU");
}

TEST_F(DicomFiles, InterleavedAcquisitionsAreMergedOrSeparated) {
  const auto write_two = [&](const std::string& name, double offset) {
    for (int n = 0; n < 8; ++n) {
      const double z = 2.0 * (n / 2) + (n % 2) * offset;
      Dicom d = dicom_image(frames_of({static_cast<std::uint16_t>(100 + 100 * (n % 2) + n / 2)}), {0, 0, z}, n);
      write(fmt::format("{}/{}", name, n), d.decimals(0x00200012, {1.0 + n % 2}, "IS").file());
    }
  };
  write_two("even", 1);
  EXPECT_EQ(along_z("even", {0, 1, 2, 3}), (std::vector<double>{100, 200, 101, 201})) << notes_;
  EXPECT_TRUE(noted("from 2 interleaved acquisitions (AcquisitionNumber)")) << notes_;
  write_two("uneven", 0.7);
  EXPECT_EQ(along_z("uneven", {0, 2, 4, 6}, "Chest 1.2.3, acquisition 1"), (std::vector<double>{100, 101, 102, 103})) << notes_;
  EXPECT_EQ(along_z("uneven", {0.7, 2.7, 4.7}, "Chest 1.2.3, acquisition 2"), (std::vector<double>{200, 201, 202})) << notes_;
}

TEST_F(DicomFiles, NamesOverrideNumbersAndASharedNumberIsRefused) {
  // Series, SeriesNumber and description; the pixels of a series have its index in this list, from 1.
  struct Series {
    const char *uid, *number, *words;
    int images;
  };
  const auto write_all = [&](const std::string& name, const std::vector<Series>& all) {
    std::uint16_t value = 0;
    for (const Series& one : all) {
      ++value;
      for (int k = 0; k < one.images; ++k) {
        Dicom d = dicom_image(frames_of({value}), {0, 0, 1.0 * k}, k, one.uid).text(0x0008103e, "LO", one.words);
        write(fmt::format("{}/{}-{}", name, one.uid, k), d.text(0x00200011, "IS", one.number).file());
      }
    }
  };
  write_all("shared", {{"1.5.1", "7", "Thorax", 4}, {"1.5.2", "3", "Lung", 3}, {"1.5.3", "03", "Lung", 2}});
  write_all("names", {{"1.6.1", "1", "2", 2}, {"1.6.2", "2", "1", 2}, {"1.6.3", "", "Scout", 2}, {"1.6.4", "4", "Long", 3}});
  write_all("none", {{"1.7.1", "", "A", 3}, {"1.7.2", "", "B", 2}});
  struct Case {
    const char *folder, *grid;
    double value;  // 0: refused
    const char* words;
  };
  for (const Case& c : {
           Case{"shared", "7", 1, ""},
           Case{"shared", "Thorax", 1, ""},
           Case{"shared", "3.1", 2, ""},
           Case{"shared", "3.2", 3, ""},
           Case{"shared", "Lung_2", 3, ""},
           Case{"shared", "Lung", 2, "matches several series: 3.1 \"Lung\" (3 images), 3.2 \"Lung_2\" (2 images)"},
           Case{"shared", "3", 0, "several series have the number \"3\", expected one of: 3.1 \"Lung\" (3 images), 3.2 \"Lung_2\""},
           Case{"shared", "1", 0, "there is no grid \"1\""},
           Case{"shared", "2", 0, "there is no grid \"2\""},
           Case{"names", "1", 2, "\"1\" is read as a name, and matches several series: 1.1 \"2\" (2 images), 2.1 \"1\""},
           Case{"names", "2", 1, "matches several series"},
           Case{"names", "1.1", 1, ""},
           Case{"names", "4", 4, ""},
           Case{"names", "3", 0, "there is no grid \"3\", expected one of: \"Scout\" (2 images), 1.1 \"2\""},
           Case{"none", "2", 2, ""},
       }) {
    const auto values = along_z(c.folder, {0}, c.grid);
    EXPECT_EQ(values, c.value == 0 ? std::vector<double>{} : std::vector<double>{c.value}) << c.folder << " " << c.grid << ": " << notes_;
    EXPECT_TRUE(noted(c.words)) << c.folder << " " << c.grid << ": " << notes_;
    EXPECT_TRUE(*c.words != 0 || !noted("several series")) << c.folder << " " << c.grid << ": " << notes_;
  }
}

TEST_F(DicomFiles, ResamplingMatchesEverySliceAndKeepsGaps) {
  const auto stack = [&](const std::string& name, const std::vector<double>& zs) {
    std::vector<double> wanted;
    for (std::size_t k = 0; k < zs.size(); ++k) {
      const auto value = static_cast<std::uint16_t>(1000 + (k % 2 == 0 ? 0 : 900) + k);
      write(fmt::format("{}/{}", name, k), dicom_image(frames_of({value}), {0, 0, zs[k]}, static_cast<int>(k)).file());
      wanted.push_back(value);
    }
    return wanted;
  };
  // Irregular slices without a common step: the small difference has a note.
  const std::string irregular = "at the original slices the values differ by up to 0.";
  for (const auto& [name, zs, words] : {
           std::tuple{"tenths", std::vector<double>{0, 3, 7.3, 9.1}, std::string("to 92 at equal distances of 0.1 mm")},
           {"hundredths", {0, 2, 4.37, 7.11, 9.03}, "at equal distances of 0.01 mm"},
           {"thirds", {0, 2.5, 5, 5.8333333, 9.1666667}, "to 12 at equal distances of 0.8333 mm"},
           {"head", {0, 2.5, 5, 7.5, 17.5, 27.5, 37.5}, "to 16 at equal distances of 2.5 mm"},
           {"single", {0, 2, 4, 10}, "a gap of 6 mm beside a single slice is filled"},
           {"irregular", {0, 1, std::sqrt(6.0), std::sqrt(14.0), 5, std::sqrt(40.0)}, irregular},
       }) {
    const auto wanted = stack(name, zs);
    const auto found = along_z(name, zs);
    ASSERT_EQ(found.size(), wanted.size()) << name << ": " << notes_;
    for (std::size_t k = 0; k < wanted.size(); ++k)
      EXPECT_NEAR(found[k], wanted[k], words == irregular ? 0.01 * 905 : 1e-3) << name << " " << k << ": " << notes_;
    EXPECT_TRUE(noted(words)) << notes_;
    EXPECT_FALSE(words != irregular && (noted("differ by") || noted("no values"))) << notes_;
  }
  // Between two separate stacks there is no value.
  const std::vector<double> two{0, 2.5, 5, 52.5, 55, 57.5};
  const auto ends = stack("two", two);
  auto just_inside = two;
  just_inside[2] -= 1e-9;  // on the face itself, the cell of the gap begins
  EXPECT_EQ(along_z("two", just_inside), ends) << notes_;
  EXPECT_TRUE(noted("a gap of 47.5 mm has no values")) << notes_;
  for (const double outside : along_z("two", {6, 30, 52})) EXPECT_TRUE(std::isnan(outside)) << outside;
}

TEST_F(DicomFiles, InconsistentStacksAreRefused) {
  const auto write_all = [&](const std::string& name, const std::function<void(int, Dicom&)>& change) {
    for (int k = 0; k < 5; ++k) {
      Dicom d = dicom_image(frames_of({static_cast<std::uint16_t>(k)}), {0, 0, 2.0 * k}, k);
      change(k, d);
      write(fmt::format("{}/{}", name, k), d.file());
    }
  };
  struct Case {
    const char *name, *words;
    std::function<void(int, Dicom&)> change;
  };
  for (const Case& c : {
           Case{"pixels", "2 has pixels of 0.3 x 0.5 mm, expected 0.25 x 0.5",
                [](int k, Dicom&d) {
                  if (k == 2) d.decimals(kPixelSpacing, {0.5, 0.3});
                }},
           Case{"size", "2 has 6 x 1 pixels, expected 3 x 2",
                [](int k, Dicom&d) {
                  if (k == 2) d.words(0x00280010, {1}).words(0x00280011, {6});
                }},
           Case{"spacing", "have no PixelSpacing", [](int, Dicom&d) { d.without(kPixelSpacing); }},
           Case{"places", "have no ImagePositionPatient", [](int, Dicom&d) { d.without(kPosition); }},
           Case{"shifted", "shifted sideways",
                [](int k, Dicom&d) {
                  d.decimals(kPosition, {k % 2 * 3.0, 0, 2.0 * k});
                }},
       }) {
    write_all(c.name, c.change);
    EXPECT_TRUE(test::has(error(c.name), c.words)) << c.name << ": " << notes_;
  }
  write_all("gap", [](int k, Dicom& d) {
    if (k > 2) d.decimals(kPosition, {0, 0, 2.0 * k + 2});
  });
  EXPECT_EQ(along_z("gap", {0, 4, 8, 10}), (std::vector<double>{0, 2, 3, 4})) << notes_;
  EXPECT_TRUE(noted("slices are 2 to 4 mm apart: 5 slices were resampled to 6")) << notes_;
}

}  // namespace catena::field::dicom_test
