/// `catena info FILE.catlog`: what a recording holds, whether it is whole.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena::app {

inline bool is_log_file(const std::string& path) { return path.ends_with(".catlog"); }
Outcome describe_log(const std::string& path);

}  // namespace catena::app
