// SPDX-License-Identifier: MIT
#include "engine/app/batch/run_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/base/numbers.h"
#include "engine/base/version.h"

namespace catena::app {

namespace {

constexpr std::uint64_t kWholeBytes = std::uint64_t{4} << 20, kBlockBytes = 4096, kBlocks = 64;

}  // namespace

RunKey::RunKey(std::string_view command) { add(command).add(kVersion); }

RunKey& RunKey::add(std::string_view words) {
  hash_.add_text(words);
  return *this;
}

RunKey& RunKey::add(double number) { return add(to_text(number)); }

void RunKey::add_file(const std::string& path) {
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path, code);
  std::ifstream in(path, std::ios::binary);
  if (code || !in) return;
  add(fmt::format("{} bytes", size));
  const std::uint64_t block = size <= kWholeBytes ? size : kBlockBytes, count = size <= kWholeBytes ? 1 : kBlocks;
  std::string bytes(block, '\0');
  for (std::uint64_t k = 0; k < count; ++k) {
    // the first block begins the file, the last one ends it
    in.seekg(static_cast<std::streamoff>(
        count == 1 ? 0 : (size - block) / (count - 1) * k + (k + 1 == count ? (size - block) % (count - 1) : 0)));
    in.read(bytes.data(), static_cast<std::streamsize>(block));
    add(std::string_view(bytes).substr(0, static_cast<std::size_t>(in.gcount())));
  }
}

RunKey& RunKey::add_files(const std::vector<std::string>& paths) {
  namespace fs = std::filesystem;
  for (const std::string& path : paths) {
    std::error_code code;
    if (!fs::is_directory(path, code)) {
      if (fs::is_regular_file(path, code)) add_file(path);
      continue;
    }
    std::vector<std::string> files;
    for (fs::directory_iterator it(path, code), end; !code && it != end; it.increment(code)) {
      std::error_code no_size;
      const auto size = it->is_regular_file(no_size) ? it->file_size(no_size) : 0;
      files.push_back(fmt::format("{} {}", it->path().filename().string(), size));
    }
    std::ranges::sort(files);
    for (const std::string& file : files) add(file);
  }
  return *this;
}

std::string RunKey::text() const { return fmt::format("{:016x}", hash_.value); }

}  // namespace catena::app
