/// Shaders that stand in for embedded ones, by the embedded words themselves: what creates pipelines need not know of it. Frame thread.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace catena::render::vk {

using Spirv = std::span<const std::uint32_t>;

class ShaderReplacements {
 public:
  /// Pipelines created from now on have `words` in the place of `embedded` (which outlives this).
  void replace(Spirv embedded, std::vector<std::uint32_t> words);
  void clear() { all_.clear(); }
  /// What stands in for `embedded`: itself, where nothing does.
  Spirv of(Spirv embedded) const;

 private:
  std::vector<std::pair<Spirv, std::vector<std::uint32_t>>> all_;
};

/// The bindings that a shader declares, sorted.
std::vector<std::uint32_t> declared_bindings(Spirv words);

}  // namespace catena::render::vk
