// SPDX-License-Identifier: MIT
/// Light that arrives in each cell (light_cells.h). One sweep over the planes of cells, away from the light, per direction:
///   arrives(p) = transmitted(p) (1 - decay (1 - arrives(q))),   decay = exp(-|p - q| / reach)
/// where q is the point of the previous plane towards the light, interpolated there, and `transmitted` the transmittance from q to p. With
/// an infinite reach this is the transmittance to the light, otherwise an occluder at the distance s counts by exp(-s / reach). The
/// interpolation widens the edges of shadows by about a cell. CPU code, any thread; blocks, uses all cores.
#pragma once
#include <array>
#include <vector>

#include "render/light/light_cells.h"

namespace catena::render {

/// Returns the share of the light of a disc that arrives at the center of each cell: the mean over directions to points of the disc.
/// `to_light`: unit vector to its center. `angular_size_deg`: its diameter, degrees; 0: one direction.
std::vector<float> sweep_light(const LightCells& cells, const Vec3& to_light, double angular_size_deg = 0);

/// Returns the share of light from all sides that arrives, linear in the direction w that it comes from: [0] + dot([1..3], w). From the
/// mean and the first moment of 24 directions.
std::array<std::vector<float>, 4> sweep_environment(const LightCells& cells, double reach);

}  // namespace catena::render
