#include "haptics/servo/log/block_reader.h"

#include <algorithm>
#include <cstring>

#include "engine/base/hash.h"

namespace catena::haptics::log {

namespace {

constexpr std::uint64_t kHeadBytes = sizeof(BlockHead);
constexpr std::size_t kWindow = std::size_t{64} << 10;

bool is_head(const char* bytes, BlockHead& head) {
  std::memcpy(&head, bytes, sizeof head);
  return head.mark == BlockHead::kBlockMark && head.head_hash == hash_of(bytes, BlockHead::kHashed) && head.length <= kMaxPayload;
}

}  // namespace

bool BlockReader::read_head(std::uint64_t at, BlockHead& head) {
  char bytes[kHeadBytes];
  return source_->read(at, bytes, kHeadBytes) && is_head(bytes, head);
}

// Moves on to the next place where a block's own 32 bytes are good.
bool BlockReader::find_next_head() {
  std::string window;
  BlockHead head;
  for (std::uint64_t from = at_ + 1; from + kHeadBytes <= source_->size();) {
    window.resize(std::min<std::uint64_t>(kWindow, source_->size() - from));
    if (!source_->read(from, window.data(), window.size())) return false;
    const std::size_t places = window.size() - kHeadBytes + 1;
    for (std::size_t k = 0; k < places; ++k) {
      if (!is_head(window.data() + k, head)) continue;
      at_ = from + k;
      return true;
    }
    from += places;
  }
  return false;
}

BlockReader::Found BlockReader::next() {
  const std::uint64_t size = source_->size();
  if (at_ >= size) return Found::end;
  if (size - at_ < kHeadBytes) return Found::cut_off;
  if (!read_head(at_, head_)) {
    if (find_next_head()) return Found::damaged;
    return Found::cut_off;
  }
  if (head_.length > size - at_ - kHeadBytes) return Found::cut_off;
  payload_.resize(head_.length);
  const bool good =
      source_->read(at_ + kHeadBytes, payload_.data(), payload_.size()) && hash_of(payload_.data(), payload_.size()) == head_.payload_hash;
  at_ += kHeadBytes + head_.length;
  return good ? Found::block : Found::damaged;
}

}  // namespace catena::haptics::log
