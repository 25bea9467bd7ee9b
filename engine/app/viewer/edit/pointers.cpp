#include "engine/app/viewer/edit/pointers.h"

#include <algorithm>

namespace catena::app {

std::string pointer_of(const json::Node& item) {
  const std::size_t open = item.label.find('[');
  if (item.line <= 0 || open == std::string::npos || open == 0 || !item.label.ends_with(']')) return {};
  const std::string index = item.label.substr(open + 1, item.label.size() - open - 2);
  if (index.empty() || !std::all_of(index.begin(), index.end(), [](char c) { return c >= '0' && c <= '9'; })) return {};
  return "/" + item.label.substr(0, open) + "/" + index;
}

}  // namespace catena::app
