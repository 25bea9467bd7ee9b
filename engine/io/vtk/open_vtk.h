/// What VTK's readers have in common, for the files of this room that bring a reader of their own.
#pragma once
#include <vtkAlgorithm.h>

#include <set>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// The step that is asked for, of a reader that knows its file. `no_steps`: times that the reader states and that are left out. Errors are
/// whole sentences.
Result<ImportedData> read_with_reader(vtkAlgorithm& reader, const Source& source, const std::set<double>& no_steps = {});

}  // namespace catena::vtk
