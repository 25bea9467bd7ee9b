#include "engine/flow/flow.h"

namespace catena::flow {

namespace {
constexpr const char* kWords[] = {"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54"};
}

std::optional<Method> method_from_word(std::string_view word) {
  for (int i = 0; i < 7; ++i)
    if (word == kWords[i]) return static_cast<Method>(i);
  return std::nullopt;
}

const char* method_word(Method method) { return kWords[static_cast<int>(method)]; }

}  // namespace catena::flow
