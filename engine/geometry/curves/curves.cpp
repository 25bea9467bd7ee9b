// SPDX-License-Identifier: MIT
#include "engine/geometry/curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "engine/base/text.h"

namespace catena::curves {

namespace {
std::atomic<std::uint64_t> next_version{1};
constexpr double kMaxCoordinate = 1e15;
}  // namespace

std::size_t CurveSet::bytes() const {
  return points.size() * (sizeof(glm::vec3) + values.size() * sizeof(float)) + line_offsets.size() * sizeof(std::uint32_t);
}

const PointValues* CurveSet::find_values(std::string_view value_name) const {
  for (const PointValues& one : values)
    if (one.name == value_name) return &one;
  return nullptr;
}

std::uint32_t CurveSet::line_of(std::uint32_t point) const {
  return static_cast<std::uint32_t>(std::upper_bound(line_offsets.begin(), line_offsets.end(), point) - line_offsets.begin() - 1);
}

Result<CurveSetBuilder> CurveSetBuilder::create(std::string name, std::size_t max_points, std::vector<std::string> value_names) {
  if (max_points > kMaxPoints)
    return Error{one_line(fmt::format("{}: contains up to {} points; at most {} were expected", name, max_points, kMaxPoints))};
  const double a_point = sizeof(glm::vec3) + sizeof(std::uint32_t) / 2.0 + static_cast<double>(value_names.size() * sizeof(float));
  CATENA_CHECK(
      check_text_memory_available(one_line(fmt::format("{}: {} points", name, max_points)), a_point * static_cast<double>(max_points)));
  CurveSetBuilder self;
  self.set_.name = std::move(name);
  self.set_.points.reserve(max_points);
  for (std::string& value : value_names) {
    self.set_.values.push_back({std::move(value), {}});
    self.set_.values.back().values.reserve(max_points);
  }
  self.set_.line_offsets = {0};
  return self;
}

bool CurveSetBuilder::add(const Vec3& point, const float* values) {
  if (!(max_abs(point) <= kMaxCoordinate) || !is_finite(point)) return false;
  const glm::vec3 p(point);
  max_rounding_ = std::max(max_rounding_, max_abs(point - Vec3(p)));
  if (set_.points.size() > set_.line_offsets.back() && set_.points.back() == p) return true;
  set_.points.push_back(p);
  for (std::size_t k = 0; k < set_.values.size(); ++k) set_.values[k].values.push_back(values[k]);
  return true;
}

void CurveSetBuilder::end_line() {
  const std::size_t begin = set_.line_offsets.back();
  if (set_.points.size() >= begin + 2) {
    set_.line_offsets.push_back(static_cast<std::uint32_t>(set_.points.size()));
    return;
  }
  set_.points.resize(begin);
  for (PointValues& one : set_.values) one.values.resize(begin);
  ++dropped_;
}

Result<CurveSet> CurveSetBuilder::finish() {
  CurveSet& set = set_;
  if (set.points.size() > set.line_offsets.back()) end_line();
  if (set.line_count() == 0)
    return Error{one_line(set.name + ": contains no line with two different points" +
                          (dropped_ > 0 ? fmt::format(" ({} without a length)", dropped_) : std::string()) +
                          "; one or more were expected")};
  if (dropped_ > 0) set.note = fmt::format("{} line{} without a length left out", dropped_, dropped_ == 1 ? "" : "s");
  set.min_corner = set.max_corner = Vec3(set.points.front());
  for (const glm::vec3& p : set.points)
    for (int i = 0; i < 3; ++i) {
      set.min_corner[i] = std::min(set.min_corner[i], static_cast<double>(p[i]));
      set.max_corner[i] = std::max(set.max_corner[i], static_cast<double>(p[i]));
    }
  // far from the origin, rounding to single precision changes the distances of neighboring points
  constexpr double kOfBox = 1e-5;
  if (max_rounding_ > kOfBox * max_abs(set.max_corner - set.min_corner))
    set.note += fmt::format(
        "{}the points are far from the origin and were rounded by up to {:.2g}; subtract an offset from the coordinates to avoid this",
        set.note.empty() ? "" : "; ", max_rounding_);
  set.version = next_version.fetch_add(1);
  set.memory_reservation = MemoryReservation(set.bytes());
  return std::move(set_);
}

}  // namespace catena::curves
