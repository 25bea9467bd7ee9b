// SPDX-License-Identifier: MIT
/// File patterns: names that stand for the files of a series. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::scene {

/// Returns whether the name is a pattern: a `*` in the file name ("wind_*.vti"), or a list ("wind_{1,3,10}.vti"). A name of an existing
/// file is no pattern.
bool is_pattern(const std::string& path);
/// Returns the files that match a pattern, in the order of the numbers in their names; empty: no match.
std::vector<std::string> expand_pattern(const std::string& path);
/// Returns the first file of a pattern; the argument itself if it is no pattern or matches no file.
std::string first_file(const std::string& path);
/// Returns the pattern that matches exactly these files (for one file its name). Error: the files are not one series, or one is missing.
Result<std::string> make_pattern(std::vector<std::string> files);

}  // namespace catena::scene
