// SPDX-License-Identifier: MIT
#include "engine/io/mesh/write_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/base/vtk_xml_writer.h"
#include "engine/io/formats.h"

namespace catena::mesh {

void write_vtp(OutputFile& out, const MeshExport& s) {
  const auto doubles = [](const std::string& name, int components, const double* data, std::size_t count) {
    return AppendedArray{"Float64", name, components, count * sizeof(double),
                         [data, count](OutputFile& to) { write_bytes(to, data, count * sizeof(double)); }};
  };
  const auto vectors = [&](const std::string& name, const std::vector<Vec3>& v) {
    return doubles(name, 3, v.empty() ? nullptr : &v.front().x, 3 * v.size());
  };
  std::vector<AppendedArray> values;
  if (!s.normals.empty()) values.push_back(vectors("Normals", s.normals));
  for (const PointValues& v : s.values) values.push_back(doubles(v.name, v.components, v.values.data(), v.values.size()));
  const auto numbers = [&](const std::string& name, std::size_t count, auto&& number) {
    return AppendedArray{"Int64", name, 1, count * sizeof(std::int64_t), [&s, number](OutputFile& to) {
                           std::int64_t n = 0;
                           for (const Triangle& t : s.triangles) number(to, t, n);
                         }};
  };
  VtkXmlWriter file(out, "PolyData", "",
                    fmt::format("NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\"",
                                s.points.size(), s.triangles.size()));
  file.add_section("PointData", s.normals.empty() ? "" : "Normals=\"Normals\"", std::move(values));
  file.add_section("Points", "", {vectors("Points", s.points)});
  file.add_section("Polys", "",
                   {numbers("connectivity", 3 * s.triangles.size(),
                            [](OutputFile& to, const Triangle& t, std::int64_t&) {
                              const std::array<std::int64_t, 3> corners{t[0], t[1], t[2]};
                              write_bytes(to, corners.data(), sizeof corners);
                            }),
                    numbers("offsets", s.triangles.size(), [](OutputFile& to, const Triangle&, std::int64_t& end) {
                      end += 3;
                      write_bytes(to, &end, sizeof end);
                    })});
  file.finish();
}

void write_ply(OutputFile& out, const MeshExport& s) {
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", s.points.size());
  for (const char* axis : {"x", "y", "z"}) header += fmt::format("property double {}\n", axis);
  for (const char* axis : {"nx", "ny", "nz"})
    if (!s.normals.empty()) header += fmt::format("property double {}\n", axis);
  out.write(header + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", s.triangles.size()));
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    write_bytes(out, &s.points[i], sizeof(Vec3));
    if (!s.normals.empty()) write_bytes(out, &s.normals[i], sizeof(Vec3));
  }
  for (const Triangle& t : s.triangles) {
    const std::uint8_t corners = 3;
    write_bytes(out, &corners, 1);
    write_bytes(out, t.data(), sizeof t);
  }
}

void write_stl(OutputFile& out, const MeshExport& s) {
  char header[80]{};
  std::strncpy(header, "binary, world units", sizeof header - 1);
  write_bytes(out, header, sizeof header);
  const auto count = static_cast<std::uint32_t>(s.triangles.size());
  write_bytes(out, &count, sizeof count);
  for (const Triangle& t : s.triangles) {
    const Vec3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
    float numbers[12];
    int n = 0;
    for (const Vec3& v : {direction(cross(b - a, c - a)), a, b, c})
      for (int axis = 0; axis < 3; ++axis) numbers[n++] = static_cast<float>(v[axis]);
    write_bytes(out, numbers, sizeof numbers);
    const std::uint16_t attributes = 0;
    write_bytes(out, &attributes, sizeof attributes);
  }
}

void write_obj(OutputFile& out, const MeshExport& s) {
  const auto lines = [&](const char* word, const std::vector<Vec3>& vectors) {
    for (const Vec3& v : vectors) out.write(fmt::format("{} {} {} {}\n", word, to_text(v.x), to_text(v.y), to_text(v.z)));
  };
  lines("v", s.points);
  lines("vn", s.normals);
  for (const Triangle& t : s.triangles) {
    std::string line = "f";
    for (const std::uint32_t corner : t) line += s.normals.empty() ? fmt::format(" {}", corner + 1) : fmt::format(" {0}//{0}", corner + 1);
    out.write(line + "\n");
  }
}

std::string describe_precision_loss(const std::string& path, const MeshExport& surface) {
  constexpr double kMinReportedShare = 0.01;  // fraction of degenerate triangles that is reported: isosurfaces always have some slivers
  const io::Format* format = io::find_writer(path, io::DataKind::mesh);
  if (format == nullptr || !format->has_float_positions) return {};
  const auto rounded = [&](std::uint32_t n) { return glm::vec3(surface.points[n]); };
  const auto flat = std::ranges::count_if(surface.triangles, [&](const Triangle& t) {
    const auto same = [&](int a, int b) { return surface.points[t[a]] != surface.points[t[b]] && rounded(t[a]) == rounded(t[b]); };
    return same(0, 1) || same(1, 2) || same(2, 0);
  });
  if (!(static_cast<double>(flat) > kMinReportedShare * static_cast<double>(surface.triangles.size()))) return {};
  return fmt::format(
      "{} of {} triangles have two coincident corners in this format, because 32-bit coordinates are too coarse so far from the origin "
      "(.ply and .vtp store 64 bits)",
      flat, surface.triangles.size());
}

Outcome write_mesh(const std::string& path, const MeshExport& surface) {
  const io::Format* format = io::find_writer(path, io::DataKind::mesh);
  if (format == nullptr) return Error{path + ": expected an output that ends in " + io::writable_extensions(io::DataKind::mesh)};
  CATENA_TRY(OutputFile out, OutputFile::open(path));
  format->write_mesh(out, surface);
  return out.commit();
}

}  // namespace catena::mesh
