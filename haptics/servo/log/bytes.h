/// Payloads as bytes: numbers and strings appended, and read back with every length checked against what is there.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace catena::haptics::log {

class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void put_string(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  void put_bytes(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// After the first read past the end everything reads as zero and `good` is false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    if (const char* from = take(sizeof value)) std::memcpy(&value, from, sizeof value);
    return value;
  }
  std::string get_string() {
    const auto size = get<std::uint32_t>();
    const char* from = take(size);
    return from != nullptr ? std::string(from, size) : std::string();
  }
  /// nullptr where fewer are left.
  const char* take(std::size_t size) {
    if (!good_ || size > bytes_.size() - at_) {
      good_ = false;
      return nullptr;
    }
    const char* from = bytes_.data() + at_;
    at_ += size;
    return from;
  }
  bool good() const { return good_; }
  bool finished() const { return good_ && at_ == bytes_.size(); }  ///< all read, nothing left

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

}  // namespace catena::haptics::log
