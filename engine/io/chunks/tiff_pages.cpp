// SPDX-License-Identifier: MIT
#include "engine/io/chunks/tiff_pages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

namespace catena::chunks {
namespace {

constexpr std::size_t kMaxPages = 1'000'000, kMaxEntries = 4096, kMaxLevels = 32;

/// The file with its byte order and its kind.
class Directory {
 public:
  Directory(int file, std::uint64_t bytes) : file_(file), bytes_(bytes) {}

  /// Reads the header; returns the offset of the first directory.
  Result<std::uint64_t> open() {
    unsigned char head[16] = {};
    const ssize_t got = ::pread(file_, head, sizeof head, 0);
    if (got < 8 || head[0] != head[1] || (head[0] != 'I' && head[0] != 'M')) return Error{"is not a TIFF file"};
    is_swapped_ = (head[0] == 'M') == (std::endian::native == std::endian::little);
    const std::uint64_t version = number(head + 2, 2);
    is_big_ = version == 43;
    if (version != 42 && !(is_big_ && got == sizeof head && number(head + 4, 2) == 8)) return Error{"is not a TIFF file"};
    return is_big_ ? number(head + 8, 8) : number(head + 4, 4);
  }

  /// Reads a directory; `next` receives the offset of the following one.
  Result<TiffPage> read(std::uint64_t offset, std::uint64_t& next) {
    const std::size_t count_bytes = is_big_ ? 8 : 2, entry = is_big_ ? 20 : 12, word = is_big_ ? 8 : 4;
    const auto outside = [&] {
      return Error{fmt::format("is damaged: a directory at {} lies outside of the file of {} bytes", offset, bytes_)};
    };
    if (!take(offset, count_bytes)) return outside();
    const std::uint64_t count = number(block_.data(), count_bytes);
    if (count < 1 || count > kMaxEntries)
      return Error{fmt::format("is damaged: a directory has {} entries, expected 1 to {}", count, kMaxEntries)};
    if (!take(offset + count_bytes, count * entry + word)) return outside();
    const std::vector<unsigned char> entries = block_;
    next = number(entries.data() + count * entry, word);
    TiffPage page;
    page.offset = offset;
    for (std::uint64_t i = 0; i < count; ++i) CATENA_CHECK(use(entries.data() + i * entry, page));
    return page;
  }

 private:
  std::uint64_t number(const unsigned char* at, std::size_t bytes) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const bool is_low_first = (std::endian::native == std::endian::little) != is_swapped_;
      value |= std::uint64_t{at[i]} << (8 * (is_low_first ? i : bytes - 1 - i));
    }
    return value;
  }

  bool take(std::uint64_t offset, std::uint64_t bytes) {
    if (offset > bytes_ || bytes > bytes_ - offset) return false;
    block_.resize(bytes);
    return ::pread(file_, block_.data(), bytes, static_cast<off_t>(offset)) == static_cast<ssize_t>(bytes);
  }

  /// Reads the values of an entry; empty: another type, or more than `max`.
  std::vector<std::uint64_t> values(const unsigned char* entry, std::size_t max) {
    constexpr std::size_t kBytes[] = {0, 1, 0, 2, 4, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 8, 0, 8};  // by type: integers and offsets
    const std::uint64_t type = number(entry + 2, 2), count = number(entry + 4, is_big_ ? 8 : 4);
    const std::size_t bytes = type < std::size(kBytes) ? kBytes[type] : 0, word = is_big_ ? 8 : 4;
    if (bytes == 0 || count < 1 || count > max) return {};
    const unsigned char* at = entry + (is_big_ ? 12 : 8);
    if (count * bytes > word) {
      if (!take(number(at, word), count * bytes)) return {};
      at = block_.data();
    }
    std::vector<std::uint64_t> found;
    for (std::uint64_t i = 0; i < count; ++i) found.push_back(number(at + i * bytes, bytes));
    return found;
  }

  Outcome use(const unsigned char* entry, TiffPage& page) {
    constexpr std::size_t kMaxSamples = 4096;
    const std::uint64_t tag = number(entry, 2);
    constexpr std::uint64_t kTags[] = {254, 256, 257, 258, 277, 284, 330, 339, 32997};
    if (std::ranges::find(kTags, tag) == std::end(kTags)) return Done{};
    const std::vector<std::uint64_t> numbers = values(entry, tag == 330 ? kMaxLevels : kMaxSamples);
    if (numbers.empty()) return tag == 330 ? Outcome(Done{}) : Outcome(Error{fmt::format("is damaged: the tag {} is invalid", tag)});
    const std::uint64_t first = numbers.front();
    constexpr std::uint64_t kMax = 1 << 24;
    if (tag != 330 && first > kMax)
      return Error{fmt::format("is damaged: the tag {} has the value {}, expected at most {}", tag, first, kMax)};
    const auto value = static_cast<int>(first);
    const bool is_one = std::ranges::all_of(numbers, [&](std::uint64_t n) { return n == first; });
    if ((tag == 258 || tag == 339) && !is_one) return Error{"has samples of different types, expected one type"};
    switch (tag) {
      case 254:
        page.is_reduced = (value & 5) != 0;
        break;
      case 256:
        page.width = value;
        break;
      case 257:
        page.height = value;
        break;
      case 258:
        page.bits = value;
        break;
      case 277:
        page.samples = value;
        break;
      case 284:
        page.is_separate = value == 2;
        break;
      case 330:
        page.coarser = numbers;
        break;
      case 339:
        page.format = value == 4 ? 1 : value;
        break;
      default:
        page.depth = value;
    }
    return Done{};
  }

  int file_;
  std::uint64_t bytes_;
  bool is_swapped_ = false, is_big_ = false;
  std::vector<unsigned char> block_;
};

}  // namespace

Result<std::vector<TiffPage>> read_tiff_pages(int file, std::uint64_t file_bytes) {
  Directory directory(file, file_bytes);
  CATENA_TRY(std::uint64_t offset, directory.open());
  std::vector<TiffPage> pages;
  std::set<std::uint64_t> visited;
  while (offset != 0) {
    if (!visited.insert(offset).second) return Error{"is damaged: its pages are a loop"};
    if (pages.size() >= kMaxPages) return Error{fmt::format("has more than {} pages", kMaxPages)};
    CATENA_TRY(TiffPage page, directory.read(offset, offset));
    pages.push_back(std::move(page));
  }
  if (pages.empty()) return Error{"has no page"};
  return pages;
}

Result<TiffPage> read_tiff_page(int file, std::uint64_t file_bytes, std::uint64_t offset) {
  Directory directory(file, file_bytes);
  CATENA_TRY(std::uint64_t next, directory.open());
  return directory.read(offset, next);
}

}  // namespace catena::chunks
