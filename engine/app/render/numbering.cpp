#include "engine/app/render/numbering.h"

#include <fmt/core.h>

#include <optional>

namespace catena::app {
namespace {

struct Pattern {
  std::size_t at = 0, length = 0;
  int width = 0;
};

std::optional<Pattern> pattern_in(const std::string& path) {
  Pattern pattern;
  pattern.at = path.find('%');
  if (pattern.at == std::string::npos) return std::nullopt;
  std::size_t k = pattern.at + 1;
  while (k < path.size() && path[k] >= '0' && path[k] <= '9' && pattern.width < 100) pattern.width = 10 * pattern.width + (path[k++] - '0');
  if (k >= path.size() || path[k] != 'd') return std::nullopt;
  pattern.length = k + 1 - pattern.at;
  return pattern;
}

}  // namespace

bool is_numbered(const std::string& path) { return pattern_in(path).has_value(); }

std::string numbered(const std::string& path, int frame) {
  const auto pattern = pattern_in(path);
  if (!pattern) return path;
  return path.substr(0, pattern->at) + fmt::format("{:0{}}", frame, pattern->width) + path.substr(pattern->at + pattern->length);
}

}  // namespace catena::app
