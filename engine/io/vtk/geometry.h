/// What of a file is drawn as it lies: triangles (polygons, strips and the outsides of volumes are cut into them), lines, and points that
/// are on neither.
#pragma once
#include "engine/io/sandbox/response_file.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Which of them there are.
field::PrimitiveKinds find_primitive_kinds(const ImportedData& opened);

/// Fills the reply's shape. An error is a phrase.
Outcome write_geometry(const ImportedData& opened, std::uint64_t memory_bytes, sandbox::ResponseFile& out, field::ReadResponse& reply);

}  // namespace catena::vtk
