/// Values that a reader never wrote, because the file ends before its data do. VTK's readers and ITK's do not always say so, and what the
/// memory held before would count as data. New memory is therefore filled with a byte; where an array ends with it, the file is read again
/// over another byte: an array that follows the filling was not written to its end.
#pragma once
#include <vtkDataObject.h>

#include <cstddef>
#include <functional>
#include <string>

#include "engine/base/result.h"

namespace catena::vtk {

/// Of a file that ends before its data do; completes "PATH: ".
inline constexpr const char* kTruncatedMessage = "ends before its data do: it was cut off, or is still being written";

/// Calls `read` once, or twice where the first time leaves a doubt. `data`: what was read, null for nothing. An error where an array of it
/// was not written to its end. From the first call on new memory of this process is filled (mallopt, M_PERTURB).
Outcome read_checking_truncation(const std::function<void()>& read, const std::function<vtkDataObject*()>& data);

/// The same for one array in memory that exists before it is read.
Outcome read_checking_truncation(std::byte* values, std::size_t bytes, std::size_t value_bytes, const std::function<void()>& read);

}  // namespace catena::vtk
