// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/vortex_core_tracer.h"

#include <algorithm>
#include <optional>

namespace catena::flow {
namespace {

constexpr int kCoreCorrections = 16, kCoreHalvings = 4, kCoreEndHalvings = 12;
constexpr double kCoreTurn = 0.5;               // minimum cosine of the angle between two steps
constexpr double kCoreTolerance = 1e-13;        // as a fraction of L
constexpr double kKinkTolerance = 1e-3;         // as a fraction of the spacing: accepted where grad v has a kink
constexpr double kSameCore = 0.5;               // as a fraction of the spacing: points this close belong to one line
constexpr double kLastStep = 0.3;               // minimum length of the last step of a line, as a fraction of the step size
constexpr std::size_t kMaxCoreSteps = 400'000;  // per line and direction

}  // namespace

CoreTracer::CoreTracer(const field::VectorField& field, CoreCriterion criterion, double scale, double step, double spacing, bool has_kinks)
    : flow_(field, criterion, scale),
      step_(step),
      spacing_(spacing),
      difference_(has_kinks ? 0.02 * spacing : 1e-4 * field.domain_length()),
      tolerance_(kCoreTolerance * field.domain_length()),
      rough_(has_kinks ? kKinkTolerance * spacing : 1e-9 * field.domain_length()) {}

/// Corrects a point to the core line by Newton's method in the plane through `position` orthogonal to `along`.
CoreTracer::CorrectedPoint CoreTracer::correct(Vec3 position, const Vec3& along) {
  CorrectedPoint out;
  const Vec3 from = position;
  Vec3 a, b;
  perpendicular_basis(along, a, b);
  CoreSample current = flow_.sample_at(position);
  double last = 0;
  for (int i = 0; i < kCoreCorrections; ++i) {
    out.exits_domain = !current.is_inside;
    if (!current.is_vortex) return out;
    const CoreSample at_a = flow_.sample_at(position + a * difference_), at_b = flow_.sample_at(position + b * difference_);
    if (!at_a.is_vortex || !at_b.is_vortex) {
      out.exits_domain = !at_a.is_inside || !at_b.is_inside;
      return out;
    }
    // least squares: the residual has three components, the plane has two
    const Vec3 fa = (at_a.residual - current.residual) * (1 / difference_), fb = (at_b.residual - current.residual) * (1 / difference_);
    const double aa = dot(fa, fa), ab = dot(fa, fb), bb = dot(fb, fb), det = aa * bb - ab * ab;
    if (!(det > 1e-6 * aa * bb)) return out;
    const double ra = -dot(fa, current.residual), rb = -dot(fb, current.residual);
    Vec3 step = a * ((bb * ra - ab * rb) / det) + b * ((aa * rb - ab * ra) / det);
    if (const double length = norm(step); length > 0.5 * spacing_) step *= 0.5 * spacing_ / length;
    const double full_length = norm(step);
    // halve the step until the residual decreases
    CoreSample next;
    bool improved = false;
    for (int k = 0; k < kCoreHalvings && !improved; ++k, step *= improved ? 1 : 0.5) {
      next = flow_.sample_at(position + step);
      improved = next.is_vortex && norm(next.residual) < norm(current.residual);
    }
    if (improved) {
      if (norm(position + step - from) > 2 * spacing_) return out;
      position += step;
      current = next;
    }
    out.position = position;
    out.sample = current;
    if (!improved || full_length <= tolerance_) {
      out.ok = full_length <= rough_;
      return out;
    }
    last = full_length;
  }
  out.ok = last <= rough_;
  return out;
}

std::uint64_t CoreTracer::bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return (static_cast<std::uint64_t>(x) & 0x1fffff) | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
         (static_cast<std::uint64_t>(z) & 0x1fffff) << 42;
}

/// Returns true if a recorded line passes near `position`; the last points of the line `own`, which is being traced, are ignored.
bool CoreTracer::is_traced(const Vec3& position, std::uint32_t own) const {
  constexpr std::size_t kLast = 8;
  const Vec3 at = position * (1 / spacing_);
  const auto x = static_cast<std::int64_t>(std::floor(at.x)), y = static_cast<std::int64_t>(std::floor(at.y)),
             z = static_cast<std::int64_t>(std::floor(at.z));
  for (int c = 0; c < 27; ++c) {
    const auto found = recorded_.find(bucket(x + c % 3 - 1, y + c / 3 % 3 - 1, z + c / 9 - 1));
    if (found == recorded_.end()) continue;
    for (const RecordedPoint& one : found->second)
      if (norm(one.position - position) < (one.line == own ? kSameCore * step_ : kSameCore * spacing_) &&
          (one.line != own || one.number + kLast < point_count_))
        return true;
  }
  return false;
}

void CoreTracer::record(const Vec3& position) {
  const Vec3 at = position * (1 / spacing_);
  recorded_[bucket(static_cast<std::int64_t>(std::floor(at.x)), static_cast<std::int64_t>(std::floor(at.y)),
                   static_cast<std::int64_t>(std::floor(at.z)))]
      .push_back({position, line_, point_count_});
  ++point_count_;
}

/// Traces the line in one direction; returns true if it returns to its start (closed line).
bool CoreTracer::follow(const CorrectedPoint& from, Vec3 along, CoreTrace& out, bool& leaves) {
  Vec3 position = from.position;
  std::optional<Vec3> last_direction;
  while (out.points.size() < kMaxCoreSteps) {
    // predictor: extrapolates the turn of the last step
    CorrectedPoint next;
    double size = 1;
    for (; size >= 0.25 && !next.ok; size *= 0.5) {
      next = correct(position + along * (size * step_), along);
      if (next.ok && (dot(direction(next.position - position), along) < kCoreTurn || norm(next.position - position) > 2 * step_))
        next.ok = false;
      if (next.ok) break;
    }
    if (!next.ok) {
      // bisection for the end of the line
      double lo = 0, hi = 2 * size;
      CorrectedPoint end;
      leaves = next.exits_domain;
      for (int i = 0; i < kCoreEndHalvings; ++i) {
        const double middle = 0.5 * (lo + hi);
        CorrectedPoint at = correct(position + along * (middle * step_), along);
        leaves = at.ok ? leaves : at.exits_domain;
        if (!at.ok) {
          hi = middle;
          continue;
        }
        lo = middle;
        end = at;
      }
      if (end.ok) {
        // a very short last step would bend the spline
        if (norm(end.position - position) < kLastStep * step_ && out.points.size() > 1) {
          out.points.pop_back();
          out.swirls.pop_back();
        }
        out.points.push_back(end.position);
        out.swirls.push_back(end.sample.swirl);
        record(end.position);
      }
      return false;
    }
    const Vec3 step_direction = direction(next.position - position);
    along = last_direction ? direction(step_direction * 2.0 - *last_direction) : step_direction;
    if (dot(along, step_direction) < kCoreTurn) along = step_direction;
    last_direction = step_direction;
    position = next.position;
    if (out.points.size() > 3 && norm(position - from.position) < 0.75 * step_) return true;
    out.points.push_back(position);
    out.swirls.push_back(next.sample.swirl);
    record(position);
    if (is_traced(position, line_)) return false;
  }
  return false;
}

bool CoreTracer::trace(const CoreSeed& seed, CoreTrace& out) {
  if (is_traced(seed.position, ~0u)) return false;
  CorrectedPoint found = correct(seed.position, seed.axis);
  if (!found.ok || norm(found.position - seed.position) > 1.5 * spacing_ || is_traced(found.position, ~0u)) return false;
  record(found.position);
  CoreTrace back;
  bool leaves = false;
  out.closed = follow(found, found.sample.axis, out, leaves);
  out.last_exits_domain = leaves;
  if (!out.closed) {
    leaves = false;
    follow(found, -found.sample.axis, back, leaves);
    out.first_exits_domain = leaves;
  }
  ++line_;
  std::reverse(back.points.begin(), back.points.end());
  std::reverse(back.swirls.begin(), back.swirls.end());
  back.points.push_back(found.position);
  back.swirls.push_back(found.sample.swirl);
  out.points.insert(out.points.begin(), back.points.begin(), back.points.end());
  out.swirls.insert(out.swirls.begin(), back.swirls.begin(), back.swirls.end());
  return out.points.size() >= 2;
}

void join_traces(std::vector<CoreTrace>& traces, double max_gap) {
  constexpr double kLeads = 0.7;            // minimum cosine
  constexpr std::size_t kMaxJoined = 3000;  // lines: all pairs are compared
  if (traces.size() > kMaxJoined) return;
  const auto reversed = [](CoreTrace& line) {
    std::reverse(line.points.begin(), line.points.end());
    std::reverse(line.swirls.begin(), line.swirls.end());
    std::swap(line.first_exits_domain, line.last_exits_domain);
  };
  const auto leaving = [](const CoreTrace& line) {
    const std::size_t n = line.points.size();
    return direction(line.points[n - 1] - line.points[n - std::min<std::size_t>(n, 4)]);
  };
  /// Returns true if `line` can continue from its last point to the first point of `other`.
  const auto continues = [&](const CoreTrace& line, const CoreTrace& other) {
    const Vec3 gap = other.points.front() - line.points.back();
    if (line.last_exits_domain || other.first_exits_domain || norm(gap) > max_gap) return false;
    const Vec3 on = direction(other.points[std::min<std::size_t>(3, other.points.size() - 1)] - other.points.front());
    return dot(leaving(line), on) > kLeads && dot(gap, leaving(line)) > -0.3 * max_gap;
  };
  for (std::size_t i = 0; i < traces.size(); ++i) {
    bool joined = !traces[i].points.empty();
    while (joined) {
      joined = false;
      for (int side = 0; side < 2 && !traces[i].closed; ++side, reversed(traces[i])) {
        for (std::size_t k = i + 1; k < traces.size() && !traces[i].closed; ++k) {
          CoreTrace& other = traces[k];
          if (other.points.empty() || other.closed) continue;
          bool on = continues(traces[i], other);
          if (!on) {
            reversed(other);
            on = continues(traces[i], other);
            if (!on) continue;
          }
          // points of `other` that overlap `line` are omitted
          const Vec3 end_direction = leaving(traces[i]);
          std::size_t from = 0;
          while (from + 1 < other.points.size() && dot(other.points[from] - traces[i].points.back(), end_direction) < 0.1 * max_gap) ++from;
          const auto skipped = static_cast<std::ptrdiff_t>(from);
          traces[i].points.insert(traces[i].points.end(), other.points.begin() + skipped, other.points.end());
          traces[i].swirls.insert(traces[i].swirls.end(), other.swirls.begin() + skipped, other.swirls.end());
          traces[i].last_exits_domain = other.last_exits_domain;
          other.points.clear();
          joined = true;
        }
      }
    }
    if (traces[i].points.size() > 8 && !traces[i].closed && continues(traces[i], traces[i])) traces[i].closed = true;
  }
  std::erase_if(traces, [](const CoreTrace& line) { return line.points.size() < 2; });
}

}  // namespace catena::flow
