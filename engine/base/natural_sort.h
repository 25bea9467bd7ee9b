// SPDX-License-Identifier: MIT
/// Natural order of the files of a series, by the numbers in their names: "wake_2" before "wake_10", "t_1e-3" before "t_0.0015".
///   number    digits with an optional decimal fraction and exponent: 10, 0.0015, 1e-3
///   sign      a minus after any character except a letter or a digit ("t=-5"); after a letter only when another name of the series has the
///             number without a minus ("t-5" beside "t5"); else the minus is a separator ("wake-10")
///   fraction  a point between digits starts a fraction ("1.5"), except in a sequence of more points ("1.2.3") and when two names of the
///             series would become equal ("1.1" and "1.10"): these are then two integers each
/// Names with equal numbers are ordered by their characters. Any thread.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace catena {

/// Sorts the names of one series.
void natural_sort(std::vector<std::string>& names);
/// Returns true when the names differ in their numbers only.
bool is_numbered_series(const std::vector<std::string>& names);
/// Returns the text of a name before and after its last number; the whole name and an empty string when it has no number.
std::array<std::string, 2> split_at_last_number(const std::string& name);

}  // namespace catena
