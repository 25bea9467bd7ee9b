// SPDX-License-Identifier: MIT
/// Cells of Packing::grid (packing.h), numbered by rows from the top left: the first view is at the top right. Pure, any thread.
#pragma once

namespace catena::render {

/// Returns the cell of a view, 0 to 3, and the view of a cell: the order is its own inverse.
constexpr int grid_cell(int view_or_cell) { return view_or_cell < 2 ? 1 - view_or_cell : view_or_cell; }

}  // namespace catena::render
