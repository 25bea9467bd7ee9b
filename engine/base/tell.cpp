#include "engine/base/tell.h"

#include <cstdio>
#include <string>

#include "engine/base/text.h"

namespace catena {
namespace {

void write_line(std::string_view before, std::string_view line) noexcept {
  try {
    const std::string text = std::string(before) + printable(one_line(std::string(line))) + "\n";
    std::fwrite(text.data(), 1, text.size(), stderr);
  } catch (...) {
    std::fputs("catena: out of memory\n", stderr);
  }
}

}  // namespace

void tell(std::string_view line) noexcept { write_line({}, line); }
void tell_from_catena(std::string_view line) noexcept { write_line("catena: ", line); }

}  // namespace catena
