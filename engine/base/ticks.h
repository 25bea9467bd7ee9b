/// Ticks at nice numbers, for legends and axes: steps of 1, 2 or 5 times a power of ten.
/// P. S. Heckbert, "Nice numbers for graph labels", Graphics Gems (1990), 61-63; here only the ticks within [lo, hi].
/// Pure functions, any thread.
#pragma once
#include <string>
#include <vector>

namespace catena {

struct Tick {
  double value = 0;   ///< the double nearest to what the label says
  std::string label;  ///< as few digits as tell it exactly: as many decimals on every tick, or each with its exponent
};

/// About `about` (at least 2) ticks from lo to hi, rising: 0.6 (about - 1) at least, 1.5 (about - 1) + 1 at most. Labels are fixed ("0.25",
/// "1500") up to 6 digits, beyond that what is shorter of fixed and "2.5e-7". lo > hi is taken the other way round; one tick with its
/// shortest label where they are equal or differ by less than 1e-12 of their size; none where one is not finite.
std::vector<Tick> nice_ticks(double lo, double hi, int about = 5);

}  // namespace catena
