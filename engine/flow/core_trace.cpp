#include "engine/flow/core_trace.h"

#include <algorithm>
#include <optional>

namespace catena::flow {
namespace {

constexpr int kCoreCorrections = 16, kCoreHalvings = 4, kCoreEndHalvings = 12;
constexpr double kCoreTurn = 0.5;                // least cosine between two steps
constexpr double kCoreTolerance = 1e-13;         // of L
constexpr double kKinkTolerance = 1e-3;          // of the spacing: accepted where grad v has a kink
constexpr double kSameCore = 0.5;                // of the spacing: two places are of one line
constexpr double kLastStep = 0.3;                // of a step: the last one of a line
constexpr std::size_t kMostCoreSteps = 400'000;  // of a line, each way

}  // namespace

CoreTracer::CoreTracer(const field::VectorField& field, CoreCriterion criterion, double scale, double step, double spacing, bool has_kinks)
    : flow_(field, criterion, scale),
      step_(step),
      spacing_(spacing),
      difference_(has_kinks ? 0.02 * spacing : 1e-4 * field.length()),
      tolerance_(kCoreTolerance * field.length()),
      rough_(has_kinks ? kKinkTolerance * spacing : 1e-9 * field.length()) {}

/// Newton's method in the plane through `place` across `along`.
CoreTracer::Found CoreTracer::correct(Vec3 place, const Vec3& along) {
  Found out;
  const Vec3 from = place;
  Vec3 a, b;
  square_to(along, a, b);
  CoreSample here = flow_.at(place);
  double last = 0;
  for (int i = 0; i < kCoreCorrections; ++i) {
    out.leaves = !here.known;
    if (!here.is_vortex) return out;
    const CoreSample at_a = flow_.at(place + a * difference_), at_b = flow_.at(place + b * difference_);
    if (!at_a.is_vortex || !at_b.is_vortex) {
      out.leaves = !at_a.known || !at_b.known;
      return out;
    }
    // least squares: miss has three components and the plane two
    const Vec3 fa = (at_a.miss - here.miss) * (1 / difference_), fb = (at_b.miss - here.miss) * (1 / difference_);
    const double aa = dot(fa, fa), ab = dot(fa, fb), bb = dot(fb, fb), det = aa * bb - ab * ab;
    if (!(det > 1e-6 * aa * bb)) return out;
    const double ra = -dot(fa, here.miss), rb = -dot(fb, here.miss);
    Vec3 way = a * ((bb * ra - ab * rb) / det) + b * ((aa * rb - ab * ra) / det);
    if (const double far = norm(way); far > 0.5 * spacing_) way *= 0.5 * spacing_ / far;
    const double full = norm(way);
    // halved where it does not come nearer
    CoreSample next;
    bool nearer = false;
    for (int k = 0; k < kCoreHalvings && !nearer; ++k, way *= nearer ? 1 : 0.5) {
      next = flow_.at(place + way);
      nearer = next.is_vortex && norm(next.miss) < norm(here.miss);
    }
    if (nearer) {
      if (norm(place + way - from) > 2 * spacing_) return out;
      place += way;
      here = next;
    }
    out.place = place;
    out.sample = here;
    if (!nearer || full <= tolerance_) {
      out.ok = full <= rough_;
      return out;
    }
    last = full;
  }
  out.ok = last <= rough_;
  return out;
}

std::uint64_t CoreTracer::bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return (static_cast<std::uint64_t>(x) & 0x1fffff) | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
         (static_cast<std::uint64_t>(z) & 0x1fffff) << 42;
}

/// Whether a line passes by; of the one that is being traced, its last places do not count.
bool CoreTracer::is_known(const Vec3& place, std::uint32_t own) const {
  constexpr std::size_t kLast = 8;
  const Vec3 at = place * (1 / spacing_);
  const auto x = static_cast<std::int64_t>(std::floor(at.x)), y = static_cast<std::int64_t>(std::floor(at.y)),
             z = static_cast<std::int64_t>(std::floor(at.z));
  for (int c = 0; c < 27; ++c) {
    const auto found = noted_.find(bucket(x + c % 3 - 1, y + c / 3 % 3 - 1, z + c / 9 - 1));
    if (found == noted_.end()) continue;
    for (const Noted& one : found->second)
      if (norm(one.place - place) < (one.line == own ? kSameCore * step_ : kSameCore * spacing_) &&
          (one.line != own || one.number + kLast < places_))
        return true;
  }
  return false;
}

void CoreTracer::note(const Vec3& place) {
  const Vec3 at = place * (1 / spacing_);
  noted_[bucket(static_cast<std::int64_t>(std::floor(at.x)), static_cast<std::int64_t>(std::floor(at.y)),
                static_cast<std::int64_t>(std::floor(at.z)))]
      .push_back({place, line_, places_});
  ++places_;
}

/// One way along the line; true: it came back to where it began.
bool CoreTracer::follow(const Found& from, Vec3 along, CoreTrace& out, bool& leaves) {
  Vec3 place = from.place;
  std::optional<Vec3> before;
  while (out.places.size() < kMostCoreSteps) {
    // the way goes on turning as it did
    Found next;
    double size = 1;
    for (; size >= 0.25 && !next.ok; size *= 0.5) {
      next = correct(place + along * (size * step_), along);
      if (next.ok && (dot(direction(next.place - place), along) < kCoreTurn || norm(next.place - place) > 2 * step_)) next.ok = false;
      if (next.ok) break;
    }
    if (!next.ok) {
      // where it ends, by halving
      double lo = 0, hi = 2 * size;
      Found end;
      leaves = next.leaves;
      for (int i = 0; i < kCoreEndHalvings; ++i) {
        const double middle = 0.5 * (lo + hi);
        Found at = correct(place + along * (middle * step_), along);
        leaves = at.ok ? leaves : at.leaves;
        if (!at.ok) {
          hi = middle;
          continue;
        }
        lo = middle;
        end = at;
      }
      if (end.ok) {
        // a short last step would turn the spline
        if (norm(end.place - place) < kLastStep * step_ && out.places.size() > 1) {
          out.places.pop_back();
          out.swirls.pop_back();
        }
        out.places.push_back(end.place);
        out.swirls.push_back(end.sample.swirl);
        note(end.place);
      }
      return false;
    }
    const Vec3 way = direction(next.place - place);
    along = before ? direction(way * 2.0 - *before) : way;
    if (dot(along, way) < kCoreTurn) along = way;
    before = way;
    place = next.place;
    if (out.places.size() > 3 && norm(place - from.place) < 0.75 * step_) return true;
    out.places.push_back(place);
    out.swirls.push_back(next.sample.swirl);
    note(place);
    if (is_known(place, line_)) return false;
  }
  return false;
}

bool CoreTracer::trace(const CoreSeed& seed, CoreTrace& out) {
  if (is_known(seed.place, ~0u)) return false;
  Found found = correct(seed.place, seed.axis);
  if (!found.ok || norm(found.place - seed.place) > 1.5 * spacing_ || is_known(found.place, ~0u)) return false;
  note(found.place);
  CoreTrace back;
  bool leaves = false;
  out.closed = follow(found, found.sample.axis, out, leaves);
  out.last_leaves = leaves;
  if (!out.closed) {
    leaves = false;
    follow(found, -found.sample.axis, back, leaves);
    out.first_leaves = leaves;
  }
  ++line_;
  std::reverse(back.places.begin(), back.places.end());
  std::reverse(back.swirls.begin(), back.swirls.end());
  back.places.push_back(found.place);
  back.swirls.push_back(found.sample.swirl);
  out.places.insert(out.places.begin(), back.places.begin(), back.places.end());
  out.swirls.insert(out.swirls.begin(), back.swirls.begin(), back.swirls.end());
  return out.places.size() >= 2;
}

void join_traces(std::vector<CoreTrace>& traces, double reach) {
  constexpr double kLeads = 0.7;             // least cosine
  constexpr std::size_t kMostJoined = 3000;  // lines: every two are looked at
  if (traces.size() > kMostJoined) return;
  const auto reversed = [](CoreTrace& line) {
    std::reverse(line.places.begin(), line.places.end());
    std::reverse(line.swirls.begin(), line.swirls.end());
    std::swap(line.first_leaves, line.last_leaves);
  };
  const auto leaving = [](const CoreTrace& line) {
    const std::size_t n = line.places.size();
    return direction(line.places[n - 1] - line.places[n - std::min<std::size_t>(n, 4)]);
  };
  /// From the last place of `line` to the first of `other`.
  const auto leads = [&](const CoreTrace& line, const CoreTrace& other) {
    const Vec3 way = other.places.front() - line.places.back();
    if (line.last_leaves || other.first_leaves || norm(way) > reach) return false;
    const Vec3 on = direction(other.places[std::min<std::size_t>(3, other.places.size() - 1)] - other.places.front());
    return dot(leaving(line), on) > kLeads && dot(way, leaving(line)) > -0.3 * reach;
  };
  for (std::size_t i = 0; i < traces.size(); ++i) {
    bool joined = !traces[i].places.empty();
    while (joined) {
      joined = false;
      for (int side = 0; side < 2 && !traces[i].closed; ++side, reversed(traces[i])) {
        for (std::size_t k = i + 1; k < traces.size() && !traces[i].closed; ++k) {
          CoreTrace& other = traces[k];
          if (other.places.empty() || other.closed) continue;
          bool on = leads(traces[i], other);
          if (!on) {
            reversed(other);
            on = leads(traces[i], other);
            if (!on) continue;
          }
          // the places of the two that overlap are left out
          const Vec3 ahead = leaving(traces[i]);
          std::size_t from = 0;
          while (from + 1 < other.places.size() && dot(other.places[from] - traces[i].places.back(), ahead) < 0.1 * reach) ++from;
          const auto skip = static_cast<std::ptrdiff_t>(from);
          traces[i].places.insert(traces[i].places.end(), other.places.begin() + skip, other.places.end());
          traces[i].swirls.insert(traces[i].swirls.end(), other.swirls.begin() + skip, other.swirls.end());
          traces[i].last_leaves = other.last_leaves;
          other.places.clear();
          joined = true;
        }
      }
    }
    if (traces[i].places.size() > 8 && !traces[i].closed && leads(traces[i], traces[i])) traces[i].closed = true;
  }
  std::erase_if(traces, [](const CoreTrace& line) { return line.places.size() < 2; });
}

}  // namespace catena::flow
