// SPDX-License-Identifier: MIT
#include "engine/io/chunks/codecs.h"

#include <blosc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <lz4.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>

#include "engine/base/helper_process.h"
#include "engine/base/system_failure.h"

namespace catena::chunks {
namespace {

Error wrong_size(std::size_t bytes, std::size_t expected) {
  return Error{fmt::format("has {} bytes when decompressed, expected {}", bytes, expected)};
}

struct FreeDecompressor {
  void operator()(libdeflate_decompressor* d) const { ::libdeflate_free_decompressor(d); }
};

Outcome inflate_into(std::span<const std::byte> in, std::span<std::byte> out) {
  thread_local const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(::libdeflate_alloc_decompressor());
  if (!decompressor) return Error{"cannot be decompressed: there is not enough memory"};
  const bool is_gzip = in.size() > 1 && in[0] == std::byte{0x1f} && in[1] == std::byte{0x8b};
  const auto inflate = is_gzip ? ::libdeflate_gzip_decompress_ex : ::libdeflate_zlib_decompress_ex;
  std::size_t made = 0;
  // a gzip file may have several members
  do {
    std::size_t used = 0, of_member = 0;
    const std::span<std::byte> rest = out.subspan(made);
    const libdeflate_result status = inflate(decompressor.get(), in.data(), in.size(), rest.data(), rest.size(), &used, &of_member);
    if (status == LIBDEFLATE_INSUFFICIENT_SPACE) return Error{fmt::format("has more than {} bytes when decompressed", out.size())};
    if (status != LIBDEFLATE_SUCCESS) return Error{"is not a zlib or gzip stream, is truncated or damaged"};
    made += of_member;
    in = in.subspan(used);
  } while (is_gzip && !in.empty() && made < out.size());
  if (made != out.size()) return wrong_size(made, out.size());
  return Done{};
}

Outcome blosc_into(std::span<const std::byte> in, std::span<std::byte> out) {
  std::size_t bytes = 0;
  if (in.size() < BLOSC_MIN_HEADER_LENGTH || ::blosc_cbuffer_validate(in.data(), in.size(), &bytes) != 0)
    return Error{"is not a blosc buffer, or is truncated"};
  if (bytes != out.size()) return wrong_size(bytes, out.size());
  const int made = ::blosc_decompress_ctx(in.data(), out.data(), out.size(), 1);
  if (made < 0 || static_cast<std::size_t>(made) != out.size()) return Error{"is damaged, or blosc's codec in it is not supported"};
  return Done{};
}

Outcome zstd_into(std::span<const std::byte> in, std::span<std::byte> out) {
  const std::size_t made = ::ZSTD_decompress(out.data(), out.size(), in.data(), in.size());
  if (::ZSTD_isError(made) != 0) return Error{fmt::format("is not a zstd frame of {} bytes ({})", out.size(), ::ZSTD_getErrorName(made))};
  if (made != out.size()) return wrong_size(made, out.size());
  return Done{};
}

Outcome lz4_into(std::span<const std::byte> in, std::span<std::byte> out) {
  std::uint32_t bytes = 0;
  if (in.size() < sizeof bytes || in.size() > LZ4_MAX_INPUT_SIZE || out.size() > LZ4_MAX_INPUT_SIZE) return Error{"is not an LZ4 block"};
  std::memcpy(&bytes, in.data(), sizeof bytes);
  if (bytes != out.size()) return wrong_size(bytes, out.size());
  const int made = ::LZ4_decompress_safe(reinterpret_cast<const char*>(in.data()) + sizeof bytes, reinterpret_cast<char*>(out.data()),
                                         static_cast<int>(in.size() - sizeof bytes), static_cast<int>(out.size()));
  if (made < 0) return Error{"is not an LZ4 block, or is damaged"};
  if (static_cast<std::size_t>(made) != out.size()) return wrong_size(static_cast<std::size_t>(made), out.size());
  return Done{};
}

}  // namespace

std::optional<Codec> find_codec(std::string_view id) {
  if (id == "zlib" || id == "gzip") return Codec::deflate;
  if (id == "blosc") return Codec::blosc;
  if (id == "zstd") return Codec::zstd;
  if (id == "lz4") return Codec::lz4;
  return std::nullopt;
}

Outcome decompress(Codec codec, std::span<const std::byte> in, std::span<std::byte> out) {
  switch (codec) {
    case Codec::none:
      break;
    case Codec::deflate:
      return inflate_into(in, out);
    case Codec::blosc:
      return blosc_into(in, out);
    case Codec::zstd:
      return zstd_into(in, out);
    case Codec::lz4:
      return lz4_into(in, out);
  }
  if (in.size() != out.size()) return Error{fmt::format("has {} bytes, expected {}", in.size(), out.size())};
  std::memcpy(out.data(), in.data(), in.size());
  return Done{};
}

Result<std::optional<std::vector<std::byte>>> read_chunk_file(const char* path, std::size_t max_bytes) {
  const FileDescriptor file(::open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file && (errno == ENOENT || errno == ENOTDIR)) return std::optional<std::vector<std::byte>>();
  struct stat about {};
  if (!file || ::fstat(file.get(), &about) != 0)
    return Error{fmt::format("cannot be opened ({})", describe_errno(errno)), is_system_failure(errno)};
  if (!S_ISREG(about.st_mode)) return Error{"is not a regular file"};
  const auto bytes = static_cast<std::uint64_t>(about.st_size);
  if (bytes > max_bytes) return Error{fmt::format("has {} bytes, expected at most {}", bytes, max_bytes)};
  std::vector<std::byte> data(bytes);
  for (std::size_t at = 0; at < data.size();) {
    const ssize_t got = ::read(file.get(), data.data() + at, data.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error{fmt::format("cannot be read ({})", describe_errno(errno)), is_system_failure(errno)};
    if (got == 0) return Error{"became shorter while it was read"};
    at += static_cast<std::size_t>(got);
  }
  return std::optional(std::move(data));
}

}  // namespace catena::chunks
