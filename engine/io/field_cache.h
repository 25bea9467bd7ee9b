/// Fields of a series in time, kept while there is room, and loaded before they are asked for. Room: a quarter of the memory that is
/// allowed (engine/base/memory_limit.h), counted when a field is added; the one that was not asked for longest goes first. Any thread.
#pragma once
#include <vector>

#include "engine/io/volume/load_field.h"

namespace catena::field {

/// As load(), from what is kept where it is there. A field that is being loaded ahead is waited for.
Result<AnyField> load_cached(const LoadRequest& request);
/// Loads these, in order, on a thread of its own; what was to be loaded before and has not begun is forgotten. Errors are left to who asks.
void prefetch(std::vector<LoadRequest> requests);
bool is_cached(const LoadRequest& request);
/// Keeps what was loaded elsewhere.
void add_to_cache(const LoadRequest& request, const AnyField& field);
/// Nothing is kept any more; waits for what is being loaded. For tests, and at the end of the program.
void clear_cache();

}  // namespace catena::field
