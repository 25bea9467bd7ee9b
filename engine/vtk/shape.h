/// What of a file is drawn as it lies: triangles (polygons, strips and the outsides of volumes are cut into them), lines, and points that
/// are on neither.
#pragma once
#include "engine/reader/answer_file.h"
#include "engine/vtk/open.h"

namespace catena::vtk {

/// Which of them there are.
field::Shapes shapes_of(const Opened& opened);

/// Fills the reply's shape. An error is a phrase.
Outcome answer_shape(const Opened& opened, std::uint64_t memory_bytes, reader::AnswerFile& out, field::ReadReply& reply);

}  // namespace catena::vtk
