#include "engine/app/lines_file.h"

#include <fmt/core.h>

#include <bit>
#include <cstring>
#include <functional>
#include <span>

#include "engine/base/numbers.h"

namespace catena::app {

namespace {

static_assert(std::endian::native == std::endian::little, "the appended data is written as it lies in memory");

/// One array of the appended section: where it goes in the header, and how its bytes are made.
struct Appended {
  std::string header;  ///< up to offset=
  std::size_t bytes = 0;
  std::function<void(OutputFile&)> write;
};

void write_bytes(OutputFile& out, const void* data, std::size_t size) { out.write({static_cast<const char*>(data), size}); }

template <class T>
std::string header_of(const char* name, int components) {
  const char* type = std::is_same_v<T, double> ? "Float64" : "Int64";
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=", type, name, components);
}

}  // namespace

void write_lines_csv(OutputFile& out, const std::vector<flow::CurvePtr>& curves) {
  out.write("line,s,x,y,z,tx,ty,tz\n");
  std::string row;
  for (std::size_t line = 0; line < curves.size(); ++line)
    for (const flow::Knot& knot : curves[line]->knots()) {
      row = std::to_string(line);
      for (const double x : {knot.s, knot.p.x, knot.p.y, knot.p.z, knot.t.x, knot.t.y, knot.t.z}) {
        row += ',';
        append_text(row, x);
      }
      row += '\n';
      out.write(row);
    }
}

void write_lines_vtp(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField& field) {
  std::size_t points = 0;
  for (const auto& curve : curves) points += curve->knots().size();

  // by point, by line
  const auto by_knot = [&]<class T>(const char* name, int components, T, auto&& value) {
    return Appended{header_of<T>(name, components), points * components * sizeof(T), [&curves, components, value](OutputFile& to) {
                      for (std::size_t line = 0; line < curves.size(); ++line)
                        for (const flow::Knot& knot : curves[line]->knots()) {
                          const auto v = value(line, knot);
                          write_bytes(to, &v, components * sizeof(T));
                        }
                    }};
  };
  const auto by_line = [&]<class T>(const char* name, T, auto&& value) {
    return Appended{header_of<T>(name, 1), curves.size() * sizeof(T), [&curves, value](OutputFile& to) {
                      for (std::size_t line = 0; line < curves.size(); ++line) {
                        const T v = value(line, *curves[line]);
                        write_bytes(to, &v, sizeof(T));
                      }
                    }};
  };
  using Int = std::int64_t;
  field::Cursor cursor;
  const std::vector<Appended> point_data{
      by_knot("s", 1, 0.0, [](std::size_t, const flow::Knot& k) { return k.s; }),
      by_knot("tangent", 3, 0.0, [](std::size_t, const flow::Knot& k) { return k.t; }),
      by_knot("velocity", 3, 0.0, [&](std::size_t, const flow::Knot& k) { return field.sample(k.p, cursor).value; }),
      by_knot("line", 1, Int(0), [](std::size_t line, const flow::Knot&) { return static_cast<Int>(line); })};
  const std::vector<Appended> places{by_knot("Points", 3, 0.0, [](std::size_t, const flow::Knot& k) { return k.p; })};
  const std::vector<Appended> cell_data{
      by_line("line", Int(0), [](std::size_t line, const flow::Curve&) { return static_cast<Int>(line); }),
      by_line("length", 0.0, [](std::size_t, const flow::Curve& c) { return c.period(); }),
      by_line("first_end", Int(0), [](std::size_t, const flow::Curve& c) { return static_cast<Int>(c.first_end().end); }),
      by_line("last_end", Int(0), [](std::size_t, const flow::Curve& c) { return static_cast<Int>(c.last_end().end); })};
  Int next = 0;
  std::size_t offset_of_line = 0;
  const std::vector<Appended> cells{by_knot("connectivity", 1, Int(0), [&next](std::size_t, const flow::Knot&) { return next++; }),
                                    by_line("offsets", Int(0), [&offset_of_line](std::size_t, const flow::Curve& c) {
                                      return static_cast<Int>(offset_of_line += c.knots().size());
                                    })};

  // header
  out.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n");
  out.write(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                        points, curves.size()));
  std::size_t offset = 0;
  const auto section = [&](const char* open, const char* close, const std::vector<Appended>& arrays) {
    out.write(open);
    for (const Appended& array : arrays) {
      out.write(fmt::format("{}\"{}\"/>\n", array.header, offset));
      offset += sizeof(std::uint64_t) + array.bytes;
    }
    out.write(close);
  };
  section("<PointData Scalars=\"s\" Vectors=\"velocity\">\n", "</PointData>\n", point_data);
  section("<CellData Scalars=\"line\">\n", "</CellData>\n", cell_data);
  section("<Points>\n", "</Points>\n", places);
  section("<Lines>\n", "</Lines>\n", cells);

  // data, in the same order
  out.write("</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
  for (const auto* arrays : {&point_data, &cell_data, &places, &cells})
    for (const Appended& array : *arrays) {
      const std::uint64_t bytes = array.bytes;
      write_bytes(out, &bytes, sizeof bytes);
      array.write(out);
    }
  out.write("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace catena::app
