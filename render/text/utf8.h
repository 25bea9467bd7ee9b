/// UTF-8 to code points. What is no UTF-8 becomes U+FFFD, one for each byte that fits nowhere. Any thread.
#pragma once
#include <string_view>
#include <vector>

namespace catena::render {

inline std::vector<char32_t> code_points(std::string_view text) {
  constexpr char32_t bad = 0xfffd;
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80                    ? 0
                     : first >= 0xc2 && first < 0xe0 ? 1
                     : first >= 0xe0 && first < 0xf0 ? 2
                     : first >= 0xf0 && first < 0xf5 ? 3
                                                     : -1;
    if (more < 0) {
      out.push_back(bad);
      continue;
    }
    char32_t c = more == 0 ? first : static_cast<char32_t>(first & (0x3f >> more));
    bool whole = text.size() - i >= static_cast<std::size_t>(more);
    for (int k = 0; k < more && whole; ++k) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      whole = (next & 0xc0) == 0x80;
      c = (c << 6) | (next & 0x3f);
    }
    // overlong forms, surrogates, beyond the last plane
    whole = whole && !(more == 2 && c < 0x800) && !(more == 3 && (c < 0x10000 || c > 0x10ffff)) && !(c >= 0xd800 && c < 0xe000);
    if (whole) i += static_cast<std::size_t>(more);
    out.push_back(whole ? c : bad);
  }
  return out;
}

}  // namespace catena::render
