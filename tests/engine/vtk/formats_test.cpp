/// Files of other programs, written here byte by byte as their formats say, against the numbers and places that went in.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "engine/curves/load.h"
#include "engine/curves/points.h"
#include "engine/field/load.h"
#include "engine/field/units.h"
#include "engine/mesh/load.h"
#include "engine/scene/scene.h"
#include "tests/engine/vtk/files.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/support.h"

namespace catena::field {
namespace formats_test {

using test::TemporaryFolder;
namespace files = test::vtk_files;

AnyField read(const std::string& path, const std::string& grid = {}) {
  LoadRequest request;
  request.path = path;
  request.grid = grid;
  auto field = load(request);
  EXPECT_TRUE(field) << (field ? "" : field.error().message);
  return field ? std::move(*field) : AnyField{};
}

std::string error_of(const std::string& path, const std::string& grid = {}) {
  LoadRequest request;
  request.path = path;
  request.grid = grid;
  const auto field = load(request);
  return field ? "loaded" : field.error().message;
}

double value_at(const AnyField& field, const Vec3& world) {
  Cursor cursor;
  const ScalarSample sample = field.scalar->sample(world, cursor);
  EXPECT_TRUE(sample.inside);
  return sample.value;
}

bool has_note(const AnyField& field, const std::string& words) {
  for (const std::string& note : field.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

/// v = 1 + 2 x + 3 y + 5 z, which trilinear interpolation repeats.
double linear(const Vec3& p) { return 1 + 2 * p.x + 3 * p.y + 5 * p.z; }

class Formats : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) {
    test::write_file(folder_ / name, bytes);
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

TEST_F(Formats, AnImageOfVtkLiesAsItsAxesSay) {
  // a quarter turn about z: index x runs along world y
  const AnyField field = read(file("turned.vti", files::vti("0 -1 0 1 0 0 0 0 1", linear)));
  const Mapping& m = field.get()->mapping();
  EXPECT_EQ(m.world_from_index(Vec3(0.0)), Vec3(10, 20, 30));
  EXPECT_NEAR(norm(m.world_from_index(Vec3(1, 0, 0)) - Vec3(10, 20.5, 30)), 0, 1e-15);
  EXPECT_NEAR(norm(m.world_from_index(Vec3(0, 1, 0)) - Vec3(9, 20, 30)), 0, 1e-15);
  EXPECT_NEAR(value_at(field, m.world_from_index(Vec3(1.25, 2.5, 0.75))), linear({1.25, 2.5, 0.75}), 1e-5);
}

TEST_F(Formats, ValuesOfCellsSitInTheirMiddles) {
  const AnyField field = read(file("cells.vti", files::vti_cells()));
  EXPECT_EQ(field.get()->mapping().origin, Vec3(0.5, 1, 1.5));
  EXPECT_TRUE(has_note(field, "belongs to cells"));
  EXPECT_DOUBLE_EQ(value_at(field, {0.5, 1, 1.5}), 0);
  EXPECT_DOUBLE_EQ(value_at(field, {1.5, 1, 1.5}), 1);
  EXPECT_DOUBLE_EQ(value_at(field, {0.5, 3, 1.5}), 3);
}

TEST_F(Formats, HiddenPointsAreNoData) {
  const AnyField field = read(file("ghost.vti", files::vti_hidden()));
  Cursor cursor;
  EXPECT_TRUE(field.scalar->sample({2.5, 0.5, 0.5}, cursor).inside);
  EXPECT_FALSE(field.scalar->sample({0.5, 0.5, 0.5}, cursor).inside);
}

TEST_F(Formats, ALegacyFileHoldsVectorsAndUnits) {
  const AnyField field = read(file("old.vtk", files::legacy_vectors()), "wind");
  Cursor cursor;
  const VectorSample sample = field.vector->sample({0.5, 0.5, 0.5}, cursor);
  ASSERT_TRUE(sample.inside);
  EXPECT_NEAR(norm(sample.value - Vec3(0.5, -0.5, 2)), 0, 1e-6);
  EXPECT_NE(error_of(folder_ / "old.vtk", "rain").find("there is no grid \"rain\", the file has: heat, wind"), std::string::npos);
}

TEST_F(Formats, ACurvilinearGridIsResampledWithinOnePercent) {
  // half a ring; a field that no lattice repeats
  const auto wave = [](const Vec3& p) { return std::sin(3 * p.x) * std::cos(2 * p.y) + p.z; };
  const AnyField field = read(file("ring.vts", files::vts_ring(24, 60, 10, wave)));
  EXPECT_TRUE(has_note(field, "cells resampled to"));
  test::Random random{7};
  Cursor cursor;
  std::vector<double> errors;
  int lost = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto unit = [&] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
    const double r = 0.55 + 0.9 * unit(), angle = std::numbers::pi * (0.02 + 0.96 * unit()), z = unit();
    const Vec3 p(r * std::cos(angle), r * std::sin(angle), z);
    const ScalarSample sample = field.scalar->sample(p, cursor);
    if (!sample.inside)
      ++lost;
    else
      errors.push_back(std::fabs(sample.value - wave(p)));
  }
  ASSERT_LT(lost, 4);
  std::sort(errors.begin(), errors.end());
  const double range = 3;  // sin cos from -1 to 1, z from 0 to 1
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.012 * range);
  // beyond a voxel of the ring there is nothing
  EXPECT_FALSE(field.scalar->sample({0, 0, 0.5}, cursor).inside);
  EXPECT_FALSE(field.scalar->sample({0, -0.3, 0.5}, cursor).inside);
}

TEST_F(Formats, UnstructuredCellsRepeatALinearField) {
  const AnyField field = read(file("mixed.vtu", files::vtu_mixed(linear)), "v");
  // in the hexahedron, in the tetrahedron on its side
  EXPECT_NEAR(value_at(field, {0.3, 0.6, 0.2}), linear({0.3, 0.6, 0.2}), 2e-4);
  EXPECT_NEAR(value_at(field, {1.2, 0.3, 0.3}), linear({1.2, 0.3, 0.3}), 2e-4);
  const AnyField cells = read(folder_ / "mixed.vtu", "c");
  EXPECT_TRUE(has_note(cells, "averaged at the points"));
}

TEST_F(Formats, OfAMeshPointsAndCellsAreCountedAndOfAnImageVoxels) {
  const auto mixed = describe(file("mixed.vtu", files::vtu_mixed(linear)));
  ASSERT_TRUE(mixed) << mixed.error().message;
  ASSERT_EQ(mixed->size(), 2u);
  EXPECT_EQ(mixed->at(0).name, "v");
  EXPECT_EQ(mixed->at(0).counted, Counted::points);
  EXPECT_EQ(mixed->at(1).name, "c");
  EXPECT_EQ(mixed->at(1).counted, Counted::cells);
  EXPECT_EQ(mixed->at(1).stats.active_voxels, 2u) << "a hexahedron and a tetrahedron";
  const auto image = describe(file("a.vti", files::vti("1 0 0 0 1 0 0 0 1", linear)));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->at(0).counted, Counted::voxels);
}

TEST_F(Formats, EveryPlaceOfACellOfSecondOrderHasItsValue) {
  const auto square = [](const Vec3& p) { return p.x * p.x + 0.5 * p.y * p.y - p.z; };
  const AnyField field = read(file("q.vtu", files::vtu_quadratic(square)));
  test::Random random{3};
  const auto unit = [&] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p(unit(), unit(), unit());
    EXPECT_NEAR(value_at(field, p), square(p), 0.02 * 2.5) << p.x << " " << p.y << " " << p.z;
  }
}

TEST_F(Formats, ValuesThatJumpBetweenCellsDoNotTakeAllVoxels) {
  // hexahedra in a row that share faces, but not their points: 0 and 1 in turn
  constexpr int kCells = 60;
  std::string points, values, corners, offsets, types;
  for (int cell = 0; cell < kCells; ++cell) {
    for (const Vec3& p :
         {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1)}) {
      points += fmt::format("{} {} {} ", p.x + cell, p.y, p.z);
      values += fmt::format("{} ", cell % 2);
    }
    for (int i = 0; i < 8; ++i) corners += fmt::format("{} ", 8 * cell + i);
    offsets += fmt::format("{}{}", cell > 0 ? " " : "", 8 * (cell + 1));
    types += "12 ";
  }
  const AnyField field = read(file("jump.vtu", files::vtu_of(8 * kCells, points, values, corners, offsets, types)));
  EXPECT_TRUE(has_note(field, "finer voxels do not help")) << field.notes.front();
  EXPECT_LT(field.scalar->grid()->stats().active_voxels, 2'000'000u);
}

TEST_F(Formats, VectorsTurnWithTheirAxes) {
  Cursor cursor;
  const auto vector = [&](const std::string& name, const std::string& bytes) {
    const AnyField field = read(file(name, bytes));
    return field.vector->sample(field.get()->mapping().world_from_index(Vec3(0.5)), cursor).value;
  };
  EXPECT_EQ(vector("lps.nrrd", files::nrrd_vectors("left-posterior-superior")), Vec3(-1, -2, 3));
  EXPECT_EQ(vector("ras.nrrd", files::nrrd_vectors("right-anterior-superior")), Vec3(1, 2, 3));
  EXPECT_EQ(vector("las.nrrd", files::nrrd_vectors("left-anterior-superior")), Vec3(-1, 2, 3));
  // columns of the frame: what x, y and z of the numbers mean
  EXPECT_EQ(vector("frame.nrrd", files::nrrd_vectors("right-anterior-superior", "measurement frame: (0,1,0) (0,0,1) (1,0,0)\n")),
            Vec3(3, 1, 2));
  const AnyField las = read(folder_ / "las.nrrd");
  EXPECT_NEAR(norm(las.get()->mapping().world_from_index(Vec3(1, 1, 1)) - Vec3(-12, 23, 34)), 0, 1e-12);
}

TEST_F(Formats, NumPyArraysAreIndexedZyx) {
  // a[k, j, i] = 100 k + 10 j + i
  for (const bool fortran : {false, true})
    for (const char* type : {"<f8", ">f4", "<i2"}) {
      const AnyField field =
          read(file("a.npy", files::npy({2, 3, 4}, type, fortran, [](int k, int j, int i) { return 100 * k + 10 * j + i; })));
      EXPECT_DOUBLE_EQ(value_at(field, {3, 2, 1}), 123) << type << fortran;
      EXPECT_NEAR(value_at(field, {0.5, 1, 0.25}), 35.5, 1e-4);
    }
  LoadRequest request;
  request.path = folder_ / "a.npy";
  request.axes_xyz = true;
  request.spacing = Vec3(0.5, 1, 2);
  request.origin = Vec3(7, 0, 0);
  const auto field = load(request);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_DOUBLE_EQ(value_at(*field, {7.5, 2, 6}), 123);
}

TEST_F(Formats, NrrdAndMetaImageAreTurnedIntoAPatientsAxes) {
  // left, posterior, superior: x and y change their signs
  const AnyField nrrd = read(file("head.nrrd", files::nrrd("left-posterior-superior")));
  EXPECT_NEAR(norm(nrrd.get()->mapping().world_from_index(Vec3(1, 1, 1)) - Vec3(-(10 + 2), -(20 + 3), 30 + 4)), 0, 1e-12);
  EXPECT_TRUE(units_of(folder_ / "head.nrrd", "head").patient);
  const AnyField ras = read(file("ras.nrrd", files::nrrd("right-anterior-superior")));
  EXPECT_NEAR(norm(ras.get()->mapping().world_from_index(Vec3(1, 1, 1)) - Vec3(12, 23, 34)), 0, 1e-12);
  const AnyField plain = read(file("plain.nrrd", files::nrrd("3D-right-handed")));
  EXPECT_NEAR(norm(plain.get()->mapping().world_from_index(Vec3(1, 1, 1)) - Vec3(12, 23, 34)), 0, 1e-12);
  EXPECT_FALSE(units_of(folder_ / "plain.nrrd", "plain").patient);
  const AnyField meta = read(file("m.mha", files::mha("RAI")));
  EXPECT_NEAR(norm(meta.get()->mapping().world_from_index(Vec3(1, 0, 0)) - Vec3(-12, -20, 30)), 0, 1e-12);
  const AnyField unknown = read(file("u.mha", files::mha("???")));
  EXPECT_NEAR(norm(unknown.get()->mapping().world_from_index(Vec3(1, 0, 0)) - Vec3(12, 20, 30)), 0, 1e-12);
  for (const AnyField* field : {&nrrd, &ras, &plain, &meta, &unknown})
    EXPECT_DOUBLE_EQ(value_at(*field, field->get()->mapping().world_from_index(Vec3(1, 1, 1))), 7);
}

TEST_F(Formats, ADicomFolderIsOneVolumeInHounsfieldUnits) {
  // out of order, and with a gap twice as wide at the end: x to the left and y to the back in the file
  const std::string series = folder_ / "series";
  std::filesystem::create_directory(series);
  const auto slice = [&](const char* name, int number, double z, int base) {
    test::write_file(series + "/" + name, files::dicom(number, {10, 20, z}, {base, base + 1, base + 2, base + 3, base + 4, base + 5}));
  };
  slice("b", 2, 32, 600);
  slice("a", 3, 36, 800);
  slice("c", 1, 30, 500);
  const AnyField field = read(series);
  const Mapping& m = field.get()->mapping();
  EXPECT_NEAR(norm(m.world_from_index(Vec3(0.0)) - Vec3(-10, -20, 30)), 0, 1e-12);
  EXPECT_NEAR(norm(m.world_from_index(Vec3(2, 1, 0)) - Vec3(-10.5, -20.5, 30)), 0, 1e-12);
  EXPECT_NEAR(value_at(field, {-10, -20, 30}), 2 * 500 - 1000, 1e-3);
  EXPECT_NEAR(value_at(field, {-10.25, -20.5, 32}), 2 * 604 - 1000, 1e-3);
  EXPECT_NEAR(value_at(field, {-10, -20, 34}), 2 * 700 - 1000, 1e-3);
  EXPECT_TRUE(has_note(field, "slices lie 2 to 4 mm apart"));
  const Units units = units_of(series, "Chest 1.2.3");
  EXPECT_EQ(units.value, "HU");
  EXPECT_TRUE(units.patient);
  // one of its files says so; one without a series beside it does not
  std::filesystem::copy_file(series + "/a", folder_ / "alone.dcm");
  EXPECT_FALSE(has_note(read(folder_ / "alone.dcm"), "the folder opens"));
  std::filesystem::rename(series + "/a", series + "/a.dcm");
  EXPECT_TRUE(has_note(read(series + "/a.dcm"), "the folder opens as a volume (catena render " + series + ")"));
  // a second series beside it
  test::write_file(series + "/d", files::dicom(1, {0, 0, 0}, {1, 2, 3, 4, 5, 6}, "1.2.7"));
  test::write_file(series + "/e", files::dicom(2, {0, 0, 1}, {1, 2, 3, 4, 5, 6}, "1.2.7"));
  EXPECT_NE(error_of(series).find("several grids, name one of: Chest 1.2.3, Chest 1.2.7"), std::string::npos) << error_of(series);
}

TEST_F(Formats, SurfacesOfPlyGiftiAndVtk) {
  for (const auto& [name, text] : {std::pair{"a.ply", files::ply()}, {"a.gii", files::gifti()}, {"a.vtp", files::vtp()}}) {
    const auto mesh = mesh::load_mesh(file(name, text));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ((*mesh)->triangles().size(), 4u) << name;
    EXPECT_EQ((*mesh)->open_edges(), 0u) << name;
    EXPECT_EQ((*mesh)->highest(), Vec3(1, 2, 3)) << name;
  }
}

TEST_F(Formats, LinesAndPointsOfVtkAndPly) {
  const auto lines = curves::load_curves(file("a.vtp", files::vtp_lines()));
  ASSERT_TRUE(lines) << lines.error().message;
  EXPECT_EQ((*lines)->first, (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ((*lines)->points[4], glm::vec3(5, 5, 6));
  ASSERT_NE((*lines)->find("s"), nullptr);
  EXPECT_EQ((*lines)->find("s")->values[3], 3);
  const auto points = curves::load_points(file("a.ply", files::ply_points()));
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ((*points)->points.size(), 3u);
  EXPECT_EQ((*points)->highest, Vec3(1, 2, 3));
  // what a file shows is what it holds
  using scene::FileKind;
  EXPECT_EQ(scene::kind_of_file(folder_ / "a.vtp"), FileKind::curves);
  EXPECT_EQ(scene::kind_of_file(folder_ / "a.ply"), FileKind::points);
  EXPECT_EQ(scene::kind_of_file(file("b.vtp", files::vtp())), FileKind::mesh);
  EXPECT_EQ(scene::kind_of_file(file("b.ply", files::ply())), FileKind::mesh);
  EXPECT_EQ(scene::kind_of_file(file("b.vtk", files::legacy_vectors())), FileKind::field);
  EXPECT_EQ(scene::kind_of_file(file("b.vtu", files::vtu_mixed(linear))), FileKind::field);
  // of cells without values: by their dimension
  const std::string cell =
      "# vtk DataFile Version 3.0\nc\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 ";
  EXPECT_EQ(scene::kind_of_file(file("vertex.vtk", cell + "2\n1 0\nCELL_TYPES 1\n1\n")), FileKind::points);
  EXPECT_EQ(scene::kind_of_file(file("line.vtk", cell + "3\n2 0 1\nCELL_TYPES 1\n3\n")), FileKind::curves);
  EXPECT_EQ(scene::kind_of_file(file("triangle.vtk", cell + "4\n3 0 1 2\nCELL_TYPES 1\n5\n")), FileKind::mesh);
  EXPECT_EQ(scene::kind_of_file(file("tetrahedron.vtk", cell + "5\n4 0 1 2 3\nCELL_TYPES 1\n10\n")), FileKind::mesh);
}

TEST_F(Formats, WhatIsWrongIsSaidInOneLine) {
  EXPECT_NE(error_of(file("text.vti", "this is no image")).find("text.vti: "), std::string::npos);
  EXPECT_NE(error_of(file("cut.npy", files::npy({2, 3, 4}, "<f8", false, [](int, int, int) { return 1; }).substr(0, 200)))
                .find("bytes of numbers"),
            std::string::npos);
  EXPECT_NE(error_of(file("o.npy", files::npy({2, 3, 4}, "|O", false, [](int, int, int) { return 1; })))
                .find("expected integers, floats or bools"),
            std::string::npos);
  EXPECT_NE(error_of(folder_.path()).find("holds no DICOM images"), std::string::npos);
}

TEST_F(Formats, AReaderOpensNothingOutsideTheFolder) {
  // the header names data elsewhere
  test::write_file(folder_ / "secret.raw", std::string(4 * 8, 'x'));
  std::filesystem::create_directory(folder_ / "in");
  const std::string header = files::mhd("../secret.raw");
  test::write_file(folder_ / "in/a.mhd", header);
  EXPECT_NE(error_of(folder_ / "in/a.mhd"), "loaded");
  test::write_file(folder_ / "in/data.raw", std::string(4 * 8, '\0'));
  test::write_file(folder_ / "in/b.mhd", files::mhd("data.raw"));
  EXPECT_EQ(error_of(folder_ / "in/b.mhd"), "loaded");
}

}  // namespace formats_test
}  // namespace catena::field
