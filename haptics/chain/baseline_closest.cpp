/// Closest constraint: every constraint projects the probe, the nearest projection is the proxy; the first of equals.
#include "haptics/chain/baseline.h"

namespace catena::haptics {

Vec3 closest(SingleTick& tick) noexcept {
  Vec3 p = tick.probe;
  double best = -1;
  std::size_t nearest = kMaxLinks;
  tick.each([&](std::size_t i) {
    if (!tick.apply(i, tick.probe)) return;
    const double d = norm(tick.links[i].proxy - tick.probe);
    if (best >= 0 && !(d < best)) return;
    best = d;
    nearest = i;
    p = tick.links[i].proxy;
  });
  if (nearest < kMaxLinks) tick.holds[nearest] = true;
  return p;
}

}  // namespace catena::haptics
