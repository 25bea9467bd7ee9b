/// GLSL to SPIR-V at run time, by the glslang library, as the build does it (Vulkan 1.3, SPIR-V 1.6). One thread at a time; the first call
/// in a process takes a few hundred milliseconds, the next ones a few.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

struct CompiledShader {
  std::vector<std::uint32_t> words;
  std::vector<std::string> files;  ///< the shader and all that it includes, from the folder, sorted
};

/// `folder` stands for `shaders/`: "passes/x.frag" is folder/passes/x.frag, and what it includes as "shaders/lib/y.glsl" is
/// folder/lib/y.glsl. The last part of the name says the stage: vert, frag, comp. Errors read "folder/passes/x.frag:12: what".
Result<CompiledShader> compile_shader(const std::string& folder, const std::string& name);

/// Watches a folder of shaders and compiles what has changed in it, by itself or by what it includes. Frame thread.
struct ChangedShader {
  std::string name;  ///< "compose.frag"
  std::vector<std::uint32_t> words;
};

struct ShaderChanges {
  std::vector<ChangedShader> changed;
  std::vector<std::string> errors;  ///< of those that do not compile, a line each
};

class ShaderWatcher {
 public:
  /// `names`: of the shaders to watch, as files of folder/passes. An error where one of them is not there.
  static Result<ShaderWatcher> open(const std::string& folder, std::vector<std::string> names);
  /// What has changed since the last call; the first call compiles all.
  ShaderChanges poll();

 private:
  using Timestamp = std::filesystem::file_time_type;
  std::map<std::string, Timestamp> read_timestamps() const;

  std::string folder_;
  std::vector<std::string> names_;
  std::map<std::string, Timestamp> timestamps_;
  std::map<std::string, std::set<std::string>> files_;  ///< of every shader, as of its last success
};

}  // namespace catena::render
