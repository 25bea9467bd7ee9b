// SPDX-License-Identifier: MIT
#include "engine/io/curves/write_polylines.h"

#include <fmt/core.h>

#include <type_traits>

#include "engine/base/numbers.h"
#include "engine/base/vtk_xml_writer.h"

namespace catena::curves {

namespace {

template <class T>
constexpr const char* kTypeWord = std::is_same_v<T, double> ? "Float64" : "Int64";

}  // namespace

const char* polyline_table_header(const std::vector<flow::CurvePtr>& curves) {
  return !curves.empty() && !curves.front()->times().empty() ? kTimedPolylineTableHeader : kPolylineTableHeader;
}

void append_polyline_rows(std::string& text, std::size_t line, const flow::Curve& curve) {
  for (std::size_t k = 0; k < curve.knots().size(); ++k) {
    const flow::Knot& knot = curve.knots()[k];
    text += std::to_string(line);
    for (const double x : {knot.s, knot.p.x, knot.p.y, knot.p.z, knot.t.x, knot.t.y, knot.t.z}) {
      text += ',';
      append_number(text, x);
    }
    if (!curve.times().empty()) {
      text += ',';
      append_number(text, curve.times()[k]);
    }
    text += '\n';
  }
}

void write_polylines_csv(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField&) {
  out.write(polyline_table_header(curves));
  std::string rows;
  for (std::size_t line = 0; line < curves.size(); ++line) {
    rows.clear();
    append_polyline_rows(rows, line, *curves[line]);
    out.write(rows);
  }
}

void write_polylines_vtp(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField& field) {
  std::size_t points = 0;
  for (const auto& curve : curves) points += curve->knots().size();

  // arrays per point and per line
  const auto by_knot = [&]<class T>(const char* name, int components, T, auto&& value) {
    return AppendedArray{kTypeWord<T>, name, components, points * components * sizeof(T), [&curves, components, value](OutputFile& to) {
                           for (std::size_t line = 0; line < curves.size(); ++line)
                             for (const flow::Knot& knot : curves[line]->knots()) {
                               const auto v = value(line, knot);
                               write_bytes(to, &v, components * sizeof(T));
                             }
                         }};
  };
  const auto by_line = [&]<class T>(const char* name, T, auto&& value) {
    return AppendedArray{kTypeWord<T>, name, 1, curves.size() * sizeof(T), [&curves, value](OutputFile& to) {
                           for (std::size_t line = 0; line < curves.size(); ++line) {
                             const T v = value(line, *curves[line]);
                             write_bytes(to, &v, sizeof(T));
                           }
                         }};
  };
  using Int = std::int64_t;
  field::Cursor cursor;
  const std::vector<AppendedArray> point_data{
      by_knot("s", 1, 0.0, [](std::size_t, const flow::Knot& k) { return k.s; }),
      by_knot("tangent", 3, 0.0, [](std::size_t, const flow::Knot& k) { return k.t; }),
      curves.empty() || curves.front()->times().empty()
          ? by_knot("velocity", 3, 0.0, [&](std::size_t, const flow::Knot& k) { return field.sample(k.p, cursor).value; })
          : by_knot("time", 1, 0.0,
                    [&](std::size_t line, const flow::Knot& k) {
                      return curves[line]->times()[static_cast<std::size_t>(&k - curves[line]->knots().data())];
                    }),
      by_knot("line", 1, Int(0), [](std::size_t line, const flow::Knot&) { return static_cast<Int>(line); })};
  const std::vector<AppendedArray> positions{by_knot("Points", 3, 0.0, [](std::size_t, const flow::Knot& k) { return k.p; })};
  const std::vector<AppendedArray> cell_data{
      by_line("line", Int(0), [](std::size_t line, const flow::Curve&) { return static_cast<Int>(line); }),
      by_line("length", 0.0, [](std::size_t, const flow::Curve& c) { return c.period(); }),
      by_line("first_end", Int(0), [](std::size_t, const flow::Curve& c) { return static_cast<Int>(c.first_end().termination); }),
      by_line("last_end", Int(0), [](std::size_t, const flow::Curve& c) { return static_cast<Int>(c.last_end().termination); })};
  Int next = 0;
  std::size_t offset_of_line = 0;
  const std::vector<AppendedArray> cells{by_knot("connectivity", 1, Int(0), [&next](std::size_t, const flow::Knot&) { return next++; }),
                                         by_line("offsets", Int(0), [&offset_of_line](std::size_t, const flow::Curve& c) {
                                           return static_cast<Int>(offset_of_line += c.knots().size());
                                         })};

  VtkXmlWriter file(out, "PolyData", "",
                    fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\"",
                                points, curves.size()));
  const bool is_timed = !curves.empty() && !curves.front()->times().empty();
  file.add_section("PointData", is_timed ? "Scalars=\"s\" Vectors=\"tangent\"" : "Scalars=\"s\" Vectors=\"velocity\"", point_data);
  file.add_section("CellData", "Scalars=\"line\"", cell_data);
  file.add_section("Points", "", positions);
  file.add_section("Lines", "", cells);
  file.finish();
}

}  // namespace catena::curves
