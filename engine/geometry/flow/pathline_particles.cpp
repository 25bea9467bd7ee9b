// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/pathline_particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "engine/base/threads.h"

namespace catena::flow {
namespace {

std::size_t count_knots(std::span<const Particle> particles) {
  std::size_t knots = 0;
  for (const Particle& particle : particles) knots += particle.knots.size();
  return knots;
}

/// Calls work(make_source(), next particle) for all particles, with one source per core. A particle that the interval does not concern is
/// left as it is.
template <class MakeSource>
void march_all(std::span<Particle> particles, double from, double until, double sign, double length, const MoveOptions& options,
               const MakeSource& make_source) {
  std::atomic<std::size_t> next{0}, knots{count_knots(particles)};
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  parallel_for(std::min(cores, particles.size()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t worker = begin; worker < end; ++worker)
      make_source([&](auto& source) {
        ParticleMarch march(source, sign, length, options.tolerance, options.max_knots);
        for (std::size_t at; (at = next.fetch_add(1, std::memory_order_relaxed)) < particles.size();) {
          Particle& particle = particles[at];
          const bool concerns = sign > 0 ? particle.time >= from && particle.time < until : particle.time <= from && particle.time > until;
          if (!concerns || particle.end) continue;
          if (particle.keeps_knots && knots.load(std::memory_order_relaxed) > options.max_all_knots) return;  // an error for check_knots()
          const std::size_t before = particle.knots.size();
          march.march(particle, until);
          knots.fetch_add(particle.knots.size() - before, std::memory_order_relaxed);
        }
      });
  });
}

Outcome check_knots(std::span<const Particle> particles, const MoveOptions& options) {
  if (count_knots(particles) <= options.max_all_knots) return Done{};
  return Error{fmt::format("the lines of {} seeds have more than {} points together; fewer seeds or a shorter time were expected",
                           particles.size(), options.max_all_knots)};
}

}  // namespace

Result<double> move_particles(const UnsteadyField& field, std::span<Particle> particles, double until, const MoveOptions& options) {
  double first = until, last = until;
  for (const Particle& particle : particles) {
    first = std::min(first, particle.time);
    last = std::max(last, particle.time);
  }
  const double sign = first < until ? 1 : -1;
  if (field.make_formula) {
    const double length = max_abs(field.box.hi - field.box.lo);
    march_all(particles, sign > 0 ? first : last, until, sign, length, options, [&](auto&& work) {
      const std::unique_ptr<UnsteadyFormula> formula = field.make_formula();
      FormulaPathSource source(*formula, field.box);
      work(source);
    });
    CATENA_CHECK(check_knots(particles, options));
    return length;
  }
  const std::vector<double>& times = field.times;
  const auto interval_of = [&](double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - 1, 0, static_cast<std::ptrdiff_t>(times.size()) - 2));
  };
  const std::size_t begin = interval_of(first);
  std::size_t end = interval_of(last);
  if (end > begin && times[end] == last) --end;
  const std::size_t count = end - begin + 1;
  StepWindow window(field);
  double length = 0;
  for (std::size_t k = 0; k < count; ++k) {
    CATENA_TRY(const TimeInterval interval, window.enter(sign > 0 ? begin + k : end - k));
    length = interval.grids[0]->domain_length();
    const double from = sign > 0 ? interval.begin : interval.end;
    const double to = sign > 0 ? std::min(until, interval.end) : std::max(until, interval.begin);
    march_all(particles, from, to, sign, length, options, [&](auto&& work) {
      CellPathSource source(interval);
      work(source);
    });
    CATENA_CHECK(check_knots(particles, options));
    if (options.progress) options.progress(static_cast<double>(k + 1) / static_cast<double>(count));
  }
  return length;
}

}  // namespace catena::flow
