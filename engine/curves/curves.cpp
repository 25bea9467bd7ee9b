#include "engine/curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "engine/base/text.h"

namespace catena::curves {

namespace {
std::atomic<std::uint64_t> next_version{1};
constexpr double kFarthest = 1e15;
}  // namespace

std::size_t CurveSet::bytes() const {
  return points.size() * (sizeof(glm::vec3) + values.size() * sizeof(float)) + first.size() * sizeof(std::uint32_t);
}

const PointValues* CurveSet::find(std::string_view wanted) const {
  for (const PointValues& one : values)
    if (one.name == wanted) return &one;
  return nullptr;
}

std::uint32_t CurveSet::line_of(std::uint32_t point) const {
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), point) - first.begin() - 1);
}

Result<Builder> Builder::create(std::string name, std::size_t most_points, std::vector<std::string> value_names) {
  if (most_points > kMaxPoints)
    return Error{one_line(fmt::format("{}: holds up to {} points; at most {} were expected", name, most_points, kMaxPoints))};
  const double a_point = sizeof(glm::vec3) + sizeof(std::uint32_t) / 2.0 + static_cast<double>(value_names.size() * sizeof(float));
  CATENA_CHECK(ask_for_text_memory(one_line(fmt::format("{}: {} points", name, most_points)), a_point * static_cast<double>(most_points)));
  Builder self;
  self.made_.name = std::move(name);
  self.made_.points.reserve(most_points);
  for (std::string& value : value_names) {
    self.made_.values.push_back({std::move(value), {}});
    self.made_.values.back().values.reserve(most_points);
  }
  self.made_.first = {0};
  return self;
}

bool Builder::add(const Vec3& point, const float* values) {
  if (!(max_abs(point) <= kFarthest) || !is_finite(point)) return false;
  const glm::vec3 p(point);
  rounded_ = std::max(rounded_, max_abs(point - Vec3(p)));
  if (made_.points.size() > made_.first.back() && made_.points.back() == p) return true;
  made_.points.push_back(p);
  for (std::size_t k = 0; k < made_.values.size(); ++k) made_.values[k].values.push_back(values[k]);
  return true;
}

void Builder::end_line() {
  const std::size_t begin = made_.first.back();
  if (made_.points.size() >= begin + 2) {
    made_.first.push_back(static_cast<std::uint32_t>(made_.points.size()));
    return;
  }
  made_.points.resize(begin);
  for (PointValues& one : made_.values) one.values.resize(begin);
  ++dropped_;
}

Result<CurveSet> Builder::finish() {
  CurveSet& set = made_;
  if (set.points.size() > set.first.back()) end_line();
  if (set.lines() == 0)
    return Error{one_line(set.name + ": holds no line of two different points" +
                          (dropped_ > 0 ? fmt::format(" ({} without a length)", dropped_) : std::string()) +
                          "; one or more were expected")};
  if (dropped_ > 0) set.note = fmt::format("{} line{} without a length left out", dropped_, dropped_ == 1 ? "" : "s");
  set.lowest = set.highest = Vec3(set.points.front());
  for (const glm::vec3& p : set.points)
    for (int i = 0; i < 3; ++i) {
      set.lowest[i] = std::min(set.lowest[i], static_cast<double>(p[i]));
      set.highest[i] = std::max(set.highest[i], static_cast<double>(p[i]));
    }
  // single precision parts points that lie together far from the origin
  constexpr double kOfBox = 1e-5;
  if (rounded_ > kOfBox * max_abs(set.highest - set.lowest))
    set.note += fmt::format("{}the points lie far from the origin, and are rounded by up to {:.2g}: subtract an offset from them",
                            set.note.empty() ? "" : "; ", rounded_);
  set.version = next_version.fetch_add(1);
  set.held = HeldMemory(set.bytes());
  return std::move(made_);
}

}  // namespace catena::curves
