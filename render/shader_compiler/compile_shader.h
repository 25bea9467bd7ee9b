// SPDX-License-Identifier: MIT
/// Compilation of GLSL to SPIR-V at run time with the glslang library, equivalent to that of the build (Vulkan 1.3, SPIR-V 1.6). One thread
/// at a time; the first call in a process takes a few hundred milliseconds, the following ones a few.
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

/// Result of a compilation.
struct CompiledShader {
  std::vector<std::uint32_t> words;
  std::vector<std::string> files;  ///< the shader and all files it includes, relative to the folder, sorted
};

/// Compiles a shader. `folder` stands for `shaders/`: "passes/x.frag" is folder/passes/x.frag, and a file included as "shaders/lib/y.glsl"
/// is folder/lib/y.glsl. The file extension determines the stage: vert, frag, comp. Errors read "folder/passes/x.frag:12: what".
Result<CompiledShader> compile_shader(const std::string& folder, const std::string& name);

/// Shader recompiled by ShaderWatcher.
struct ChangedShader {
  std::string name;  ///< for instance "compose.frag"
  std::vector<std::uint32_t> words;
};

/// Result of ShaderWatcher::poll().
struct ShaderChanges {
  std::vector<ChangedShader> changed;
  std::vector<std::string> errors;  ///< one line for each shader that does not compile
};

/// Watches a folder of shaders and recompiles those that changed, directly or in a file they include. Frame thread.
class ShaderWatcher {
 public:
  /// `names`: shaders to watch, files of folder/passes. An Error if one of them does not exist.
  static Result<ShaderWatcher> open(const std::string& folder, std::vector<std::string> names);
  /// Returns the shaders that changed since the last call; the first call compiles all.
  ShaderChanges poll();

 private:
  using Timestamp = std::filesystem::file_time_type;
  std::map<std::string, Timestamp> read_timestamps() const;

  std::string folder_;
  std::vector<std::string> names_;
  std::map<std::string, Timestamp> timestamps_;
  std::map<std::string, std::set<std::string>> files_;  ///< files of every shader at its last successful compilation
};

}  // namespace catena::render
