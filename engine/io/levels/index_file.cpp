// SPDX-License-Identifier: MIT
#include "engine/io/levels/index_file.h"

#include <cstring>
#include <fstream>
#include <utility>

#include "engine/base/hash.h"
#include "engine/base/output_file.h"
#include "engine/io/message.h"

namespace catena::field {
namespace {

constexpr std::string_view kIndexStart = "catena brick index 1\n";

template <class T>
void put_array(Encoder& e, const std::vector<T>& items) {
  e.words(std::string(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)));
}

template <class T>
std::vector<T> get_array(Decoder& d) {
  const std::string bytes = d.words();
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!items.empty()) std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
  return items;
}

/// Returns the contents of a file whose hash is right, without the hash; empty: there are none.
std::string read_hashed(const std::string& path) {
  constexpr std::streamoff kMaxBytes = std::streamoff{1} << 31;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  std::uint64_t hash = 0;
  if (!in || size < static_cast<std::streamoff>(sizeof hash) || size > kMaxBytes) return {};
  std::string text(static_cast<std::size_t>(size), '\0');
  in.seekg(0);
  if (!in.read(text.data(), size)) return {};
  std::memcpy(&hash, text.data() + text.size() - sizeof hash, sizeof hash);
  text.resize(text.size() - sizeof hash);
  return hash == hash_bytes(text.data(), text.size()) ? text : std::string();
}

bool is_count(const Index3& n) {
  constexpr std::int32_t kMost = 1 << 24;
  constexpr double kMostBricks = 1LL << 32;
  for (const std::int32_t v : {n.x, n.y, n.z})
    if (v < 1 || v > kMost) return false;
  return static_cast<double>(n.x) * n.y * n.z <= kMostBricks;
}

}  // namespace

Outcome write_index(const std::string& path, const std::string& identity, const BrickIndex& index) {
  Encoder e;
  e.words(identity);
  e.number<std::int32_t>(index.first_level);
  e.number(index.fill_value);
  e.number<std::uint64_t>(index.levels.size());
  for (const LevelIndex& level : index.levels) {
    for (const std::int32_t n : {level.counts().x, level.counts().y, level.counts().z}) e.number(n);
    put_array(e, level.bits());
    put_array(e, level.entries());
    put_array(e, level.checksums());
  }
  std::string text = std::string(kIndexStart) + e.take();
  const std::uint64_t hash = hash_bytes(text.data(), text.size());
  text.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  auto out = OutputFile::open(path);
  if (!out) return Error{out.error().message, true};
  out->write(text);
  out->sync();
  if (const Outcome done = out->commit(); !done) return Error{done.error().message, true};
  return Done{};
}

std::optional<BrickIndex> read_index(const std::string& path, const std::string& identity) {
  const std::string text = read_hashed(path);
  if (!text.starts_with(kIndexStart)) return std::nullopt;
  Decoder d(std::as_bytes(std::span(text)).subspan(kIndexStart.size()));
  if (d.words() != identity) return std::nullopt;
  BrickIndex index;
  index.first_level = d.number<std::int32_t>();
  index.fill_value = d.number<double>();
  constexpr std::size_t kMinLevel = 36;
  for (std::uint64_t n = d.count(kMinLevel); n > 0 && d.ok(); --n) {
    Index3 counts{0, 0, 0};
    for (std::int32_t* v : {&counts.x, &counts.y, &counts.z}) *v = d.number<std::int32_t>();
    if (!is_count(counts)) return std::nullopt;
    auto bits = get_array<std::uint64_t>(d);
    auto entries = get_array<LevelIndex::Entry>(d);
    auto checksums = get_array<std::uint32_t>(d);
    for (LevelIndex& level : LevelIndex::from_parts(counts, std::move(bits), std::move(entries), std::move(checksums)))
      index.levels.push_back(std::move(level));
    if (index.levels.empty() || !(index.levels.back().counts() == counts)) return std::nullopt;
  }
  if (!d.finished()) return std::nullopt;
  return index;
}

}  // namespace catena::field
