/// The files of one run of a command, and the one place where its outputs are compared with its inputs and with each other.
#pragma once
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/scene/scene.h"

namespace catena::app {

/// The scene file itself and every file that it names: what no output may overwrite.
std::vector<std::string> scene_input_files(const scene::Scene& scene);

/// Where this user's programs keep things of a kind, by the XDG base directories: "$XDG_CACHE_HOME/catena", else "~/.cache/catena"; a
/// relative one counts as not given. Empty where there is no home.
std::string user_folder(const char* variable, const char* under_home);

class IoConflictChecker {
 public:
  IoConflictChecker() = default;
  explicit IoConflictChecker(const scene::Scene& scene) { add_input(scene); }

  /// An empty path: none.
  void add_input(const std::string& path);
  void add_input(const std::vector<std::string>& paths);
  void add_input(const scene::Scene& scene);
  /// What a device reads, "recorded:PATH.csv", or writes, "emulated-falcon:process:PATH.csv".
  void add_device_files(const std::string& name);
  /// All that lies in a folder.
  void add_input_folder(const std::string& folder);
  void add_output(const std::string& option, const std::string& path);

  const std::vector<std::string>& inputs() const { return inputs_; }
  /// Before anything is opened for writing: no output is an input, or a part of one that its reader opens, and no two are one file
  /// (engine/base/output_file.h). From then on all of the inputs are protected for as long as the program runs; `keeps_scene`: but for
  /// scene files, which a window saves.
  Outcome check(bool keeps_scene = false) const;

 private:
  std::vector<std::string> inputs_;
  std::vector<PlannedOutput> outputs_;
};

}  // namespace catena::app
