// SPDX-License-Identifier: MIT
/// Cache of the fields of a time series, with prefetching. Its capacity is a quarter of the available memory (engine/base/memory_limit.h),
/// checked when a field is added; the least recently used field is evicted first. Any thread.
#pragma once
#include <vector>

#include "engine/io/volume/load_field.h"

namespace catena::field {

/// Loads a field as load() does, or returns the cached field if there is one. Waits for a field that is being prefetched.
Result<AnyField> load_cached(const LoadRequest& request);
/// Loads these fields in order on a background thread; replaces the pending requests that have not started. Errors are not reported here:
/// load_cached() tries again and returns them.
void prefetch(std::vector<LoadRequest> requests);
/// Returns whether the field of this request is cached.
bool is_cached(const LoadRequest& request);
/// Adds a field that was loaded elsewhere.
void add_to_cache(const LoadRequest& request, const AnyField& field);
/// Empties the cache and waits for a load in progress. For tests and program exit.
void clear_cache();

}  // namespace catena::field
