/// "turn_%03d.png" names every picture of a sequence; a plain name is the first picture's.
#pragma once
#include <string>

namespace catena::app {

bool is_numbered(const std::string& path);
/// The name of one picture; a plain name as it is.
std::string numbered(const std::string& path, int frame);

}  // namespace catena::app
