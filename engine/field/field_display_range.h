/// The range that a picture shows of a field where nobody states one (engine/base/display_range.h), and values spread over a grid.
/// Off the tick; any thread.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "engine/base/display_range.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Of the active, valid values of a grid, of a vector grid's magnitudes: found once a grid, from about 2^17 values spread over it, then
/// from all values where some lie beyond. The range and the counts are exact then. Of data that were resampled they are those of the file's
/// own values.
const DisplayRange& display_range(const ScalarGrid& grid);
const DisplayRange& display_range(const VectorGrid& grid);
/// A formula's is that of all its values.
DisplayRange display_range(const ScalarField& field);
/// Of either kind; of a vector formula nothing is known: 0 .. 0.
DisplayRange display_range(const AnyField& field);

/// Of values that were sampled from a field, as those of a line or of glyphs: least and greatest, without what the field's own range leaves
/// out and the mixtures with it. `of` is no field: values by themselves.
DisplayRange display_range(std::span<const double> values, const AnyField& of);

/// Calls take(origin, extent, voxels) for blocks of 8^3 voxels (less at the box's end) spread over the box, at most about `most` voxels in
/// all.
using BlockVisitor = std::function<void(const Index3&, const Index3&, std::size_t)>;
void for_sampled_blocks(const Box& box, std::size_t most, const BlockVisitor& take);

/// At most about `most` finite values of valid cells' voxels, spread over the grid in blocks of 8^3.
std::vector<float> sample_values(const ScalarGrid& grid, std::size_t most);

/// The same of the magnitudes of a vector grid.
std::vector<float> sample_magnitudes(const VectorGrid& grid, std::size_t most);

}  // namespace catena::field
