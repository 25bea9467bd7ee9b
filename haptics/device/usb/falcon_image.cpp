#include "haptics/device/usb/falcon_image.h"

#include <fmt/format.h>

#include <filesystem>

#include "engine/base/text.h"

namespace catena::haptics::usb {
namespace {

constexpr std::size_t kHeaderBytes = 22, kBlockHeaderBytes = 6;
constexpr std::uint32_t kAddressEnd = 1u << 22;
constexpr unsigned kKey = 0x08AA;

Error error_at(const std::string& name, std::size_t offset, const std::string& what) {
  return Error{fmt::format("{}: byte {}: {}; a Falcon firmware image (a TI C2000 boot stream) was expected", name, offset, what)};
}

}  // namespace

Result<FalconImageInfo> check_falcon_image(std::span<const std::uint8_t> image, const std::string& name) {
  const auto word = [image](std::size_t at) { return static_cast<std::uint32_t>(image[at] | (image[at + 1] << 8)); };
  if (image.size() > kFalconImageMaxBytes)
    return error_at(name, kFalconImageMaxBytes,
                    fmt::format("too long, {} bytes; at most {} were expected", image.size(), kFalconImageMaxBytes));
  if (image.size() % 2 != 0) return error_at(name, image.size(), "half a word at the end; an even number of bytes was expected");
  if (image.size() < 2) return error_at(name, 0, "empty; the key 0x08AA was expected");
  if (word(0) != kKey) return error_at(name, 0, fmt::format("0x{:04X} where the key 0x08AA was expected", word(0)));
  if (image.size() < kHeaderBytes) return error_at(name, image.size(), fmt::format("it ends within its header of {} bytes", kHeaderBytes));
  FalconImageInfo info;
  info.entry = (word(18) << 16) | word(20);
  if (info.entry >= kAddressEnd)
    return error_at(name, 18, fmt::format("entry address 0x{:X}; one below 0x400000 was expected", info.entry));

  std::size_t at = kHeaderBytes;
  while (true) {
    if (at + 2 > image.size()) return error_at(name, at, "it ends where the size of a block, or the closing 0, was expected");
    const std::size_t words = word(at);
    if (words == 0) break;
    if (at + kBlockHeaderBytes > image.size()) return error_at(name, at + 2, "it ends where the address of a block was expected");
    const std::size_t address = (std::size_t{word(at + 2)} << 16) | word(at + 4), left = image.size() - at - kBlockHeaderBytes;
    if (address + words > kAddressEnd)
      return error_at(name, at + 2, fmt::format("a block of {} words at 0x{:X}; an end below 0x400000 was expected", words, address));
    if (2 * words > left)
      return error_at(name, at,
                      fmt::format("a block of {} bytes where {} bytes are left; the file is cut short, or no such image", 2 * words, left));
    at += kBlockHeaderBytes + 2 * words;
    info.data_words += words;
    ++info.blocks;
  }
  if (info.blocks == 0) return error_at(name, kHeaderBytes, "the closing 0 where a first block was expected");
  if (at + 2 != image.size())
    return error_at(name, at + 2, fmt::format("{} bytes after the closing 0; the end was expected", image.size() - at - 2));
  return info;
}

Result<std::vector<std::uint8_t>> read_falcon_image(const std::string& path) {
  // before anything large is read
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > kFalconImageMaxBytes)
    return error_at(path, kFalconImageMaxBytes, fmt::format("too long, {} bytes; at most {} were expected", size, kFalconImageMaxBytes));
  CATENA_TRY(const std::string text, read_text(path, "a Falcon firmware image"));
  std::vector<std::uint8_t> image(text.begin(), text.end());
  CATENA_CHECK(check_falcon_image(image, path));
  return image;
}

}  // namespace catena::haptics::usb
