// SPDX-License-Identifier: MIT
#include "engine/base/text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/system_failure.h"

namespace catena {

namespace {

/// Returns a message fragment for a file that is not regular.
const char* describe_kind(mode_t mode) {
  if (S_ISDIR(mode)) return "is a folder";
  if (S_ISFIFO(mode)) return "is a pipe";
  if (S_ISSOCK(mode)) return "is a socket";
  return "is a device";
}

std::string size_in_words(std::uint64_t bytes) {
  const bool large = bytes >= (std::uint64_t{10} << 20);
  return std::to_string(bytes >> (large ? 20 : 10)) + (large ? " MiB" : " KiB");
}

struct Closer {
  int descriptor;
  ~Closer() { ::close(descriptor); }
};

}  // namespace

Result<std::string> read_text_file(const std::string& path, std::string_view expected, std::uint64_t max_bytes) {
  const auto failed = [&](const std::string& problem) {
    return Error{one_line(path + ": " + problem + "; " + std::string(expected) + " was expected")};
  };
  const auto unreadable = [&](int code) {
    Error error = failed("cannot be read: " + describe_errno(code));
    error.system_failure = is_system_failure(code);
    return error;
  };
  const auto too_large = [&](std::uint64_t bytes) {
    return Error{one_line(path + ": is " + size_in_words(bytes) + " large; " + std::string(expected) + " of at most " +
                          size_in_words(max_bytes) + " was expected")};
  };
  // opens a pipe without a writer without blocking; it is rejected below
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0 && errno == ENXIO) return failed("is a socket or a device");
  if (descriptor < 0) {
    return unreadable(errno);
  }
  const Closer closer{descriptor};
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return unreadable(errno);
  if (!S_ISREG(about.st_mode)) return failed(describe_kind(about.st_mode));
  const auto size = static_cast<std::uint64_t>(about.st_size);
  if (size > max_bytes) return too_large(size);
  // a sparse file is no text: it is rejected before it is read
  constexpr std::uint64_t kLarge = 16 << 20, kMaxRatio = 100;
  const std::uint64_t on_disk = 512 * static_cast<std::uint64_t>(about.st_blocks);
  if (size > kLarge && on_disk < size / kMaxRatio)
    return failed("is " + size_in_words(size) + " large, with " + size_in_words(on_disk) + " on the disk and nothing else");
  CATENA_CHECK(check_text_memory_available(one_line(path), static_cast<double>(size)));
  std::string text;
  text.reserve(size);
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(descriptor, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(errno);
    if (got == 0) return text;
    // the file has grown while it was read
    if (text.size() + static_cast<std::size_t>(got) > max_bytes) return too_large(text.size() + static_cast<std::size_t>(got));
    text.append(buffer, static_cast<std::size_t>(got));
  }
}

std::string_view strip_bom(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t max_length = 60;
  std::string out = "\"";
  for (char c : text.substr(0, max_length)) out += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? '?' : c;
  return out + (text.size() > max_length ? "...\"" : "\"");
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

namespace {

/// Returns the length in bytes of the UTF-8 character at the start of the text and sets `number` to its code point; 0 if it is invalid.
std::size_t utf8_character(std::string_view text, std::uint32_t& number) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first >> 5 == 0x6 ? 2 : first >> 4 == 0xe ? 3 : first >> 3 == 0x1e ? 4 : 0;
  if (length == 0 || length > text.size()) return 0;
  number = length == 1 ? first : first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 2) return 0;
    number = number << 6 | (byte(i) & 0x3f);
  }
  // rejects overlong encodings, surrogates and code points above 0x10ffff
  constexpr std::uint32_t kMinCodePoint[] = {0, 0, 0x80, 0x800, 0x10000};
  return number >= kMinCodePoint[length] && number <= 0x10ffff && (number < 0xd800 || number > 0xdfff) ? length : 0;
}

bool is_control(std::uint32_t c) {
  const bool turns_writing = c == 0x61c || c == 0x200e || c == 0x200f || (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x2028 || c == 0x2029 || turns_writing;
}

}  // namespace

std::string sanitize_for_terminal(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::uint32_t number = 0;
    const std::size_t length = utf8_character(text, number);
    if (length == 0 || is_control(number))
      out += '?';
    else
      out += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string join_alternatives(const std::vector<std::string_view>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text.append(i == 0 ? "" : i + 1 < words.size() ? ", " : " or ").append(words[i]);
  return text;
}

bool has_extension(std::string_view name, std::string_view lower_case) {
  if (name.size() < lower_case.size()) return false;
  name.remove_prefix(name.size() - lower_case.size());
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(name.begin(), name.end(), lower_case.begin(), [&](char a, char b) { return lower(a) == b; });
}

std::string join_words(const std::vector<std::string_view>& words, std::size_t max_count) {
  std::string out;
  const std::size_t listed = std::min(words.size(), max_count);
  for (std::size_t i = 0; i < listed; ++i) out.append(i == 0 ? "" : ", ").append(words[i]);
  if (listed < words.size()) out += " and " + std::to_string(words.size() - listed) + " more";
  return out;
}

std::string strip_addresses(std::string text) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); };
  constexpr std::size_t kMinDigits = 6;
  for (std::size_t at = 0; (at = text.find("0x", at)) != std::string::npos;) {
    std::size_t begin = at, end = at + 2;
    while (end < text.size() && is_hex(text[end])) ++end;
    if (end - at < 2 + kMinDigits) {
      at = end;
      continue;
    }
    // also removes the brackets around the address and the blank before them
    if (begin > 0 && end < text.size() && text[begin - 1] == '(' && text[end] == ')') --begin, ++end;
    if (begin > 0 && text[begin - 1] == ' ') --begin;
    text.erase(begin, end - begin);
    at = begin;
  }
  return text;
}

std::string truncate_utf8(std::string text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes - std::min<std::size_t>(max_bytes, 3);
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  text.resize(end);
  return text + "...";
}

namespace {
// Levenshtein distance; both words are short (the caller truncates them).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      diagonal = above;
    }
  }
  return row[b.size()];
}
}  // namespace

std::string make_unique_name(const std::string& name, const std::function<bool(const std::string&)>& is_taken) {
  std::string unique_name = name;
  for (int n = 2; is_taken(unique_name); ++n) unique_name = name + "_" + std::to_string(n);
  return unique_name;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& words) {
  if (word.empty() || word.size() > 40) return {};
  std::size_t best = 3;
  std::string_view nearest;
  for (std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best && distance < candidate.size()) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest.empty() ? std::string() : " (did you mean " + in_quotes(nearest) + "?)";
}

}  // namespace catena
