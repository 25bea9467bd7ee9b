// SPDX-License-Identifier: MIT
/// Heuristic for numbers that were read in the wrong byte order. Nothing is changed: the file specifies its byte order, or the format
/// prescribes one (legacy .vtk: big-endian), and a guess may be wrong.
#pragma once
#include <vtkDataArray.h>

#include <string>
#include <string_view>

namespace catena::vtk {

/// Returns whether an array of numbers of at least two bytes is plausible in the other byte order only, from at most 100,000 of them:
///   floats      as read, the middle 80 % of the nonzero values are below 1e-30, above 1e30, or span more than 20 decades; swapped, they
///               lie within 1e-15 .. 1e15 and span less than 10 decades
///   integers    consecutive values differ by at least 4096 on average, and by less than an eighth of that when swapped; in a legacy
///               .vtk, where the wrong order is common, also by less than a 64th when swapped, whatever the difference as read
bool looks_byte_swapped(vtkDataArray& array, std::string_view path);

/// Message fragment with advice on the byte order, for a file with this name.
std::string byte_order_advice(std::string_view path);

}  // namespace catena::vtk
