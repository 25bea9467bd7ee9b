/// Names that stand for several files of one series. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::scene {

/// A name that stands for several files: with a `*` in its last part ("wind_*.vti"), or with a list ("wind_{1,3,10}.vti"). A file that is
/// really called so is none.
bool is_pattern(const std::string& path);
/// The files that a pattern stands for, by the numbers in their names; empty: none.
std::vector<std::string> expand_pattern(const std::string& path);
/// The file that a name stands for: of a pattern its first one, or the pattern itself where there is none.
std::string first_file(const std::string& path);
/// The pattern that stands for these files and no others. Error: they are no series, in a sentence.
Result<std::string> make_pattern(std::vector<std::string> files);

}  // namespace catena::scene
