// SPDX-License-Identifier: MIT
/// Path lines and streak lines of the scene's vector fields (engine/geometry/flow/pathlines.h): of a field with time steps, or derived from
/// one; of three expressions of x, y, z and t, evaluated exactly within the field's box; of a formula, which is steady. Frame thread.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/flow/pathlines.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Returns the times of the steps of a field, or of those from which it is derived; their numbers if no file states times; of other fields
/// the times that the scene states. Empty: there are none. The field has to be loaded.
std::vector<double> times_of_field(const Scene& scene, Entity field);

/// Path lines or streak lines to trace.
struct UnsteadyLineRequest {
  LineKind kind = LineKind::path;  ///< path or streak
  std::optional<std::array<double, 2>>
      times{};  ///< Start and end; empty: all times (of a formula those of the scene), of streak lines up to the current one
  bool is_cubic_in_time = false;                       ///< Interpolation between steps
  double tolerance = 0;                                ///< Error of a step, relative to L; 0: 1e-11
  std::function<void(double share)> progress{};        ///< Receives the share of the work that is done
  std::vector<std::size_t>* line_positions = nullptr;  ///< Receives the index of each line's position; null: not reported
  std::function<json::Node(std::size_t)> node_of{};    ///< Node of a position in the scene file, for errors
  bool skips_unusable_positions = false;               ///< A position without a line is left out; else it is an Error
};

/// Traces the lines through the positions. Path lines that were traced before are the same objects. No lines: streak lines at their start.
Result<std::vector<flow::CurvePtr>> trace_unsteady_lines(Scene& scene, Entity field, std::span<const Vec3> positions,
                                                         const UnsteadyLineRequest& request, const json::Node& where);

/// Returns the path line of a link, the same object as in a set of path lines. Error at `where`.
Result<flow::CurvePtr> resolve_pathline(Scene& scene, const std::string& field, const Vec3& seed, UnsteadyLineRequest request,
                                        const json::Node& where);

}  // namespace catena::scene
