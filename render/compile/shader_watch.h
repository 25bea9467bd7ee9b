/// Watches a folder of shaders and compiles what has changed in it, by itself or by what it includes. Frame thread.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "render/compile/compile_shader.h"

namespace catena::render {

struct ChangedShader {
  std::string name;  ///< "compose.frag"
  std::vector<std::uint32_t> words;
};

struct ShaderNews {
  std::vector<ChangedShader> changed;
  std::vector<std::string> errors;  ///< of those that do not compile, a line each
};

class ShaderWatch {
 public:
  /// `names`: of the shaders to watch, as files of folder/passes. An error where one of them is not there.
  static Result<ShaderWatch> open(const std::string& folder, std::vector<std::string> names);
  /// What has changed since the last call; the first call compiles all.
  ShaderNews poll();

 private:
  using Stamp = std::filesystem::file_time_type;
  std::map<std::string, Stamp> stamps() const;

  std::string folder_;
  std::vector<std::string> names_;
  std::map<std::string, Stamp> seen_;
  std::map<std::string, std::set<std::string>> files_;  ///< of every shader, as of its last success
};

}  // namespace catena::render
