// SPDX-License-Identifier: MIT
/// Streamlines of a set of seeds: points, or a pattern (line, plane, sphere, isosurface, evenly spaced); path lines and streak lines of the
/// same seeds are in unsteady_lines.h.
///   points     exact tracer, with the curves cached in the scene: a link in haptic contact with such a line uses the same object
///   widget     a seed widget is a point, a rake a pattern
///   patterns   batch tracer (engine/geometry/flow/batch_tracer.h); seeds of a pattern that start no line are left out
///   formulas   if no length is given and the seed is inside, lines end at the sampled box of the field; evenly spaced lines always do
///   tolerance  error per step, relative to L; if specified, up to 1e-9 selects the exact tracer, above it the batch tracer
/// Frame thread.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>

#include "engine/base/bounds.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Reads the value of "seeds": an array of points, or an object with one pattern or widget. Also used by `trace --seeds`.
Result<Seeds> read_seeds(const Scene& scene, const json::Node& node);

/// Returns the maximum number of knots of all lines of a set together: 40 million, or fewer if the allowed memory (memory_limit.h) holds
/// fewer. More are an error, reported before they fill the memory.
std::size_t knot_limit();

/// Some of the lines of a set, in the order of their seeds.
struct LineBlock {
  std::span<const flow::CurvePtr> curves;       ///< The lines
  std::size_t seeds_done = 0, seeds_total = 0;  ///< Number of seeds processed with this block; number of all seeds
};

/// Field of the lines to trace, and the parameters of tracing.
struct LineRequest {
  flow::Flow flow;                       ///< Vector field, line field or not, minimum speed
  double length = 0;                     ///< Maximum arc length in each direction, world units; 0: 10 L, of a formula at most to `box`
  double tolerance = 0;                  ///< Error per step, relative to L; 0: by the kind of seeds
  double max_step = 0;                   ///< Maximum step size of the batch tracer, voxels; 0: its default
  std::size_t max_knots = knot_limit();  ///< Maximum number of knots of all lines; more are an error; ignored with `visit`
  /// Progress callback: seeds of a pattern processed so far, number of all seeds.
  std::function<void(std::size_t seeds, std::size_t of)> progress{};
  std::optional<std::array<double, 2>> box{};        ///< Formula: cube in which it is sampled for images, [min, max], world
  std::function<Outcome(const LineBlock&)> visit{};  ///< Receives the lines block by block as they are traced
  std::size_t max_cached_knots = knot_limit();       ///< With `visit`: a set of more knots is not returned
  std::size_t first_seed = 0, seed_stride = 1;       ///< Only every `seed_stride`-th seed is traced, from `first_seed` on
  std::vector<std::size_t>* line_seeds = nullptr;    ///< Receives the index of each line's seed; null: not reported
  LineKind lines = LineKind::stream;                 ///< Kind of the lines
  Entity field{};                                    ///< Path lines and streak lines: field of the scene
  std::optional<std::array<double, 2>> times{};      ///< Path lines and streak lines: as in StreamlineSet
  std::string seed_table{};                          ///< Path lines and streak lines: table of the seeds, for errors
  bool is_cubic_in_time = false;                     ///< Path lines and streak lines: as in StreamlineSet

  /// Index among all seeds of the k-th seed that is traced.
  std::size_t seed_index(std::size_t k) const { return first_seed + k * seed_stride; }
};

/// Returns the error message for lines of `seeds` seeds that have more than `max_knots` knots together after `done` seeds.
std::string too_many_knots_message(std::size_t seeds, std::size_t done, std::size_t max_knots);

/// Progress callback: called repeatedly while the lines of a pattern are traced in the named field, and at the end with seeds = of = 0.
/// Called on any thread that builds frames.
using TraceProgress = std::function<void(const std::string& field, std::size_t seeds, std::size_t of)>;
/// Sets the callback. Call before any set is traced.
void set_trace_progress(TraceProgress callback);

/// Traces all lines of the seeds. Error, at the seed's position in the file: a listed point that starts no line, or a pattern of which no
/// point starts one. Seeds of a widget, which the user can move anywhere, are left out instead.
Result<std::vector<flow::CurvePtr>> trace_lines(Scene& scene, const Seeds& seeds, const LineRequest& request, const json::Node& where);

/// Returns the lines of a streamline set. Cached; traced again after a widget has moved the seeds or the time step has changed.
Result<std::vector<flow::CurvePtr>> resolve_lines(Scene& scene, Entity set);

/// Returns the version of the lines that resolve_lines returns, different for each set of lines; 0: not traced, or out of date.
std::uint64_t lines_version(Scene& scene, Entity set);
/// Returns the bounds of the lines last traced, whether still cached or not; empty: none traced.
Bounds lines_bounds(const Scene& scene, Entity set);

/// Maximum number of knots of a set that are cached for further use: 72 MB.
inline constexpr std::size_t kMaxCachedKnots = 1'000'000;
/// Passes the lines of a set to `visit` block by block, each line once, for callers that need them only once: 1e5 lines are gigabytes. If
/// the first blocks predict more than `max_cached_knots` knots, the lines are not cached, and resolve_lines would trace them again;
/// lines_version and lines_bounds return the same as after resolve_lines.
Outcome visit_lines(Scene& scene, Entity set, const std::function<Outcome(const LineBlock&)>& visit,
                    std::size_t max_cached_knots = kMaxCachedKnots);

/// Drops the cached curves that have no other owner (no rendered line, no link of a program).
void drop_unused_curves(Scene& scene);
/// Hands over the lines of sets in `old` to the sets in `reloaded` with the same field, seeds and tracing (transfer_state, document.h).
void transfer_lines(Scene& old, Scene& reloaded);

}  // namespace catena::scene
