/// The only user of TBB in Catena's own code. Serial under the thread sanitizer (libtbb is not instrumented).
#pragma once
#include <cstddef>
#include <functional>

namespace catena {

/// Calls body(begin, end) over [0, count) in pieces of at least `grain`, on all cores. Blocks until done.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace catena
