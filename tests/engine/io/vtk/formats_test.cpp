// SPDX-License-Identifier: MIT
/// Files of other formats, written byte by byte, against the values and positions that were written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "engine/base/helper_process.h"
#include "engine/io/client.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/volume/units.h"
#include "engine/scene/default_scene.h"
#include "engine/scene/scene.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/fuzz/mutate.h"

namespace catena::field::formats_test {

using namespace test;
namespace files = test::vtk_files;

/// v = 1 + 2 x + 3 y + 5 z, which trilinear interpolation reproduces.
double linear(const Vec3& p) { return 1 + 2 * p.x + 3 * p.y + 5 * p.z; }

/// A value of 0 to 1.
double unit(catena::test::Random& random) { return static_cast<double>(random.next() >> 11) * 0x1p-53; }

/// The vector in the middle of the first cell.
Vec3 vector_of(const AnyField& field) {
  Cursor cursor;
  return field.vector->sample(field.get()->mapping().world_from_index(Vec3(0.5)), cursor).value;
}

constexpr const char* kFrame = "measurement frame: (0,1,0) (0,0,1) (1,0,0)\n";

using ForeignFormats = FilesTest;

TEST_F(ForeignFormats, AVtkImageFollowsItsDirectionMatrix) {
  // A quarter turn about z: index x runs along world y.
  const AnyField field = read(file("turned.vti", files::vti("0 -1 0 1 0 0 0 0 1", linear)));
  const Mapping& m = field.get()->mapping();
  EXPECT_EQ(m.world_from_index(Vec3(0.0)), Vec3(10, 20, 30));
  EXPECT_NEAR(norm(m.world_from_index(Vec3(1, 0, 0)) - Vec3(10, 20.5, 30)), 0, 1e-15);
  EXPECT_NEAR(norm(m.world_from_index(Vec3(0, 1, 0)) - Vec3(9, 20, 30)), 0, 1e-15);
  EXPECT_NEAR(value_at(field, m.world_from_index(Vec3(1.25, 2.5, 0.75))), linear({1.25, 2.5, 0.75}), 1e-5);
}

TEST_F(ForeignFormats, CellValuesAreAtCellCenters) {
  const AnyField field = read(file("cells.vti", files::vti_cells()));
  EXPECT_EQ(field.get()->mapping().origin, Vec3(0.5, 1, 1.5));
  EXPECT_TRUE(has_note(field, "has cell values"));
  EXPECT_DOUBLE_EQ(value_at(field, {0.5, 1, 1.5}), 0);
  EXPECT_DOUBLE_EQ(value_at(field, {1.5, 1, 1.5}), 1);
  EXPECT_DOUBLE_EQ(value_at(field, {0.5, 3, 1.5}), 3);
}

TEST_F(ForeignFormats, HiddenPointsAreInvalid) {
  const AnyField field = read(file("ghost.vti", files::vti_hidden()));
  EXPECT_TRUE(sample_at(field, {2.5, 0.5, 0.5}).inside);
  EXPECT_FALSE(sample_at(field, {0.5, 0.5, 0.5}).inside);
}

TEST_F(ForeignFormats, ReadsVectorsAndUnitsOfALegacyFile) {
  const AnyField field = read(file("old.vtk", files::legacy_vectors()), "wind");
  Cursor cursor;
  const VectorSample sample = field.vector->sample({0.5, 0.5, 0.5}, cursor);
  ASSERT_TRUE(sample.inside);
  EXPECT_NEAR(norm(sample.value - Vec3(0.5, -0.5, 2)), 0, 1e-6);
  EXPECT_TRUE(has(error_of(folder_ / "old.vtk", "rain"), "there is no grid \"rain\", the file has: heat, wind"));
}

TEST_F(ForeignFormats, ACurvilinearGridIsResampledWithinOnePercent) {
  // Half a ring, with a field that no lattice reproduces.
  const auto wave = [](const Vec3& p) { return std::sin(3 * p.x) * std::cos(2 * p.y) + p.z; };
  const AnyField field = read(file("ring.vts", files::vts_ring(24, 60, 10, wave)));
  EXPECT_TRUE(has_note(field, "cells were resampled to"));
  catena::test::Random random{7};
  std::vector<double> errors;
  int lost = 0;
  for (int i = 0; i < 4000; ++i) {
    const double r = 0.55 + 0.9 * unit(random), angle = std::numbers::pi * (0.02 + 0.96 * unit(random)), z = unit(random);
    const Vec3 p(r * std::cos(angle), r * std::sin(angle), z);
    const ScalarSample sample = sample_at(field, p);
    if (!sample.inside)
      ++lost;
    else
      errors.push_back(std::fabs(sample.value - wave(p)));
  }
  ASSERT_LT(lost, 4);
  std::sort(errors.begin(), errors.end());
  const double range = 3;  // sin cos from -1 to 1, z from 0 to 1
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.012 * range);
  // More than a voxel outside the ring there is no value.
  for (const double y : {0.0, -0.3}) EXPECT_FALSE(sample_at(field, {0, y, 0.5}).inside);
}

TEST_F(ForeignFormats, UnstructuredCellsReproduceALinearField) {
  const AnyField field = read(file("mixed.vtu", files::vtu_mixed(linear)), "v");
  // In the hexahedron, and in the tetrahedron on its side.
  EXPECT_NEAR(value_at(field, {0.3, 0.6, 0.2}), linear({0.3, 0.6, 0.2}), 2e-4);
  EXPECT_NEAR(value_at(field, {1.2, 0.3, 0.3}), linear({1.2, 0.3, 0.3}), 2e-4);
  const AnyField cells = read(folder_ / "mixed.vtu", "c");
  EXPECT_TRUE(has_note(cells, "averaged at the points"));
}

TEST_F(ForeignFormats, MeshesCountPointsAndCellsAndImagesCountVoxels) {
  const auto mixed = value_of(describe_grids(file("mixed.vtu", files::vtu_mixed(linear))));
  ASSERT_EQ(mixed.size(), 2u);
  EXPECT_EQ(mixed.at(0).name, "v");
  EXPECT_EQ(mixed.at(0).element_kind, ElementKind::points);
  EXPECT_EQ(mixed.at(1).name, "c");
  EXPECT_EQ(mixed.at(1).element_kind, ElementKind::cells);
  EXPECT_EQ(mixed.at(1).stats.active_voxels, 2u) << "a hexahedron and a tetrahedron";
  const auto image = value_of(describe_grids(file("a.vti", files::vti("1 0 0 0 1 0 0 0 1", linear))));
  EXPECT_EQ(image.at(0).element_kind, ElementKind::voxels);
}

TEST_F(ForeignFormats, QuadraticCellsHaveTheirValuesEverywhere) {
  const auto square = [](const Vec3& p) { return p.x * p.x + 0.5 * p.y * p.y - p.z; };
  const AnyField field = read(file("q.vtu", files::vtu_quadratic(square)));
  catena::test::Random random{3};
  for (int i = 0; i < 2000; ++i) {
    const double x = unit(random), y = unit(random);
    const Vec3 p(x, y, unit(random));
    EXPECT_NEAR(value_at(field, p), square(p), 0.02 * 2.5);
  }
}

TEST_F(ForeignFormats, DiscontinuousCellsDoNotExhaustTheVoxelLimit) {
  // Hexahedra in a row that share faces but not points, with alternating values 0 and 1.
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
  const AnyField field = read(file("jump.vtu", files::make_vtu(8 * kCells, points, values, corners, offsets, types)));
  EXPECT_TRUE(has_note(field, "finer voxels do not reduce the error")) << field.notes.front();
  EXPECT_LT(field.scalar->grid()->stats().active_voxels, 2'000'000u);
}

TEST_F(ForeignFormats, VectorsAreReorientedWithTheAxes) {
  for (const auto& [name, bytes, vector] : {
           std::tuple{"lps.nrrd", files::nrrd_vectors("left-posterior-superior"), Vec3(-1, -2, 3)},
           {"ras.nrrd", files::nrrd_vectors("right-anterior-superior"), Vec3(1, 2, 3)},
           {"las.nrrd", files::nrrd_vectors("left-anterior-superior"), Vec3(-1, 2, 3)},
           // The columns of the measurement frame are the directions of the components.
           {"frame.nrrd", files::nrrd_vectors("right-anterior-superior", kFrame), Vec3(3, 1, 2)},
       })
    EXPECT_EQ(vector_of(read(file(name, bytes))), vector) << name;
  const AnyField las = read(folder_ / "las.nrrd");
  EXPECT_NEAR(norm(las.get()->mapping().world_from_index(Vec3(1, 1, 1)) - Vec3(-12, 23, 34)), 0, 1e-12);
}

TEST_F(ForeignFormats, OnlyDirectionsAreReorientedWithAnNrrdsSpace) {
  // The components of each voxel are (1, 2, 3), with a `kind` in the space left-posterior-superior and a measurement frame.
  const auto with_kind = [&](const std::string& kind, int components = 3, const std::string& more = {}) {
    std::string bytes = files::nrrd_vectors("left-posterior-superior", more);
    bytes.replace(bytes.find("kinds: vector"), 13, "kinds: " + kind);
    bytes.replace(bytes.find("sizes: 3"), 8, fmt::format("sizes: {}", components));
    return bytes + std::string(components > 3 ? static_cast<std::size_t>(components - 3) * 8 * 4 : 0, '\0');
  };
  for (const char* kind : {"vector", "3-vector", "covariant-vector", "normal", "3-normal", "point"})
    EXPECT_EQ(vector_of(read(file("a.nrrd", with_kind(kind)))), Vec3(-1, -2, 3)) << kind;
  for (const char* kind : {"RGB-color", "rgb-color", "list", "XYZ-color", "HSV-color", "3-color"}) {
    const AnyField field = read(file("a.nrrd", with_kind(kind, 3, kFrame)));
    EXPECT_EQ(vector_of(field), Vec3(1, 2, 3)) << kind;
    EXPECT_TRUE(has_note(field, "are not a direction (")) << kind;
  }
  // Two components: x and y of planar vectors are reoriented, complex numbers are not.
  EXPECT_EQ(vector_of(read(file("a.nrrd", with_kind("2-vector", 2)))).z, 0);
  EXPECT_LT(vector_of(read(folder_ / "a.nrrd")).x, 0);
  EXPECT_GT(vector_of(read(file("a.nrrd", with_kind("complex", 2)))).x, 0);
  // Arrays that are neither scalars nor vectors are left out by kind.
  for (const auto& [kind, n] : {std::pair{"3D-symmetric-matrix", 6},
                                {"3D-masked-symmetric-matrix", 7},
                                {"3D-matrix", 9},
                                {"2D-symmetric-matrix", 3},
                                {"quaternion", 4},
                                {"RGBA-color", 4},
                                {"list", 5}}) {
    file("t.nrrd", with_kind(kind, n));
    for (const std::string& part : {fmt::format("t ({}, ", kind), std::string("cannot be read")}) {
      EXPECT_TRUE(has(error_of(folder_ / "t.nrrd"), part));
      EXPECT_TRUE(fails(describe_grids(folder_ / "t.nrrd"), part));
    }
  }
  EXPECT_TRUE(has(error_of(file("t.nrrd", with_kind("???"))), "axis 1 has neither a direction"));
  // MetaImage: three unsigned bytes are colors.
  std::string rgb = files::mha("RAI");
  rgb.replace(rgb.find("ElementType"), 11, "ElementNumberOfChannels = 3\nElementType");
  const AnyField colours = read(file("c.mha", rgb + std::string(16, '\5')));
  EXPECT_GT(vector_of(colours).x, 0);
  EXPECT_TRUE(has_note(colours, "are not a direction"));
}

TEST_F(ForeignFormats, AnNrrdsSpaceDoesNotDependOnTheVersionOfItk) {
  const auto look = [&](const std::string& space) {
    const AnyField field = read(file("a.nrrd", files::nrrd_vectors(space, kFrame)));
    const Mapping& m = field.get()->mapping();
    return std::tuple(m.origin, m.world_from_index(Vec3(1.0)), vector_of(field), read_units(folder_ / "a.nrrd", "a").length);
  };
  for (const auto& [space, sign] :
       {std::pair{"left-anterior-superior", Vec3(-1, 1, 1)}, {"LPS", Vec3(-1, -1, 1)}, {"RAS", Vec3(1)}, {"3D-right-handed", Vec3(1)}}) {
    const auto installed = look(space);
    reader_settings().program = helper_path("test_conflicting_itk");
    const auto other = look(space);
    reader_settings() = {};
    EXPECT_EQ(std::get<3>(other), "km") << "the other ITK was not asked";
    for (const auto& answer : {installed, other}) {
      EXPECT_EQ(std::get<0>(answer), sign * Vec3(10, 20, 30)) << space;
      EXPECT_EQ(std::get<1>(answer), sign * Vec3(12, 23, 34)) << space;
      EXPECT_EQ(std::get<2>(answer), sign * Vec3(3, 1, 2)) << space;
    }
  }
}

TEST_F(ForeignFormats, ASuspectedWrongByteOrderHasANote) {
  // A binary legacy .vtk must be big-endian; this one is little-endian.
  const auto image = [&](const std::string& type, auto number) {
    std::string bytes =
        "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 4 4\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA "
        "64\nSCALARS v " +
        type + "\nLOOKUP_TABLE default\n";
    for (int i = 0; i < 64; ++i) {
      const auto v = number(i);
      bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
    return bytes;
  };
  const std::string hint = "bytes were in the other order: a BINARY legacy .vtk must be big-endian";
  const std::string in_order = image("short", [](int i) { return static_cast<short>(256 * (10 + i / 3)); });
  for (const std::string& bytes :
       {image("float", [](int i) { return static_cast<float>(i); }), image("double", [](int i) { return 0.37 * i; }),
        image("short", [](int i) { return static_cast<short>(i * 17); }),
        // Small integers become multiples of 256 in the wrong byte order.
        image("short", [](int i) { return static_cast<short>(10 + i / 3); }),
        image("unsigned_short", [](int i) { return static_cast<unsigned short>(i % 4); }), image("int", [](int i) { return 10 + i / 3; })})
    EXPECT_TRUE(has_note(read(file("a.vtk", bytes)), hint));
  EXPECT_FALSE(has_note(read(file("a.vtk", in_order)), hint));
  const auto swapped = [](float v) {
    std::array<char, 4> raw = std::bit_cast<std::array<char, 4>>(v);
    std::reverse(raw.begin(), raw.end());
    return std::bit_cast<float>(raw);
  };
  const AnyField right = read(file("a.vtk", image("float", [&](int i) { return swapped(0.37F * static_cast<float>(i)); })));
  EXPECT_TRUE(right.notes.empty()) << right.notes.front();
  const auto mesh = mesh::load_mesh(file("m.ply", files::ply_doubles("binary_big_endian", "binary_little_endian")));
  EXPECT_TRUE(fails(mesh, "bytes were in the other order: see \"format\""));
  // Implausible values of any format.
  LoadRequest raw = request_for(file("a.raw", std::string(32, '\1')));
  raw.raw = RawLayout{{2, 2, 2}, Vec3(1.0), Vec3(0.0), "float32"};
  const auto absurd = value_of(load(raw));
  EXPECT_TRUE(has_note(absurd, "the byte order"));
}

TEST_F(ForeignFormats, APlyKeepsDoublesFarFromTheOrigin) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const auto mesh = value_of(mesh::load_mesh(file("far.ply", files::ply_doubles(format, format))));
    EXPECT_EQ(mesh->vertices().size(), 8u) << format;
    EXPECT_EQ(mesh->triangles().size(), 12u) << format;
    EXPECT_EQ(mesh->dropped_triangles() + mesh->open_edges(), 0u) << format;
    EXPECT_EQ(mesh->min_corner(), Vec3(615850.125, 5846925.0625, 758.03)) << format;
  }
  // A list with a short count, properties and elements that are skipped, and triangle strips.
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty list uchar int junk\r\nproperty short z\r\nproperty int "
      "y\r\nproperty uchar "
      "x\r\nproperty uchar red\r\nelement camera 1\r\nproperty float f\r\nelement tristrips 1\r\nproperty list int int "
      "vertex_indices\r\nend_header\r\n"
      "2 7 7 0 0 0 1\r\n0 0 0 1 1\r\n0 0 1 0 1\r\n1 5 -3 1 1 1\r\n0.5\r\n8 0 1 2 -1 2 1 3 -1\r\n";
  const auto strips = value_of(mesh::load_mesh(file("s.ply", text)));
  EXPECT_EQ(strips->triangles().size(), 2u);
  EXPECT_EQ(strips->min_corner(), Vec3(0, 0, -3));
  for (const auto& [from, to, wanted] : {std::tuple{"vertex 4", "vertex 400000000", "more than the"},
                                         {"8 0 1", "8 0 9", "refers to vertex 9"},
                                         {"property short z", "property short w", "without x, y and z"},
                                         {"list uchar int", "list text int", "invalid property"}}) {
    std::string bad = text;
    bad.replace(bad.find(from), std::string(from).size(), to);
    EXPECT_TRUE(fails(mesh::load_mesh(file("bad.ply", bad)), wanted));
  }
  // Lines are stored in single precision: rounding has a note.
  std::string far = files::vtp_lines();
  const std::string near = "0 0 0 1 0 0 1 1 0 5 5 5 5 5 6";
  far.replace(far.find(near), near.size(), "6e5 5846925.06 0 600001 5846926 0 600002 5846926 0 6e5 5846925 5 6e5 5846925 6");
  const auto lines = value_of(curves::load_curves(file("far.vtp", far)));
  EXPECT_TRUE(has(lines->note, "far from the origin and were rounded by up to 0.06"));
}

TEST_F(ForeignFormats, UnsupportedFormatsNameAConversion) {
  for (const auto& [name, word] : {std::pair{"a.czi", "Fiji"},
                                   {"a.zarr.zip", "unzip"},
                                   {"a.h5ad", "h5py"},
                                   {"a.exo", "ParaView"},
                                   {"a.xdmf", "ParaView"},
                                   {"a.grib", "cdo"},
                                   {"a.mrc", "mrcfile"}}) {
    file(name, "x");
    EXPECT_TRUE(has(error_of(folder_ / name), word));
    EXPECT_FALSE(describe_grids(folder_ / name)) << name;
  }
}

TEST_F(ForeignFormats, NumpyArraysAreIndexedZyx) {
  // a[k, j, i] = 100 k + 10 j + i.
  for (const bool fortran : {false, true})
    for (const char* type : {"<f8", ">f4", "<i2"}) {
      const AnyField field =
          read(file("a.npy", files::npy({2, 3, 4}, type, fortran, [](int k, int j, int i) { return 100 * k + 10 * j + i; })));
      EXPECT_DOUBLE_EQ(value_at(field, {3, 2, 1}), 123) << type << fortran;
      EXPECT_NEAR(value_at(field, {0.5, 1, 0.25}), 35.5, 1e-4);
    }
  LoadRequest request = request_for(folder_ / "a.npy");
  request.axes_xyz = true;
  request.spacing = Vec3(0.5, 1, 2);
  request.origin = Vec3(7, 0, 0);
  const auto field = value_of(load(request));
  EXPECT_DOUBLE_EQ(value_at(field, {7.5, 2, 6}), 123);
}

TEST_F(ForeignFormats, NrrdAndMetaImageAreReorientedToPatientAxes) {
  struct Case {
    std::string name, bytes;
    Vec3 index, world;
  };
  for (const Case& c : {
           // Left, posterior, superior: x and y change their signs.
           Case{"head.nrrd", files::nrrd("left-posterior-superior"), Vec3(1, 1, 1), Vec3(-(10 + 2), -(20 + 3), 30 + 4)},
           {"ras.nrrd", files::nrrd("right-anterior-superior"), Vec3(1, 1, 1), Vec3(12, 23, 34)},
           {"plain.nrrd", files::nrrd("3D-right-handed"), Vec3(1, 1, 1), Vec3(12, 23, 34)},
           {"m.mha", files::mha("RAI"), Vec3(1, 0, 0), Vec3(-12, -20, 30)},
           {"u.mha", files::mha("???"), Vec3(1, 0, 0), Vec3(12, 20, 30)},
       }) {
    const AnyField field = read(file(c.name, c.bytes));
    const Mapping& m = field.get()->mapping();
    EXPECT_NEAR(norm(m.world_from_index(c.index) - c.world), 0, 1e-12) << c.name;
    EXPECT_DOUBLE_EQ(value_at(field, m.world_from_index(Vec3(1, 1, 1))), 7) << c.name;
  }
  EXPECT_TRUE(read_units(folder_ / "head.nrrd", "head").is_patient_space);
  EXPECT_FALSE(read_units(folder_ / "plain.nrrd", "plain").is_patient_space);
}

TEST_F(ForeignFormats, ADicomFolderIsOneVolumeInHounsfieldUnits) {
  // Slices in arbitrary order, with a double gap at the end; in the file, x runs to the left and y to the back.
  const std::string series = folder_ / "series";
  std::filesystem::create_directory(series);
  const auto slice = [&](const char* name, int number, double z, int base) {
    write_file(series + "/" + name, files::dicom(number, {10, 20, z}, {base, base + 1, base + 2, base + 3, base + 4, base + 5}));
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
  EXPECT_TRUE(has_note(field, "slices are 2 to 4 mm apart"));
  const Units units = read_units(series, "Chest 1.2.3");
  EXPECT_EQ(units.value, "HU");
  EXPECT_TRUE(units.is_patient_space);
  // One file of a series has a note; a file without other files of its series has none.
  std::filesystem::copy_file(series + "/a", folder_ / "alone.dcm");
  EXPECT_FALSE(has_note(read(folder_ / "alone.dcm"), "open the folder"));
  std::filesystem::rename(series + "/a", series + "/a.dcm");
  EXPECT_TRUE(has_note(read(series + "/a.dcm"), "open the folder to get the volume (catena render " + series + ")"));
  // The other files may be read too: no output may replace them.
  const std::vector<FileId> parts = find_data_files(series + "/a.dcm");
  EXPECT_NE(std::find(parts.begin(), parts.end(), *find_file_id(series + "/b")), parts.end());
  // A second series in the folder.
  write_file(series + "/d", files::dicom(1, {0, 0, 0}, {1, 2, 3, 4, 5, 6}, "1.2.7"));
  write_file(series + "/e", files::dicom(2, {0, 0, 1}, {1, 2, 3, 4, 5, 6}, "1.2.7"));
  EXPECT_TRUE(has_note(read(series), "the largest of 2 volumes is shown, 1 \"Chest 1.2.3\" (3 images)"));
  EXPECT_TRUE(has(error_of(series, "Head"), "there is no grid \"Head\", expected one of: 1 \"Chest 1.2.3\""));
}

TEST_F(ForeignFormats, ReadsSurfacesOfPlyGiftiAndVtk) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  std::string by_columns =
      with(with(files::gifti(), "RowMajorOrder", "ColumnMajorOrder"), "0 0 0 1 0 0 0 2 0 0 0 3", "0 1 0 0 0 0 2 0 0 0 0 3");
  for (const auto& [name, text] : {std::pair{"a.ply", files::ply()},
                                   {"a.gii", files::gifti()},
                                   {"columns.gii", by_columns},
                                   {"doubles.gii", with(files::gifti(), "FLOAT32", "FLOAT64")},
                                   {"a.vtp", files::vtp()}}) {
    const auto mesh = value_of(mesh::load_mesh(file(name, text)));
    EXPECT_EQ(mesh->triangles().size(), 4u) << name;
    EXPECT_EQ(mesh->open_edges(), 0u) << name;
    EXPECT_EQ(mesh->max_corner(), Vec3(1, 2, 3)) << name;
  }
}

TEST_F(ForeignFormats, ReadsLinesAndPointsOfVtkAndPly) {
  const auto lines = value_of(curves::load_curves(file("a.vtp", files::vtp_lines())));
  EXPECT_EQ(lines->line_offsets, (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(lines->points[4], glm::vec3(5, 5, 6));
  ASSERT_NE(lines->find_values("s"), nullptr);
  EXPECT_EQ(lines->find_values("s")->values[3], 3);
  const auto points = value_of(curves::load_points(file("a.ply", files::ply_points())));
  EXPECT_EQ(points->points.size(), 3u);
  EXPECT_EQ(points->max_corner, Vec3(1, 2, 3));
  // The file's kind is determined by its contents.
  using scene::FileKind;
  const std::string cell =
      "# vtk DataFile Version 3.0\nc\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 ";
  for (const auto& [name, bytes, kind] : {
           std::tuple{"a.vtp", files::vtp_lines(), FileKind::curves},
           {"a.ply", files::ply_points(), FileKind::points},
           {"b.vtp", files::vtp(), FileKind::mesh},
           {"b.ply", files::ply(), FileKind::mesh},
           {"b.vtk", files::legacy_vectors(), FileKind::field},
           {"b.vtu", files::vtu_mixed(linear), FileKind::field},
           // Cells without values are classified by dimension.
           {"vertex.vtk", cell + "2\n1 0\nCELL_TYPES 1\n1\n", FileKind::points},
           {"line.vtk", cell + "3\n2 0 1\nCELL_TYPES 1\n3\n", FileKind::curves},
           {"triangle.vtk", cell + "4\n3 0 1 2\nCELL_TYPES 1\n5\n", FileKind::mesh},
           {"tetrahedron.vtk", cell + "5\n4 0 1 2 3\nCELL_TYPES 1\n10\n", FileKind::mesh},
       })
    EXPECT_EQ(scene::detect_file_kind(file(name, bytes)), kind) << name;
}

TEST_F(ForeignFormats, ErrorsAreOneLine) {
  const auto one = [](int, int, int) { return 1; };
  EXPECT_TRUE(has(error_of(file("text.vti", "this is no image")), "text.vti: "));
  EXPECT_TRUE(has(error_of(file("cut.npy", files::npy({2, 3, 4}, "<f8", false, one).substr(0, 200))), "bytes of array data"));
  EXPECT_TRUE(has(error_of(file("o.npy", files::npy({2, 3, 4}, "|O", false, one))), "expected integers, floats or bools"));
  EXPECT_TRUE(has(error_of(folder_.path()), "contains neither DICOM images"));
}

TEST_F(ForeignFormats, TheDefaultSceneOfAVtkImageHasAScalarBar) {
  const auto bare = value_of(scene::make_default_scene(file("a.vti", files::vti("1 0 0 0 1 0 0 0 1", linear)), {}, {}));
  EXPECT_TRUE(has(bare.text, "\"scalar_bars\": [{\"volume\": 0}]"));
}

TEST_F(ForeignFormats, HeadersAreValidatedBeforeTheLibrariesReadThem) {
  const auto nrrd = [](const std::string& kind, int numbers) {
    return fmt::format(
        "NRRD0005\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: {} 2 2 2\nspace directions: none (1,0,0) (0,1,0) "
        "(0,0,1)\nkinds: {} domain domain domain\nencoding: raw\n\n{}",
        numbers, kind, std::string(static_cast<std::size_t>(8 * numbers), 'x'));
  };
  const auto meta = [](const std::string& axes) {
    return "ObjectType = Image\nNDims = " + axes + "\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n12345678";
  };
  const std::string surface =
      "# vtk DataFile Version 3.0\nc\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES "
      "1\n5\nPOINT_DATA 3\nSCALARS a float 1\nLOOKUP_TABLE default\n1 2 3\nSCALARS b float 1\nLOOKUP_TABLE default\n1 2 3\n";
  const auto blocks = [](const std::string& index) {
    return "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><Block index = '0'><DataSet index=\"" + index +
           "\" file=\"a.vti\"/></Block></vtkMultiBlockDataSet></VTKFile>";
  };
  for (const auto& [name, bytes, words] : {
           std::tuple<const char*, std::string, const char*>{"a.mhd", meta("-1"), "a.mhd: NDims is -1, expected 1 to 10"},
           {"b.mha", meta("1000000000"), "NDims is 1000000000, expected 1 to 10"},
           {"c.mha", meta("three"), "NDims is three, expected 1 to 10"},
           {"a.nhdr", "NRRD0004\ntype: float\ndimension: 1\nsizes: 2\nencoding: raw\ndata file: " + std::string(200'000, 'q') + "\n",
            "\"data file\" has a name of 200000 characters, expected at most 4096"},
           {"a.nrrd", nrrd("3D-masked-matrix", 10), "(3D-masked-matrix, 10 numbers per voxel), the only array of the file"},
           {"b.nrrd", nrrd("2D-masked-symmetric-matrix", 4), "(2D-masked-symmetric-matrix, "},
           {"c.nrrd", nrrd("3-gradient", 3), "\"3-gradient\" is not supported, expected \"covariant-vector\""},
           {"a.vtm", blocks("2000000000"), "a block has the index 2000000000, expected 0 to 999999"},
           {"b.vtm", blocks("-1"), "a block has the index -1, expected"},
           {"a.vtk", surface, "the cells of a, b have no volume (surfaces, lines or points)"},
       })
    EXPECT_TRUE(has(error_of(file(name, bytes)), words)) << name;
}

TEST_F(ForeignFormats, AReaderOpensNoFileOutsideTheFolder) {
  std::filesystem::create_directory(folder_ / "in");
  file("secret.raw", std::string(4 * 8, 'x'));
  EXPECT_NE(error_of(file("in/a.mhd", files::mhd("../secret.raw"))), "loaded");
  file("in/data.raw", std::string(4 * 8, '\0'));
  EXPECT_EQ(error_of(file("in/b.mhd", files::mhd("data.raw"))), "loaded");
}

}  // namespace catena::field::formats_test
