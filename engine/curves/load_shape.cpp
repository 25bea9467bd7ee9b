// Lines and points that the program catena-read-vtk reads: VTK's polylines, and vertices of any of its shapes.
#include "engine/base/text.h"
#include "engine/curves/load.h"
#include "engine/curves/points.h"
#include "engine/field/reader.h"

namespace catena::curves {
namespace {

Result<field::ReaderAnswer> ask_for_shape(const std::string& path, int step) {
  field::LoadRequest request;
  request.path = path;
  request.step = step;
  return field::ask_reader(field::ReadMode::shape, request);
}

Error cannot_be(const std::string& path, const std::string& what) { return Error{one_line(path + ": " + what)}; }

}  // namespace

Result<CurveSet> read_line_shape(const std::string& path, int step) {
  CATENA_TRY(const field::ReaderAnswer answer, ask_for_shape(path, step));
  const field::ShapeReply& shape = answer.reply.shape;
  const auto xyz = answer.numbers<double>(shape.points);
  const auto lines = answer.numbers<std::uint32_t>(shape.lines);
  const auto ends = answer.numbers<std::uint64_t>(shape.ends);
  const auto values = answer.numbers<float>(shape.values);
  if (lines.empty()) return cannot_be(path, "holds no lines; polylines were expected");
  const bool valued = !shape.value_name.empty() && values.size() == xyz.size() / 3;
  CATENA_TRY(Builder builder, Builder::create(path, lines.size(), valued ? std::vector{shape.value_name} : std::vector<std::string>{}));
  std::uint64_t at = 0;
  for (const std::uint64_t end : ends) {
    if (end < at || end > lines.size()) return field::damaged_answer(path, "a line ends where it cannot");
    for (; at < end; ++at) {
      const std::size_t point = lines[at];
      if (3 * point + 2 >= xyz.size()) return field::damaged_answer(path, "a line names a point that is not there");
      if (!builder.add(Vec3(xyz[3 * point], xyz[3 * point + 1], xyz[3 * point + 2]), valued ? &values[point] : nullptr))
        return cannot_be(path, "a point is not finite, or too far away; numbers up to 1e15 were expected");
    }
    builder.end_line();
  }
  CATENA_TRY(CurveSet set, builder.finish());
  set.unit = answer.reply.unit_length;
  set.patient = answer.reply.patient;
  return set;
}

Result<PointSet> read_point_shape(const std::string& path, int step) {
  CATENA_TRY(const field::ReaderAnswer answer, ask_for_shape(path, step));
  const field::ShapeReply& shape = answer.reply.shape;
  const auto xyz = answer.numbers<double>(shape.points);
  const auto values = answer.numbers<float>(shape.values);
  if (xyz.size() < 3) return cannot_be(path, "holds no points");
  PointSet set;
  std::vector<Vec3> places;
  constexpr double kFarthest = 1e15;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const Vec3 p(xyz[i], xyz[i + 1], xyz[i + 2]);
    if (!(max_abs(p) <= kFarthest)) return cannot_be(path, "a point is not finite, or too far away; numbers up to 1e15 were expected");
    places.push_back(p);
  }
  set.keep(places);
  if (!shape.value_name.empty() && values.size() == set.points.size())
    set.values.push_back({shape.value_name, {values.begin(), values.end()}});
  return set;
}

}  // namespace catena::curves
