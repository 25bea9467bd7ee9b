/// Data that lie in several files: which they are, so that no output replaces one. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/input_files.h"

namespace catena::field {

/// Whether reading a file, or a folder, can open other files than the one that is named.
bool has_companion_files(const std::string& path);
/// Whether a folder has a mesh of OpenFOAM: constant/polyMesh, or those of regions, constant/REGION/polyMesh.
bool has_openfoam_mesh(const std::string& folder);
/// Whether a folder is an OpenFOAM case: it has system/controlDict, a mesh, or pieces in processor0.
bool is_openfoam_case(const std::string& path);
/// The folder of the OpenFOAM case that a folder is, or that a .foam file stands for; empty: it is another file.
std::string openfoam_case_folder(const std::string& path);
/// The files that reading it opens, and those that it may open for other steps in time. The reader is asked, unless it has answered
/// already.
std::vector<FileId> find_data_files(const std::string& path);

}  // namespace catena::field
