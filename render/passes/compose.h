/// Volume over opaque over background, into the finished picture (RGBA8, straight alpha).
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kComposePass;

}  // namespace catena::render
