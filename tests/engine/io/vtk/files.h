// SPDX-License-Identifier: MIT
/// Small files in formats of other programs, for the tests of readers.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "tests/engine/io/vtk/dicom_files.h"

namespace catena::test::vtk_files {

using Scalar = std::function<double(const Vec3&)>;

inline std::string array(const std::string& name, const std::string& values, int components = 1, const char* type = "Float64") {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>\n", type, name,
                     components, values);
}

/// A file of a VTK XML format: the attributes of the data set, those of its piece, and the piece.
inline std::string vtk_file(const std::string& type, const std::string& attributes, const std::string& piece, const std::string& data) {
  return fmt::format("<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\"><{0}{1}><Piece {2}>{3}</Piece></{0}></VTKFile>\n",
                     type, attributes, piece, data);
}

/// Numbers 0 to count - 1, each with `f`.
template <class F>
std::string numbers(int count, const F& f) {
  std::string text;
  for (int n = 0; n < count; ++n) text += fmt::format("{} ", f(n));
  return text;
}

/// An image of 4 x 4 x 3 points with spacing 0.5 1 2, origin 10 20 30, and values by position.
inline std::string vti(const std::string& direction, const Scalar& f) {
  std::string values;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) values += fmt::format("{} ", f(Vec3(i, j, k)));
  return "<?xml version=\"1.0\"?>\n" +
         vtk_file("ImageData", " WholeExtent=\"0 3 0 3 0 2\" Origin=\"10 20 30\" Spacing=\"0.5 1 2\" Direction=\"" + direction + "\"",
                  "Extent=\"0 3 0 3 0 2\"", "<PointData Scalars=\"v\">\n" + array("v", values) + "</PointData>");
}

/// An image of 3 x 3 x 2 cells of size 1 x 2 x 3, with values by number.
inline std::string vti_cells() {
  return vtk_file("ImageData", " WholeExtent=\"0 3 0 3 0 2\" Origin=\"0 0 0\" Spacing=\"1 2 3\"", "Extent=\"0 3 0 3 0 2\"",
                  "<CellData>" + array("id", numbers(18, [](int n) { return n; }), 1, "Int32") + "</CellData>");
}

/// An image of 4 x 2 x 2 points; those at x = 0 are hidden.
inline std::string vti_hidden() {
  const std::string ghosts = numbers(16, [](int n) { return n % 4 == 0 ? 2 : 0; });
  return vtk_file(
      "ImageData", " WholeExtent=\"0 3 0 1 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 1\"", "Extent=\"0 3 0 1 0 1\"",
      "<PointData>" + array("v", numbers(16, [](int n) { return n; })) + array("vtkGhostType", ghosts, 1, "UInt8") + "</PointData>");
}

/// An image of 2 x 2 x 2 points with wind = (x, -y, 2) and heat = x.
inline std::string legacy_vectors() {
  std::string text =
      "# vtk DataFile Version 3.0\nwind\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA "
      "8\nSCALARS "
      "heat float 1\nLOOKUP_TABLE default\n0 1 0 1 0 1 0 1\nVECTORS wind float\n";
  for (int n = 0; n < 8; ++n) text += fmt::format("{} {} 2\n", n & 1, -(n >> 1 & 1));
  return text;
}

/// A structured grid of half a ring: radius 0.5 to 1.5, z from 0 to 1.
inline std::string vts_ring(int nr, int na, int nz, const Scalar& f) {
  std::string points, values;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < na; ++j)
      for (int i = 0; i < nr; ++i) {
        const double r = 0.5 + double(i) / (nr - 1), a = std::numbers::pi * j / (na - 1);
        const Vec3 p(r * std::cos(a), r * std::sin(a), double(k) / (nz - 1));
        points += fmt::format("{} {} {} ", p.x, p.y, p.z);
        values += fmt::format("{} ", f(p));
      }
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", nr - 1, na - 1, nz - 1);
  return vtk_file("StructuredGrid", " WholeExtent=\"" + extent + "\"", "Extent=\"" + extent + "\"",
                  "<PointData>" + array("v", values) + "</PointData><Points>" + array("Points", points, 3) + "</Points>");
}

/// `count` points with the array "v", cells by the ids of their points, and `more` in the piece.
inline std::string make_vtu(int count, const std::string& points, const std::string& values, const std::string& ids,
                            const std::string& ends, const std::string& types, const std::string& more = {}) {
  return vtk_file("UnstructuredGrid", "",
                  fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", count, 1 + std::count(ends.begin(), ends.end(), ' ')),
                  "<PointData>" + array("v", values) + "</PointData>" + more + "<Points>" + array("Points", points, 3) +
                      "</Points><Cells>" + array("connectivity", ids, 1, "Int64") + array("offsets", ends, 1, "Int64") +
                      array("types", types, 1, "UInt8") + "</Cells>");
}

/// A unit cube as a hexahedron, and a tetrahedron on its face x = 1; "v" at points, "c" in cells.
inline std::string vtu_mixed(const Scalar& f) {
  const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, 0, 0}};
  std::string points, values;
  for (const Vec3& q : p) points += fmt::format("{} {} {} ", q.x, q.y, q.z), values += fmt::format("{} ", f(q));
  return make_vtu(9, points, values, "0 1 2 3 4 5 6 7 1 8 2 5", "8 12", "12 10", "<CellData>" + array("c", "1 2") + "</CellData>");
}

/// A unit cube as one quadratic hexahedron of 20 points.
inline std::string vtu_quadratic(const Scalar& f) {
  const std::vector<Vec3> p{{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},  {0, 0, 1},  {1, 0, 1},  {1, 1, 1},
                            {0, 1, 1},  {.5, 0, 0}, {1, .5, 0}, {.5, 1, 0}, {0, .5, 0}, {.5, 0, 1}, {1, .5, 1},
                            {.5, 1, 1}, {0, .5, 1}, {0, 0, .5}, {1, 0, .5}, {1, 1, .5}, {0, 1, .5}};
  std::string points, values, ids;
  for (std::size_t i = 0; i < p.size(); ++i) {
    points += fmt::format("{} {} {} ", p[i].x, p[i].y, p[i].z);
    values += fmt::format("{} ", f(p[i]));
    ids += fmt::format("{} ", i);
  }
  return make_vtu(20, points, values, ids, "20", "25");
}

/// A NumPy array with the shape [z, y, x].
inline std::string npy(const std::vector<int>& shape, const std::string& type, bool fortran,
                       const std::function<double(int, int, int)>& f) {
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}), }}", type, fortran ? "True" : "False", fmt::join(shape, ", "));
  while ((10 + head.size() + 1) % 64 != 0) head += ' ';
  head += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += std::string("\1\0", 2);
  bytes += static_cast<char>(head.size() & 255);
  bytes += static_cast<char>(head.size() >> 8);
  bytes += head;
  const auto put = [&]<class T>(T v) {
    std::string raw(sizeof v, '\0');
    std::memcpy(raw.data(), &v, sizeof v);
    if (type[0] == '>') raw = std::string(raw.rbegin(), raw.rend());
    bytes += raw;
  };
  const auto number = [&](double v) {
    if (type.ends_with("f8"))
      put(v);
    else if (type.ends_with("f4"))
      put(static_cast<float>(v));
    else
      put(static_cast<std::int16_t>(v));
  };
  if (fortran)
    for (int i = 0; i < shape[2]; ++i)
      for (int j = 0; j < shape[1]; ++j)
        for (int k = 0; k < shape[0]; ++k) number(f(k, j, i));
  else
    for (int k = 0; k < shape[0]; ++k)
      for (int j = 0; j < shape[1]; ++j)
        for (int i = 0; i < shape[2]; ++i) number(f(k, j, i));
  return bytes;
}

inline std::string bytes_0_to(int n) {
  std::string bytes;
  for (int i = 0; i < n; ++i) bytes += static_cast<char>(i);
  return bytes;
}

/// An image of 2 x 2 x 2 bytes 0 .. 7 with spacing 2 3 4 and origin 10 20 30.
inline std::string nrrd(const std::string& space) {
  return "NRRD0004\ntype: uchar\ndimension: 3\nspace: " + space +
         "\nsizes: 2 2 2\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nkinds: domain domain domain\nencoding: raw\nspace origin: "
         "(10,20,30)\n\n" +
         bytes_0_to(8);
}
/// An image of float vectors (1, 2, 3).
inline std::string nrrd_vectors(const std::string& space, const std::string& more = {}) {
  std::string numbers;
  for (int i = 0; i < 8; ++i)
    for (const float v : {1.f, 2.f, 3.f}) numbers.append(reinterpret_cast<const char*>(&v), sizeof v);
  return "NRRD0004\ntype: float\ndimension: 4\nspace: " + space +
         "\nsizes: 3 2 2 2\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\nkinds: vector domain domain domain\nendian: little\nencoding: "
         "raw\nspace origin: (10,20,30)\n" +
         more + "\n" + numbers;
}
inline std::string mha(const std::string& orientation) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\nTransformMatrix = 1 0 "
         "0 0 1 0 0 0 "
         "1\nOffset = 10 20 30\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = " +
         orientation + "\nElementSpacing = 2 3 4\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + bytes_0_to(8);
}
inline std::string mhd(const std::string& data) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_FLOAT\nElementDataFile = " + data + "\n";
}

/// A tetrahedron with vertices at 0 and at 1, 2, 3 on the axes.
inline std::string ply() {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list "
         "uchar int "
         "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}
/// A box of 12 triangles with edges of 0.25 at (615850.125, 5846925.0625, 758.03), in doubles. `declared` is the format in the header.
inline std::string ply_doubles(const std::string& format, const std::string& declared) {
  std::string bytes =
      "ply\nformat " + declared +
      " 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\nelement face 12\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  const auto put = [&](auto v, const char* end) {
    std::string raw(sizeof v, '\0');
    std::memcpy(raw.data(), &v, sizeof v);
    if (format == "binary_big_endian") std::reverse(raw.begin(), raw.end());
    bytes += format == "ascii" ? fmt::format("{}{}", v, end) : raw;
  };
  for (int n = 0; n < 8; ++n) {
    put(615850.125 + 0.25 * (n & 1), " ");
    put(5846925.0625 + 0.25 * (n >> 1 & 1), " ");
    put(758.03 + 0.25 * (n >> 2), "\n");
  }
  constexpr int kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& face : kFaces) {
    put(std::uint8_t{3}, " ");
    for (const int corner : face) put(corner, " ");
  }
  return bytes;
}
inline std::string gifti() {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<GIFTI Version=\"1.0\" NumberOfDataArrays=\"2\">\n<DataArray "
         "Intent=\"NIFTI_INTENT_POINTSET\" "
         "DataType=\"NIFTI_TYPE_FLOAT32\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"2\" Dim0=\"4\" Dim1=\"3\" "
         "Encoding=\"ASCII\" "
         "Endian=\"LittleEndian\" ExternalFileName=\"\" ExternalFileOffset=\"\">\n<Data>0 0 0 1 0 0 0 2 0 0 0 "
         "3</Data></DataArray>\n<DataArray "
         "Intent=\"NIFTI_INTENT_TRIANGLE\" DataType=\"NIFTI_TYPE_INT32\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"2\" "
         "Dim0=\"4\" "
         "Dim1=\"3\" Encoding=\"ASCII\" Endian=\"LittleEndian\" ExternalFileName=\"\" ExternalFileOffset=\"\">\n<Data>0 2 1 0 1 3 1 2 3 0 "
         "3 "
         "2</Data></DataArray>\n</GIFTI>\n";
}
inline std::string vtp() {
  return vtk_file("PolyData", "", "NumberOfPoints=\"4\" NumberOfPolys=\"4\"",
                  "<Points>" + array("Points", "0 0 0 1 0 0 0 2 0 0 0 3", 3) + "</Points><Polys>" +
                      array("connectivity", "0 2 1 0 1 3 1 2 3 0 3 2", 1, "Int64") + array("offsets", "3 6 9 12", 1, "Int64") + "</Polys>");
}

/// Two polylines of 3 and 2 points, with "s" at each point.
inline std::string vtp_lines() {
  return vtk_file("PolyData", "", "NumberOfPoints=\"5\" NumberOfLines=\"2\"",
                  "<PointData Scalars=\"s\">" + array("s", "0 1 2 3 4") + "</PointData><Points>" +
                      array("Points", "0 0 0 1 0 0 1 1 0 5 5 5 5 5 6", 3) + "</Points><Lines>" +
                      array("connectivity", "0 1 2 3 4", 1, "Int64") + array("offsets", "3 5", 1, "Int64") + "</Lines>");
}
inline std::string ply_points() {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 2 "
         "3\n";
}

}  // namespace catena::test::vtk_files
