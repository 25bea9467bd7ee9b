/// Text and flat shapes over the finished picture: scalar bars, labels, title, orientation marker, status. They are drawn into an image
/// of their own (premultiplied) and blended into the picture (straight alpha), so that both opaque and transparent pictures are right.
/// Without an item there is no pass. Without a font there is no text, and the pass's note says why.
#pragma once
#include "render/passes/pass.h"

namespace catena::render {

extern const PassEntry kOverlayPass;

}  // namespace catena::render
