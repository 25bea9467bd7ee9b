// SPDX-License-Identifier: MIT
/// Text from outside of the program: reading whole files, quoting text in one-line messages, and suggesting the name that was probably
/// meant. Any thread.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// Largest size in bytes of text files that are accepted: scenes and other JSON; tables of numbers and all other texts.
inline constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{128} << 20, kMaxTextBytes = std::uint64_t{1} << 30;

/// Reads a whole regular file of at most `max_bytes`. Nothing is allocated for a larger one, and pipes, devices and sockets are rejected
/// without waiting. Error: PATH, why it cannot be read, and that `expected` ("a scene file") was expected; also for a file above 16 MiB
/// that is mostly holes, or larger than the memory budget.
Result<std::string> read_text_file(const std::string& path, std::string_view expected, std::uint64_t max_bytes = kMaxTextBytes);

/// Removes a UTF-8 byte order mark from the start.
std::string_view strip_bom(std::string_view text);

/// Returns the text in quotes for a message: control characters become '?', and text beyond 60 bytes is cut off ("...").
std::string in_quotes(std::string_view text);

/// Replaces control characters, line ends above all, with blanks.
std::string one_line(std::string text);

/// Makes text safe to print on a terminal: control characters, escape sequences, bytes that are not UTF-8 and marks that change the writing
/// direction each become '?'. All other text is unchanged.
std::string sanitize_for_terminal(std::string_view text);

/// Default number of names that a list in a message shows.
inline constexpr std::size_t kMaxListedNames = 10;
/// Maximum length of a printed line in bytes.
inline constexpr std::size_t kMaxLineBytes = 2000;

/// Removes object addresses from a library's message: "vtkFoo (0x55d0c8a0): bad" becomes "vtkFoo: bad".
std::string strip_addresses(std::string text);

/// Returns `a, b, c`; with more than `max_count` names `a, b, c and 7 more`.
std::string join_words(const std::vector<std::string_view>& words, std::size_t max_count = kMaxListedNames);
/// Cuts a text to at most `max_bytes` bytes at the boundary of a UTF-8 character; a text that was cut ends in "...".
std::string truncate_utf8(std::string text, std::size_t max_bytes);
/// Returns `a, b or c`.
std::string join_alternatives(const std::vector<std::string_view>& words);

/// Returns true when a name ends in the extension, in any case; `lower_case` must be in lower case.
bool has_extension(std::string_view name, std::string_view lower_case);

/// Returns `name`, or the first of name_2, name_3, ... for which `is_taken` returns false.
std::string make_unique_name(const std::string& name, const std::function<bool(const std::string&)>& is_taken);

/// Returns ` (did you mean "stiffness"?)` when one of `words` is similar to `word`, else an empty string.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words);

}  // namespace catena
