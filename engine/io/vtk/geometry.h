// SPDX-License-Identifier: MIT
/// Geometry in a file: triangles (polygons, strips and the surfaces of volume cells are triangulated), lines, and points that are on
/// neither.
#pragma once
#include "engine/io/sandbox/response_file.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Returns which kinds of primitives there are.
field::PrimitiveKinds find_primitive_kinds(const ImportedData& opened);

/// Writes the geometry to `out` and fills in reply.geometry. Returns an Error with a message fragment.
Outcome write_geometry(const ImportedData& opened, std::uint64_t memory_bytes, sandbox::ResponseFile& out, field::ReadResponse& reply);

}  // namespace catena::vtk
