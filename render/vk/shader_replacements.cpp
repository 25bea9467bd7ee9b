#include "render/vk/shader_replacements.h"

#include <algorithm>

namespace catena::render::vk {

void ShaderReplacements::replace(Spirv embedded, std::vector<std::uint32_t> words) {
  std::erase_if(all_, [&](const auto& one) { return std::ranges::equal(one.first, embedded); });
  if (!std::ranges::equal(embedded, words)) all_.emplace_back(embedded, std::move(words));
}

Spirv ShaderReplacements::of(Spirv embedded) const {
  for (const auto& [from, to] : all_)
    if (std::ranges::equal(from, embedded)) return to;
  return embedded;
}

std::vector<std::uint32_t> declared_bindings(Spirv words) {
  constexpr std::uint32_t kOpDecorate = 71, kBinding = 33, kHeader = 5;
  std::vector<std::uint32_t> found;
  for (std::size_t i = kHeader; i < words.size(); i += words[i] >> 16) {
    const std::uint32_t length = words[i] >> 16;
    if (length == 0 || i + length > words.size()) break;
    if ((words[i] & 0xffff) == kOpDecorate && length == 4 && words[i + 2] == kBinding) found.push_back(words[i + 3]);
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace catena::render::vk
