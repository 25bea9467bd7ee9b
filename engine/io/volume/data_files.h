// SPDX-License-Identifier: MIT
/// Data that span several files: finds these files, so that no output overwrites one. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/input_files.h"

namespace catena::field {

/// Returns whether reading a file, or a folder, can open other files than the one named.
bool has_companion_files(const std::string& path);
/// Returns whether a folder contains an OpenFOAM mesh: constant/polyMesh, or those of regions, constant/REGION/polyMesh.
bool has_openfoam_mesh(const std::string& folder);
/// Returns whether a folder is an OpenFOAM case: it has system/controlDict, a mesh, or pieces in processor0.
bool is_openfoam_case(const std::string& path);
/// Folder of the OpenFOAM case: the given folder, or that of a .foam file; empty: the path is neither.
std::string openfoam_case_folder(const std::string& path);
/// Returns the files that reading `path` opens, and those that it may open for other time steps. Runs the reader unless its response is
/// cached.
std::vector<FileId> find_data_files(const std::string& path);

}  // namespace catena::field
