// SPDX-License-Identifier: MIT
/// Descriptions of stores of chunks: functions of VolumeReader (engine/io/volume/volume_reader.h). Private to this folder. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

/// Describes all grids, with the levels in the cache; values are read of the coarsest level only.
Result<std::vector<GridInfo>> describe_stored(const std::string& path, int step);
/// Returns the units of a grid.
Units stored_units(const std::string& path, const std::string& name);
/// Returns the times of the steps.
std::vector<double> stored_times(const std::string& path);
/// Returns the notes of the reader, and where the levels in the cache are.
std::vector<std::string> stored_notes(const std::string& path);
/// Returns all files of the store.
std::vector<FileId> stored_files(const std::string& path);

}  // namespace catena::field
