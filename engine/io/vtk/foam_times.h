// SPDX-License-Identifier: MIT
/// The time folders of an OpenFOAM case ("0", "0.5", "1e-05"), and the fields in them.
#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace catena::vtk {

/// Finite times, from the names of the folders in a case or in one of its processor folders.
std::set<double> list_foam_times(const std::filesystem::path& folder);
/// Names of the volume fields at a time, in all regions; empty: none at that time.
std::set<std::string> list_foam_fields(const std::filesystem::path& folder, double time);

}  // namespace catena::vtk
