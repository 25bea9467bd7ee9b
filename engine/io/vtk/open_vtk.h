// SPDX-License-Identifier: MIT
/// Shared by the VTK readers, and by the files of this module that create a VTK reader of their own.
#pragma once
#include <vtkAlgorithm.h>

#include <set>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Reads the requested time step with a reader whose file name is set. `no_steps`: times that the reader reports but that are to be left
/// out. Returns an Error with a complete message.
Result<ImportedData> read_with_reader(vtkAlgorithm& reader, const Source& source, const std::set<double>& no_steps = {});

}  // namespace catena::vtk
