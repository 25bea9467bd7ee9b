// SPDX-License-Identifier: MIT
/// Compiled shaders of the build folder, and the layout of their structs.
#pragma once
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/support.h"

namespace catena::test {

/// The SPIR-V words of <build>/spirv/spirv/NAME.inc, a list for #include.
inline std::vector<std::uint32_t> shader_words(const std::string& name) {
  std::ifstream in(test::binary_dir() + "/spirv/spirv/" + name + ".inc");
  std::vector<std::uint32_t> words;
  std::string line;
  while (std::getline(in, line)) {
    if (line.find("//") != std::string::npos) continue;
    std::istringstream items(line);
    std::string item;
    while (std::getline(items, item, ','))
      if (const auto at = item.find("0x"); at != std::string::npos)
        words.push_back(std::uint32_t(std::stoul(item.substr(at), nullptr, 16)));
  }
  return words;
}

/// Member offsets by struct and member name, and the stride of arrays of a struct under the member name "[]".
inline std::map<std::string, std::map<std::string, std::uint32_t>> struct_offsets(const std::vector<std::uint32_t>& words) {
  enum : std::uint32_t {
    op_name = 5,
    op_member_name = 6,
    op_type_array = 28,
    op_type_runtime_array = 29,
    op_decorate = 71,
    op_member_decorate = 72
  };
  enum : std::uint32_t { array_stride = 6, offset = 35 };
  std::map<std::uint32_t, std::string> names;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> member_names;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets;
  std::map<std::uint32_t, std::uint32_t> strides, element_of;
  for (std::size_t i = 5; i < words.size(); i += words[i] >> 16) {
    const std::uint32_t op = words[i] & 0xffff;
    const auto text = [&](std::size_t at) { return std::string(reinterpret_cast<const char*>(&words[at])); };
    if (op == op_name) names[words[i + 1]] = text(i + 2);
    if (op == op_member_name) member_names[{words[i + 1], words[i + 2]}] = text(i + 3);
    if (op == op_type_array || op == op_type_runtime_array) element_of[words[i + 1]] = words[i + 2];
    if (op == op_decorate && words[i + 2] == array_stride) strides[words[i + 1]] = words[i + 3];
    if (op == op_member_decorate && words[i + 3] == offset) offsets[{words[i + 1], words[i + 2]}] = words[i + 4];
    if (words[i] >> 16 == 0) break;
  }
  std::map<std::string, std::map<std::string, std::uint32_t>> out;
  for (const auto& [key, value] : offsets) out[names[key.first]][member_names[key]] = value;
  for (const auto& [array, stride] : strides)
    if (element_of.count(array)) out[names[element_of[array]]]["[]"] = stride;
  return out;
}

}  // namespace catena::test
