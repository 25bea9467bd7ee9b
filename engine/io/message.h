// SPDX-License-Identifier: MIT
/// Binary messages between catena and its reader processes: numbers in native byte order, texts with their length in front. Private to this
/// module.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/field/mapping.h"
#include "engine/io/protocol.h"

namespace catena::field {

/// Encodes a message.
class Encoder {
 public:
  template <class T>
  void number(T v) {
    static_assert(std::is_trivially_copyable_v<T>);
    text_.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  void flag(bool v) { number<std::uint8_t>(v ? 1 : 0); }
  void words(const std::string& s) {
    number<std::uint64_t>(s.size());
    text_ += s;
  }
  void vector(const Vec3& v) {
    for (int a = 0; a < 3; ++a) number<double>(v[a]);
  }
  void mapping(const Mapping& m) {
    for (int a = 0; a < 3; ++a) vector(m.world_from_index_linear[a]);
    vector(m.origin);
  }
  void piece(const BufferRange& p) {
    number(p.offset);
    number(p.bytes);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Decodes a message. Records the first read beyond the end, and returns zeros from then on.
class Decoder {
 public:
  explicit Decoder(std::span<const std::byte> bytes) : left_(bytes) {}
  template <class T>
  T number() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    T v{};
    if (left_.size() < sizeof v) {
      ok_ = false;
      return v;
    }
    std::memcpy(&v, left_.data(), sizeof v);
    left_ = left_.subspan(sizeof v);
    return v;
  }
  bool flag() { return number<std::uint8_t>() != 0; }
  std::string words() {
    const auto size = number<std::uint64_t>();
    if (!ok_ || size > left_.size()) {
      ok_ = false;
      return {};
    }
    std::string s(reinterpret_cast<const char*>(left_.data()), size);
    left_ = left_.subspan(size);
    return s;
  }
  Vec3 vector() {
    Vec3 v;
    for (int a = 0; a < 3; ++a) v[a] = number<double>();
    return v;
  }
  Mapping mapping() {
    Mat3 linear;
    for (int a = 0; a < 3; ++a) linear[a] = vector();
    return Mapping::from_linear(linear, vector());
  }
  BufferRange piece() {
    BufferRange p;
    p.offset = number<std::uint64_t>();
    p.bytes = number<std::uint64_t>();
    return p;
  }
  /// Returns the number of items of at least `min_bytes` bytes each; 0 and a failure if they do not fit into the rest of the message.
  std::uint64_t count(std::size_t min_bytes) {
    const auto n = number<std::uint64_t>();
    if (n > left_.size() / min_bytes) ok_ = false;
    return ok_ ? n : 0;
  }
  bool ok() const { return ok_; }
  bool finished() const { return ok_ && left_.empty(); }

 private:
  std::span<const std::byte> left_;
  bool ok_ = true;
};

}  // namespace catena::field
