/// The lines of a set of seeds: points, or a pattern (line, plane, sphere, isosurface, evenly spaced).
///   points     the exact tracer, through the scene's own curves: a line that a link of the chain feels is the same object
///   widget     a seed as a point, a rake as a pattern
///   patterns   the batch tracer (engine/geometry/flow/batch_tracer.h); places of a pattern that start nothing are left out
///   formulas   their lines end at the box of the field's picture where no length is given and the seed lies in it; evenly spaced always
///   tolerance  of one step, times L, chooses otherwise: up to 1e-9 the exact tracer, above it the batch tracer
/// Frame thread.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>

#include "engine/base/bounds.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// The value of "seeds": an array of places, or an object with one pattern. `trace --seeds` reads the same.
Result<Seeds> read_seeds(const Scene& scene, const json::Node& node);

/// Of all lines of one set together: 40 million, or what the allowed memory (memory_limit.h) holds of them. More are an error, said
/// before they fill the memory.
std::size_t knot_limit();

/// Some of the lines of a set, in the order of their seeds.
struct LineBlock {
  std::span<const flow::CurvePtr> curves;
  std::size_t seeds_done = 0, seeds_total = 0;  ///< how many seeds are done with these, of how many
};

struct LineRequest {
  flow::Flow flow;
  double length = 0;     ///< 0: 10 L each direction, and of a formula no farther than `box`
  double tolerance = 0;  ///< 0: by the seeds' kind
  double max_step = 0;   ///< the batch tracer's longest, voxels; 0: its default
  std::size_t max_knots = knot_limit();
  std::function<void(std::size_t seeds, std::size_t of)> progress{};  ///< told now and then how many seeds of a pattern are done
  std::optional<std::array<double, 2>> box{};                         ///< of a formula: the cube that its picture shows, world
  std::function<Outcome(const LineBlock&)> visit{};                   ///< gets the lines as they are made
  std::size_t max_cached_knots = knot_limit();                        ///< with `visit`: of a set of more knots nothing is returned
};

/// The sentence that says that the lines of so many seeds have more knots together, and what was expected.
std::string too_many_knots_message(std::size_t seeds, std::size_t done, std::size_t most);

/// Called now and then while the seeds of a pattern are traced for a set through that field, and once, with 0 of 0, at their end.
/// Any thread that makes frames.
using TraceProgress = std::function<void(const std::string& field, std::size_t seeds, std::size_t of)>;
/// Once, before any set is traced.
void set_trace_progress(TraceProgress called);

/// Every line of the seeds. Points that start nothing are errors at their place in the file; a pattern of which no place
/// starts a line is one, too. Not those of a widget, which the hand may carry anywhere: what starts nothing is left out.
Result<std::vector<flow::CurvePtr>> trace_lines(Scene& scene, const Seeds& seeds, const LineRequest& request, const json::Node& where);

/// The lines of a streamline set; made once, and again when a widget has moved their seeds.
Result<std::vector<flow::CurvePtr>> resolve_lines(Scene& scene, Entity set);

/// Which lines resolve_lines returns: another number with every other set of them; 0: they are not made, or out of date.
std::uint64_t lines_version(Scene& scene, Entity set);
/// The box of the lines as they were made last, released or not; empty before.
Bounds lines_bounds(const Scene& scene, Entity set);

/// Knots of a set that are kept for the next who needs its lines: 72 MB.
inline constexpr std::size_t kMaxCachedKnots = 1'000'000;
/// Hands the lines of a set over block by block, each once, to those who need them once: 1e5 lines are gigabytes. Where the
/// first let expect more than `max_cached_knots` knots together they are not kept, and resolve_lines would make them again; lines_version
/// and lines_bounds answer as after resolve_lines.
Outcome visit_lines(Scene& scene, Entity set, const std::function<Outcome(const LineBlock&)>& visit,
                    std::size_t most_kept = kMaxCachedKnots);

/// Drops the curves that nothing but the scene holds any more (no line that is drawn, no link of a program).
void drop_unused_curves(Scene& scene);
/// Sets of `fresh` with a field, seeds and tracing that one of `old` has take over its lines (document.h, transfer_state).
void transfer_lines(Scene& old, Scene& fresh);

}  // namespace catena::scene
