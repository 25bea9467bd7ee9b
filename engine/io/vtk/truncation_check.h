// SPDX-License-Identifier: MIT
/// Detects values that a reader never wrote because the file is truncated. The readers of VTK and ITK do not always report that, and the
/// previous contents of the memory would be taken for data. New memory is therefore filled with a byte; if an array ends with that byte,
/// the file is read again with another fill byte: an array that changes with the fill byte was not written to its end.
#pragma once
#include <vtkDataObject.h>

#include <cstddef>
#include <functional>
#include <string>

#include "engine/base/result.h"

namespace catena::vtk {

/// Message for a truncated file; completes "PATH: ".
inline constexpr const char* kTruncatedMessage = "the file ends before the end of the data: it is truncated, or is still being written";

/// Calls `read` once, or twice if the first time is inconclusive. `data`: returns what was read, null for nothing. Returns an Error when an
/// array was not written to its end. From the first call on, new memory of this process is filled (mallopt, M_PERTURB).
Outcome read_checking_truncation(const std::function<void()>& read, const std::function<vtkDataObject*()>& data);

/// Checks one array in memory that exists before it is read.
Outcome read_checking_truncation(std::byte* values, std::size_t bytes, std::size_t value_bytes, const std::function<void()>& read);

}  // namespace catena::vtk
