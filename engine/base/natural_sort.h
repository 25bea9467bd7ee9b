/// The order of the files of a series by the numbers in their names: "wake_2" before "wake_10", "t_1e-3" before "t_0.0015".
///   number    digits, with a decimal fraction and an exponent where they follow: 10, 0.0015, 1e-3
///   sign      a minus after anything but a letter or a digit ("t=-5"); after a letter only where another name of the same series has the
///             number without one ("t-5" beside "t5"): else it separates ("wake-10")
///   fraction  a point between digits makes one ("1.5"), but not in a sequence of more ("1.2.3"), and not where two names of the
///             series would be equal by it ("1.1" and "1.10"): these are two whole numbers each
/// Names with equal numbers are ordered by their characters. Any thread.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace catena {

/// Sorts the names of one series.
void natural_sort(std::vector<std::string>& names);
/// Whether the names differ in their numbers alone.
bool is_numbered_series(const std::vector<std::string>& names);
/// The bytes of a name before and after its last number; the whole name and nothing where it has none.
std::array<std::string, 2> split_at_last_number(const std::string& name);

}  // namespace catena
