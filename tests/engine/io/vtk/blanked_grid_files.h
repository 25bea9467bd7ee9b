// SPDX-License-Identifier: MIT
/// Grids of n^3 unit cells in VTK's XML formats, with flags at points and cells, for the tests of hidden cells.
#pragma once
#include "tests/engine/io/vtk/files.h"

namespace catena::test::vtk_files {

enum class Form { image, rectilinear, structured, unstructured };

struct Flags {
  std::function<int(int)> points, cells;  ///< flags by index; without a function there is no array
  const char* type = "UInt8";
  const char* name = "vtkGhostType";
};

/// A grid with "v" at points, f at the point, and "c" in cells, f at the center.
inline std::string boxes(Form form, int n, const Scalar& f, const Flags& flags = {}) {
  std::string points, axis, values, middles, point_flags, cell_flags, ids, ends, types;
  int number = 0;
  const auto point = [&](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  for (int i = 0; i <= n; ++i) axis += fmt::format("{} ", i);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        points += fmt::format("{} {} {} ", i, j, k);
        values += fmt::format("{} ", f(Vec3(i, j, k)));
        if (flags.points) point_flags += fmt::format("{} ", flags.points(point(i, j, k)));
      }
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i, ++number) {
        middles += fmt::format("{} ", f(Vec3(i + 0.5, j + 0.5, k + 0.5)));
        if (flags.cells) cell_flags += fmt::format("{} ", flags.cells(number));
        ids += fmt::format("{} {} {} {} {} {} {} {} ", point(i, j, k), point(i + 1, j, k), point(i + 1, j + 1, k), point(i, j + 1, k),
                           point(i, j, k + 1), point(i + 1, j, k + 1), point(i + 1, j + 1, k + 1), point(i, j + 1, k + 1));
        ends += fmt::format("{} ", 8 * (number + 1));
        types += "12 ";
      }
  const std::string extent = fmt::format("0 {0} 0 {0} 0 {0}", n);
  std::string data = "<PointData>" + array("v", values) + (flags.points ? array(flags.name, point_flags, 1, flags.type) : "") +
                     "</PointData><CellData>" + array("c", middles) + (flags.cells ? array(flags.name, cell_flags, 1, flags.type) : "") +
                     "</CellData>";
  const char* kinds[] = {"ImageData", "RectilinearGrid", "StructuredGrid", "UnstructuredGrid"};
  const std::string kind = kinds[static_cast<int>(form)];
  std::string head = " WholeExtent=\"" + extent + "\"", piece = "Extent=\"" + extent + "\"";
  if (form == Form::image) head += " Origin=\"0 0 0\" Spacing=\"1 1 1\"";
  if (form == Form::rectilinear) data += "<Coordinates>" + array("x", axis) + array("y", axis) + array("z", axis) + "</Coordinates>";
  if (form == Form::structured || form == Form::unstructured) data += "<Points>" + array("Points", points, 3) + "</Points>";
  if (form == Form::unstructured) {
    head = "";
    piece = fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", (n + 1) * (n + 1) * (n + 1), n * n * n);
    data += "<Cells>" + array("connectivity", ids, 1, "Int64") + array("offsets", ends, 1, "Int64") + array("types", types, 1, "UInt8") +
            "</Cells>";
  }
  return vtk_file(kind, head, piece, data);
}

inline const char* file_extension(Form form) {
  constexpr const char* endings[] = {".vti", ".vtr", ".vts", ".vtu"};
  return endings[static_cast<int>(form)];
}

/// Boxes as hexahedra, with the corners (i, j, k) of each in the order of VTK_VOXEL, rotated by an angle about z; "v" at points.
inline std::string hexahedra(const std::vector<std::pair<Vec3, Vec3>>& boxes, double angle, const Scalar& f) {
  std::string points, values, ids, ends, types;
  int n = 0;
  for (const auto& [lo, hi] : boxes) {
    for (int c = 0; c < 8; ++c) {
      const Vec3 p((c & 1) ? hi.x : lo.x, (c & 2) ? hi.y : lo.y, (c & 4) ? hi.z : lo.z);
      const Vec3 q(p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle), p.z);
      points += fmt::format("{} {} {} ", q.x, q.y, q.z);
      values += fmt::format("{} ", f(p));
    }
    for (const int c : {0, 1, 3, 2, 4, 5, 7, 6}) ids += fmt::format("{} ", n + c);
    n += 8;
    ends += fmt::format("{}{}", n > 8 ? " " : "", n);
    types += "12 ";
  }
  return make_vtu(n, points, values, ids, ends, types);
}

/// A cube of n^3 unit cells, each stored as a polyhedron of six quadrilaterals, with slightly displaced inner points. Some faces are
/// oriented outward and some inward, and one point, with the value -500, belongs to no cell.
inline std::string polyhedra(int n, const Scalar& f) {
  std::string points, values, ids, ends, types, faces, face_ends;
  const auto point = [&](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  const auto moved = [n](int i, int way) { return i > 0 && i < n ? i + 0.15 * std::sin(7.0 * i + way) : i; };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const Vec3 p(moved(i, j + 2 * k), moved(j, k + 3 * i), moved(k, i + 5 * j));
        points += fmt::format("{} {} {} ", p.x, p.y, p.z);
        values += fmt::format("{} ", f(p));
      }
  int cells = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i, ++cells) {
        int p[8];
        for (int c = 0; c < 8; ++c) p[c] = point(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
        for (const int c : p) ids += fmt::format("{} ", c);
        ends += fmt::format("{}{}", cells > 0 ? " " : "", 8 * (cells + 1));
        types += "42 ";
        faces += "6 ";
        int face = 0;
        for (auto q : {std::array{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}) {
          if ((cells + face++) % 3 == 0) std::swap(q[1], q[3]);
          faces += fmt::format("4 {} {} {} {} ", p[q[0]], p[q[1]], p[q[2]], p[q[3]]);
        }
        face_ends += fmt::format("{} ", 31 * (cells + 1));
      }
  points += "9 9 9 ";
  values += "-500 ";
  std::string text = make_vtu((n + 1) * (n + 1) * (n + 1) + 1, points, values, ids, ends, types);
  text.insert(text.find("</Cells>"), array("faces", faces, 1, "Int64") + array("faceoffsets", face_ends, 1, "Int64"));
  return text;
}

}  // namespace catena::test::vtk_files
