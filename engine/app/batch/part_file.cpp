// SPDX-License-Identifier: MIT
#include "engine/app/batch/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "engine/base/json.h"
#include "engine/base/json_text.h"
#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLastLine = 1024, kHashedBlock = std::size_t{1} << 20, kMaxListedShards = 8;

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

/// The last line of a part.
struct LastLine {
  std::string shard, command, run, hash;
  std::uint64_t bytes = 0;
};

/// Reads the last line; nullopt if the file does not end with one.
std::optional<LastLine> read_last_line(std::ifstream& in, const std::string& path, std::uint64_t size) {
  const std::uint64_t from = size > kMaxLastLine ? size - kMaxLastLine : 0;
  std::string end(static_cast<std::size_t>(size - from), '\0');
  in.seekg(static_cast<std::streamoff>(from));
  if (!in.read(end.data(), static_cast<std::streamsize>(end.size())) || !end.ends_with("}\n")) return std::nullopt;
  const std::size_t line_end = end.size() - 1, before = end.rfind('\n', line_end - 1), begin = before == std::string::npos ? 0 : before + 1;
  const std::string_view line = std::string_view(end).substr(begin, line_end - begin);
  if (!line.starts_with("# ")) return std::nullopt;
  const auto root = json::parse(line.substr(2), path);
  if (!root) return std::nullopt;
  LastLine last;
  for (const auto& [key, member] :
       {std::pair{"part", &LastLine::shard}, {"command", &LastLine::command}, {"run", &LastLine::run}, {"hash", &LastLine::hash}}) {
    const auto word = json::require_string(*root, key);
    if (!word) return std::nullopt;
    last.*member = *word;
  }
  const auto bytes = json::require_number(*root, "bytes", json::NumberRange::non_negative);
  if (!bytes || *bytes != static_cast<double>(from + begin)) return std::nullopt;
  last.bytes = from + begin;
  return last;
}

/// Whether the first `bytes` of the file have the hash.
bool has_hash(std::ifstream& in, std::uint64_t bytes, const std::string& expected) {
  Fnv1a hash;
  std::string block(kHashedBlock, '\0');
  in.clear();
  in.seekg(0);
  for (std::uint64_t done = 0; done < bytes;) {
    const auto count = static_cast<std::streamsize>(std::min<std::uint64_t>(kHashedBlock, bytes - done));
    if (!in.read(block.data(), count)) return false;
    hash.add_bytes(block.data(), static_cast<std::size_t>(count));
    done += static_cast<std::uint64_t>(count);
  }
  return hex(hash.value) == expected;
}

/// "shard 2/4 is missing", "shards 2/4 and 3/4 are missing", with at most kMaxListedShards of them.
std::string missing_shards_message(const std::vector<Shard>& missing) {
  std::string text;
  for (std::size_t i = 0; i < std::min(missing.size(), kMaxListedShards); ++i)
    text += (i == 0 ? "" : i + 1 == missing.size() ? " and " : ", ") + missing[i].text();
  if (missing.size() > kMaxListedShards) text += fmt::format(" and {} more", missing.size() - kMaxListedShards);
  return fmt::format("shard{} {} {} missing", missing.size() == 1 ? "" : "s", text, missing.size() == 1 ? "is" : "are");
}

}  // namespace

Result<PartWriter> PartWriter::open(const std::string& path, const Shard& shard, std::string command, std::string run) {
  CATENA_TRY(OutputFile file, OutputFile::open(part_path(path, shard)));
  return PartWriter(std::move(file), shard, std::move(command), std::move(run));
}

void PartWriter::write(std::string_view text) {
  file_.write(text);
  hash_.add_bytes(text.data(), text.size());
  bytes_ += text.size();
}

void PartWriter::end() {
  file_.write(fmt::format(R"(# {{"part": {}, "command": {}, "run": {}, "bytes": {}, "hash": {}}})"
                          "\n",
                          json_string(shard_.text()), json_string(command_), json_string(run_), bytes_, json_string(hex(hash_.value))));
}

Result<std::vector<Part>> find_parts(const std::string& path, const std::string& command) {
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  std::map<std::size_t, Part> found;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    const auto shard = shard_of_part(path, it->path().filename().string());
    if (!shard) continue;
    if (!found.empty() && found.begin()->second.shard.count != shard->count)
      return Error{fmt::format("{}: there are parts of {} shards and of {}; the parts of one run were expected", path,
                               std::min(found.begin()->second.shard.count, shard->count),
                               std::max(found.begin()->second.shard.count, shard->count))};
    found.emplace(shard->index, Part{part_path(path, *shard), *shard});
  }
  if (code) return system_error(folder.string() + ": cannot read the folder", code.value());
  if (found.empty())
    return Error{fmt::format("{}: there are no parts; {} was expected, from catena {} --shard 1/4 -o {}", path, part_path(path, {1, 4}),
                             command, command == "tradeoff" ? folder.string() : path)};

  std::vector<Shard> missing;
  const std::size_t count = found.begin()->second.shard.count;
  for (std::size_t index = 1; index <= count; ++index)
    if (!found.contains(index)) missing.push_back({index, count});
  if (!missing.empty()) return Error{path + ": " + missing_shards_message(missing) + "; one part of each shard was expected"};

  std::vector<Part> parts;
  std::string run, first_path;
  for (auto& [index, part] : found) {
    std::ifstream in(part.path, std::ios::binary);
    if (!in) return system_error(part.path + ": cannot read", errno);
    const std::uint64_t size = fs::file_size(part.path, code);
    const auto last = code ? std::nullopt : read_last_line(in, part.path, size);
    if (!last || last->shard != part.shard.text() || !has_hash(in, last->bytes, last->hash))
      return Error{
          fmt::format("{}: is truncated or was changed; the file that shard {} writes was expected", part.path, part.shard.text())};
    if (last->command != command)
      return Error{fmt::format("{}: is a part of catena {}; one of catena {} was expected", part.path, sanitize_for_terminal(last->command),
                               command)};
    if (run.empty()) run = last->run, first_path = part.path;
    if (last->run != run)
      return Error{fmt::format("{}: is of other inputs, other options or another version than {}; the parts of one run were expected",
                               part.path, first_path)};
    part.bytes = last->bytes;
    parts.push_back(std::move(part));
  }
  return parts;
}

Outcome PartLines::fill() {
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t before = buffer_.size(), count = static_cast<std::size_t>(std::min<std::uint64_t>(block_bytes_, part_.bytes - read_));
  buffer_.resize(before + count);
  std::ifstream in(part_.path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(read_));
  if (!in.read(buffer_.data() + before, static_cast<std::streamsize>(count))) return system_error(part_.path + ": cannot read", errno);
  read_ += count;
  return Done{};
}

Result<bool> PartLines::next(std::string_view& line) {
  for (;;) {
    const std::size_t end = buffer_.find('\n', at_);
    if (end != std::string::npos) {
      line = std::string_view(buffer_).substr(at_, end - at_);
      at_ = end + 1;
      return true;
    }
    if (read_ == part_.bytes) return false;
    CATENA_CHECK(fill());
  }
}

}  // namespace catena::app
