// SPDX-License-Identifier: MIT
/// Input streams over bytes in memory that throw when read past the end: OpenVDB does not detect every short read.
#pragma once
#include <cstddef>
#include <cstring>
#include <istream>
#include <span>
#include <stdexcept>
#include <streambuf>

namespace catena::vdb {

/// Stream buffer over `bytes`, which must outlive it. Reading or seeking past the end throws std::runtime_error.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::span<const std::byte> bytes) {
    char* start = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(start, start, start + bytes.size());
  }

 protected:
  int_type underflow() override { throw std::runtime_error("the file ends too early"); }
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    if (count < 0 || count > egptr() - gptr()) throw std::runtime_error("the file ends too early");
    std::memcpy(to, gptr(), static_cast<std::size_t>(count));
    setg(eback(), gptr() + count, egptr());
    return count;
  }
  pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type base = from == std::ios_base::beg ? 0 : from == std::ios_base::cur ? gptr() - eback() : egptr() - eback();
    off_type offset = 0;
    if (__builtin_add_overflow(base, by, &offset) || offset < 0 || offset > egptr() - eback())
      throw std::runtime_error("an offset is beyond the end of the file");
    setg(eback(), eback() + offset, egptr());
    return offset;
  }
  pos_type seekpos(pos_type offset, std::ios_base::openmode mode) override { return seekoff(offset, std::ios_base::beg, mode); }
};

/// Input stream over `bytes`; every failure of the stream throws.
class MemoryStream : public std::istream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : std::istream(nullptr), buffer_(bytes) {
    rdbuf(&buffer_);
    exceptions(std::ios::badbit | std::ios::failbit);
  }

 private:
  MemoryBuffer buffer_;
};

}  // namespace catena::vdb
