// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "engine/base/numbers.h"
#include "engine/geometry/flow/pathline_particles.h"
#include "engine/geometry/flow/pathlines.h"

namespace catena::flow {
namespace {

constexpr int kFirstReleases = 8;         // in each interval of a series
constexpr int kFirstOfFormula = 64;       // of a formula
constexpr int kPasses = 12;               // over the series
constexpr int kSections = 8;              // of an interval in which particles begin to leave the domain
constexpr double kExitResolution = 1e-6;  // of the time of an exit, as a share of the whole time

/// A particle of a streak line at the time at which the line is seen.
struct Release {
  double time = 0;
  Vec3 position{0.0};
  SampleStatus lost = SampleStatus::ok;  ///< Why it has left the domain; ok: it is there.
  bool is_open = true;                   ///< The interval to the next release has to be refined.
  bool is_new = false;                   ///< Added in the current pass.
  bool is_there() const { return lost == SampleStatus::ok; }
};
using Releases = std::vector<Release>;  // times falling

/// dp/dtime at release k: the derivative of the parabola through it and its neighbors, or of the line through two.
Vec3 time_derivative(std::span<const Release> line, std::size_t k) {
  const std::size_t first = k == 0 ? 0 : k - 1, last = std::min(first + 2, line.size() - 1);
  const std::size_t begin = last - first < 2 && first > 0 ? first - 1 : first;
  if (last - begin < 2) return (line[last].position - line[begin].position) / (line[last].time - line[begin].time);
  Vec3 d(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Release &a = line[begin + i], &b = line[begin + (i + 1) % 3], &c = line[begin + (i + 2) % 3];
    d += a.position * (((line[k].time - b.time) + (line[k].time - c.time)) / ((a.time - b.time) * (a.time - c.time)));
  }
  return d;
}

Hermite cubic(std::span<const Release> line, std::size_t k) {
  const Release &a = line[k], &b = line[k + 1];
  return {a.position, b.position - a.position, b.time - a.time, time_derivative(line, k), time_derivative(line, k + 1)};
}

/// Pieces of a line whose particles are all there.
std::vector<std::span<const Release>> pieces_of(const Releases& line) {
  std::vector<std::span<const Release>> pieces;
  for (std::size_t i = 0; i < line.size();) {
    std::size_t end = i;
    while (end < line.size() && line[end].is_there()) ++end;
    if (end - i >= 2) pieces.emplace_back(line.data() + i, end - i);
    i = std::max(end, i + 1);
  }
  return pieces;
}

/// Adds releases where the line is not known well enough yet. Returns whether there are any.
bool refine(Releases& line, double whole_time) {
  Releases finer;
  bool any = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    finer.push_back(line[i]);
    if (i + 1 == line.size() || !line[i].is_open) continue;
    const Release &a = line[i], &b = line[i + 1];
    if (!a.is_there() && !b.is_there()) continue;
    const bool leaves = a.is_there() != b.is_there();
    if (leaves && a.time - b.time <= kExitResolution * whole_time) continue;
    const int sections = leaves ? kSections : 2;
    for (int k = 1; k < sections; ++k) {
      Release release;
      release.time = a.time + (b.time - a.time) * k / sections;
      release.is_new = true;
      finer.push_back(release);
      any = true;
    }
  }
  line = std::move(finer);
  return any;
}

/// Closes the intervals in which the cubic through the old releases is within `tolerance` of the new one, half way between them.
void close_intervals(Releases& line, double tolerance) {
  Releases old;
  for (const Release& release : line)
    if (!release.is_new) old.push_back(release);
  std::size_t before = 0;  // number of old releases up to here
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Release& release = line[i];
    if (!release.is_new) {
      ++before;
      continue;
    }
    if (line[i - 1].is_new || !line[i - 1].is_there() || !release.is_there() || i + 1 == line.size() || line[i + 1].is_new ||
        !line[i + 1].is_there())
      continue;
    std::size_t first = before - 1, last = before + 1;
    while (first > 0 && old[first - 1].is_there()) --first;
    while (last < old.size() && old[last].is_there()) ++last;
    const Vec3 expected = cubic(std::span(old).subspan(first, last - first), before - 1 - first).evaluate(0.5);
    if (norm(expected - release.position) <= tolerance) line[i - 1].is_open = line[i].is_open = false;
  }
  for (Release& release : line) release.is_new = false;
}

CurvePtr curve_of(std::span<const Release> piece, LineEnd first_end, LineEnd last_end, double length) {
  std::vector<Knot> knots;
  std::vector<double> times;
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const double step = k == 0 ? 0 : cubic(piece, k - 1).length();
    if (k > 0 && step < 1e-13 * length) continue;  // the particles rest at the same position
    knots.push_back({k == 0 ? 0 : knots.back().s + step, piece[k].position, -direction(time_derivative(piece, k))});
    times.push_back(piece[k].time);
  }
  if (knots.size() < 2) return nullptr;
  return std::make_shared<const Curve>(std::move(knots), false, first_end, last_end, length, std::move(times));
}

Releases first_releases(const UnsteadyField& field, const PathlineOptions& options) {
  std::vector<double> marks{options.start};
  for (const double time : field.times)
    if (!field.make_formula && time > options.start && time < options.end) marks.push_back(time);
  marks.push_back(options.end);
  const int count = field.make_formula ? kFirstOfFormula : kFirstReleases;
  Releases line;
  for (std::size_t i = 0; i + 1 < marks.size(); ++i)
    for (int k = 0; k < count; ++k) line.push_back({marks[i] + (marks[i + 1] - marks[i]) * k / count, Vec3(0.0), {}, true, true});
  line.push_back({options.end, Vec3(0.0), {}, true, true});
  std::ranges::reverse(line);
  return line;
}

}  // namespace

Result<std::vector<Result<std::vector<CurvePtr>>>> trace_streaklines(const UnsteadyField& field, std::span<const Vec3> seeds,
                                                                     const PathlineOptions& options) {
  const Releases first = first_releases(field, options);
  if (seeds.size() * first.size() > options.max_all_knots)
    return Error{
        fmt::format("there are {} seeds; for streak lines at most {} were expected", seeds.size(), options.max_all_knots / first.size())};
  std::vector<Releases> lines(seeds.size(), first);
  double length = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    // particles of all new releases
    std::vector<Particle> particles;
    for (std::size_t i = 0; i < seeds.size(); ++i)
      for (const Release& release : lines[i])
        if (release.is_new) particles.push_back({seeds[i], release.time});
    if (particles.empty()) break;
    const MoveOptions move{options.tolerance, 0, 0, [&](double share) {
                             if (options.progress) options.progress((pass + share) / (pass + 1.5));
                           }};
    CATENA_TRY(length, move_particles(field, particles, options.end, move));
    std::size_t next = 0;
    for (Releases& line : lines) {
      std::size_t there = 0;
      for (Release& release : line) {
        if (release.is_new) {
          const Particle& particle = particles[next++];
          release.position = particle.position;
          if (particle.end) release.lost = particle.end->status == SampleStatus::ok ? SampleStatus::outside_box : particle.end->status;
        }
        there += release.is_there();
      }
      if (pass == 0)
        for (Release& release : line) release.is_new = false;
      else
        close_intervals(line, options.streak_tolerance * length);
      if (there == 0 || line.size() > options.max_knots / 2 || 2 * seeds.size() * line.size() > options.max_all_knots ||
          pass + 1 == kPasses || !refine(line, options.end - options.start))
        for (Release& release : line) release.is_open = false;
    }
  }
  std::vector<Result<std::vector<CurvePtr>>> results;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    std::vector<CurvePtr> curves;
    const Release *begin_of_line = lines[i].data(), *last = begin_of_line + lines[i].size();
    for (const std::span<const Release> piece : pieces_of(lines[i])) {
      const Release *before = piece.data() - 1, *after = piece.data() + piece.size();
      const LineEnd first_end = piece.data() == begin_of_line ? LineEnd(Termination::time) : LineEnd(Termination::boundary, before->lost);
      const LineEnd last_end = after == last ? LineEnd(Termination::time) : LineEnd(Termination::boundary, after->lost);
      if (CurvePtr curve = curve_of(piece, first_end, last_end, length)) curves.push_back(std::move(curve));
    }
    if (curves.empty())
      results.emplace_back(
          Error{fmt::format("seed ({}, {}, {}): no particle that passes it is in the domain of {} at time {}", to_text(seeds[i].x),
                            to_text(seeds[i].y), to_text(seeds[i].z), field.name, to_text(options.end))});
    else
      results.emplace_back(std::move(curves));
  }
  return results;
}

}  // namespace catena::flow
