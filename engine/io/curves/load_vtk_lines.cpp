// SPDX-License-Identifier: MIT
// Loads lines and points read by the program catena-read-vtk: VTK polylines, and vertices of any VTK data.
#include "engine/base/text.h"
#include "engine/io/client.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"

namespace catena::curves {
namespace {

Result<field::MappedResponse> ask_for_shape(const std::string& path, int step) {
  field::LoadRequest request;
  request.path = path;
  request.step = step;
  return field::run_reader(field::ReadMode::geometry, request);
}

Error cannot_be(const std::string& path, const std::string& what) { return Error{one_line(path + ": " + what)}; }

}  // namespace

Result<CurveSet> read_lines(const std::string& path, int step) {
  CATENA_TRY(const field::MappedResponse response, ask_for_shape(path, step));
  const field::GeometryResponse& shape = response.response.geometry;
  const auto xyz = response.numbers<double>(shape.points);
  const auto lines = response.numbers<std::uint32_t>(shape.lines);
  const auto ends = response.numbers<std::uint64_t>(shape.line_ends);
  const auto values = response.numbers<float>(shape.values);
  if (lines.empty()) return cannot_be(path, "contains no lines; polylines were expected");
  const bool valued = !shape.value_name.empty() && values.size() == xyz.size() / 3;
  CATENA_TRY(CurveSetBuilder builder,
             CurveSetBuilder::create(path, lines.size(), valued ? std::vector{shape.value_name} : std::vector<std::string>{}));
  std::uint64_t at = 0;
  for (const std::uint64_t end : ends) {
    if (end < at || end > lines.size()) return field::damaged_response_error(path, "the point count of a line is out of range");
    for (; at < end; ++at) {
      const std::size_t point = lines[at];
      if (3 * point + 2 >= xyz.size()) return field::damaged_response_error(path, "a line refers to a point that does not exist");
      if (!builder.add(Vec3(xyz[3 * point], xyz[3 * point + 1], xyz[3 * point + 2]), valued ? &values[point] : nullptr))
        return cannot_be(path, "a point is not finite, or too far away; numbers up to 1e15 were expected");
    }
    builder.end_line();
  }
  CATENA_TRY(CurveSet set, builder.finish());
  set.unit = response.response.unit_length;
  set.is_patient_space = response.response.is_patient_space;
  return set;
}

Result<PointSet> read_points(const std::string& path, int step) {
  CATENA_TRY(const field::MappedResponse response, ask_for_shape(path, step));
  const field::GeometryResponse& shape = response.response.geometry;
  const auto xyz = response.numbers<double>(shape.points);
  const auto values = response.numbers<float>(shape.values);
  if (xyz.size() < 3) return cannot_be(path, "contains no points");
  PointSet set;
  std::vector<Vec3> positions;
  constexpr double kMaxCoordinate = 1e15;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const Vec3 p(xyz[i], xyz[i + 1], xyz[i + 2]);
    if (!(max_abs(p) <= kMaxCoordinate)) return cannot_be(path, "a point is not finite, or too far away; numbers up to 1e15 were expected");
    positions.push_back(p);
  }
  set.set_positions(positions);
  if (!shape.value_name.empty() && values.size() == set.points.size())
    set.values.push_back({shape.value_name, {values.begin(), values.end()}});
  return set;
}

}  // namespace catena::curves
