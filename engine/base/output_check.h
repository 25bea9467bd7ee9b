/// The rule that no output of a run is one of its inputs, and no two outputs are one file: said before anything is opened for writing.
/// Two names are one file where they lead to one thing on the disk (device and inode: links of both kinds, ./x, x/../x), or, where nothing
/// is there yet, to one place once links on the way are followed. Letters keep their case. Devices and pipes are nobody's own.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// A file that a run will write; an empty path: it will not.
struct Output {
  std::string option;  ///< that names it: "--stats"
  std::string path;
};

/// One line: a missing folder, a folder as the file, an output that is one of the inputs, or two outputs that are one file.
Outcome check_outputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs);
/// The same for one output.
Outcome check_output(const std::string& path, const std::vector<std::string>& inputs);

/// Two names of one place, whether or not it exists yet. Devices and pipes are nobody's own.
bool same_file(const std::string& a, const std::string& b);

}  // namespace catena
