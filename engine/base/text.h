/// Text from the outside world: whole files, words quoted for a one-line message, and the word that was probably meant.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// The sizes that texts are believed: of scenes and other JSON, of tables of numbers and all else.
inline constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{128} << 20, kMaxTextBytes = std::uint64_t{1} << 30;

/// The whole file, which must be a regular one of at most `max_bytes`: nothing is allocated for a greater one, and a pipe, a device or a
/// socket is never waited for. The error says PATH, why it cannot be read, and that `expected` ("a scene file") was expected.
Result<std::string> read_text_file(const std::string& path, std::string_view expected, std::uint64_t most_bytes = kMaxTextBytes);

/// Without a UTF-8 byte order mark at its start.
std::string_view strip_bom(std::string_view text);

/// "text" in quotes for a message: control characters become '?', and what is longer than 60 bytes is cut.
std::string in_quotes(std::string_view text);

/// One line: control characters (line ends above all) become blanks.
std::string one_line(std::string text);

/// Text as it may reach a terminal: control characters, escapes, bytes that are no UTF-8, and marks that turn the direction of writing
/// each become '?'. Whatever else it says stays.
std::string sanitize_for_terminal(std::string_view text);

/// How many names a list in a message shows.
inline constexpr std::size_t kMaxListedNames = 10;
/// The longest line that is printed, in bytes.
inline constexpr std::size_t kMaxLineBytes = 2000;

/// A library's words without the addresses of its objects: "vtkFoo (0x55d0c8a0): bad" is "vtkFoo: bad".
std::string strip_addresses(std::string text);

/// `a, b, c`; beyond `most`: `a, b, c and 7 more`.
std::string join_words(const std::vector<std::string_view>& words, std::size_t most = kMaxListedNames);
/// At most so many bytes, cut between two UTF-8 characters; "..." ends a text that was cut.
std::string truncate_utf8(std::string text, std::size_t most);
/// `a, b or c`
std::string join_alternatives(const std::vector<std::string_view>& words);

/// Whether a name ends so, any case; `lower_case` is.
bool has_extension(std::string_view name, std::string_view lower_case);

/// `name`, or the first of name_2, name_3, ... that is not taken.
std::string make_unique_name(const std::string& name, const std::function<bool(const std::string&)>& is_taken);

/// ` (did you mean "stiffness"?)` where one of `words` is near, else nothing.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& words);

}  // namespace catena
