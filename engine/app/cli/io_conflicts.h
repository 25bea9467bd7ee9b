// SPDX-License-Identifier: MIT
/// The input and output files of one run of a command. All checks of outputs against inputs and against each other are done here.
#pragma once
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/scene/scene.h"

namespace catena::app {

/// The scene file and every file that it names: files that no output may overwrite.
std::vector<std::string> scene_input_files(const scene::Scene& scene);

/// The user's folder for one kind of data, by the XDG base directories: "$XDG_CACHE_HOME/catena", else "~/.cache/catena", for the arguments
/// "XDG_CACHE_HOME" and ".cache". A relative value of the variable is ignored. Empty: there is no home directory.
std::string user_folder(const char* variable, const char* under_home);

/// Collects the inputs and outputs of a run, then checks them. One thread.
class IoConflictChecker {
 public:
  IoConflictChecker() = default;
  explicit IoConflictChecker(const scene::Scene& scene) { add_input(scene); }

  /// Adds one file, or the files that match a pattern; an empty path adds nothing.
  void add_input(const std::string& path);
  void add_input(const std::vector<std::string>& paths);
  void add_input(const scene::Scene& scene);
  /// Adds the file of a device name: an input of "recorded:PATH.csv", an output of "emulated-falcon:process:PATH.csv".
  void add_device_files(const std::string& name);
  /// Adds all files in a folder and its subfolders.
  void add_input_folder(const std::string& folder);
  /// Adds an output with the option that named it, for messages.
  void add_output(const std::string& option, const std::string& path);

  const std::vector<std::string>& inputs() const { return inputs_; }
  /// Call before any file is opened for writing. Error: an output is an input or one of the data files that the reader of an input opens,
  /// or two outputs are one file (engine/base/output_file.h). Then protects all inputs from being overwritten until the program ends; with
  /// `keeps_scene` all but scene files, which the viewer saves.
  Outcome check(bool keeps_scene = false) const;

 private:
  std::vector<std::string> inputs_;
  std::vector<PlannedOutput> outputs_;
};

}  // namespace catena::app
