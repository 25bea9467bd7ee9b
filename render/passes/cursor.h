/// The cursor: probe, proxies, links, force; and the local indicator at it. Clip planes do not touch them.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kCursorPass;

}  // namespace catena::render
