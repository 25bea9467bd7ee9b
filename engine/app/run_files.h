/// The files of one run of a command, and the one place where its outputs are compared with its inputs and with each other.
#pragma once
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/scene/scene.h"

namespace catena::app {

/// The scene file itself and every file that it names: what no output may overwrite.
std::vector<std::string> inputs_of(const scene::Scene& scene);

/// Where this user's programs keep things of a kind, by the XDG base directories: "$XDG_CACHE_HOME/catena", else "~/.cache/catena"; a
/// relative one counts as not given. Empty where there is no home.
std::string user_folder(const char* variable, const char* under_home);

class RunFiles {
 public:
  RunFiles() = default;
  explicit RunFiles(const scene::Scene& scene) { reads(scene); }

  /// An empty path: none.
  void reads(const std::string& path);
  void reads(const std::vector<std::string>& paths);
  void reads(const scene::Scene& scene);
  /// What a device reads: "recorded:PATH.csv".
  void reads_device(const std::string& name);
  /// All that lies in a folder.
  void reads_folder(const std::string& folder);
  void writes(const std::string& option, const std::string& path);

  const std::vector<std::string>& inputs() const { return inputs_; }
  /// Before anything is opened for writing (engine/base/output_file.h).
  Outcome check() const { return check_outputs(outputs_, inputs_); }

 private:
  std::vector<std::string> inputs_;
  std::vector<Output> outputs_;
};

}  // namespace catena::app
