/// NumberArray that were read in the wrong byte order, by what they look like. Nothing is changed: the file says its order, or its format
/// demands one (legacy .vtk: big-endian), and a guess may be wrong.
#pragma once
#include <vtkDataArray.h>

#include <string>
#include <string_view>

namespace catena::vtk {

/// Whether an array of numbers of two bytes and more would make sense in the other order only, judged by at most 100,000 of them:
///   floats      the middle 80 % of those that are not 0 are below 1e-30, above 1e30, or spread over more than 20 decades as they are,
///               and lie within 1e-15 .. 1e15 and 10 decades swapped
///   integers    neighbours differ by 4096 and more, and by less than an eighth of that swapped; of a legacy .vtk, which programs often
///               write so, also by less than a 64th of it, whatever they differ by
bool looks_byte_swapped(vtkDataArray& array, std::string_view path);

/// What to do about it, of a file with this name: a phrase.
std::string byte_order_advice(std::string_view path);

}  // namespace catena::vtk
