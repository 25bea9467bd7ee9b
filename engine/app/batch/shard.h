// SPDX-License-Identifier: MIT
/// The option --shard I/N: the share of one process among N that divide the work of a command, such as the tasks of a job array.
///   items   independent pieces of work, counted from 0: images of a sequence, seeds, measurements, subjects
///   shard   I of N has the items I - 1, I - 1 + N, I - 1 + 2 N, ...; together the N shards have each item once
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace CLI {
class App;
}

namespace catena::app {

/// Largest number of shards.
inline constexpr std::size_t kMaxShards = 100'000;

/// Share of one process. Plain data.
struct Shard {
  std::size_t index = 1, count = 1;  ///< 1 <= index <= count

  /// First item of the shard, whether or not there are that many.
  std::size_t first_item() const { return index - 1; }
  /// Whether an item belongs to the shard.
  bool has(std::size_t item) const { return item % count == first_item(); }
  /// The shard's items of `total` in ascending order; empty if there are fewer items than shards before this one.
  std::vector<std::size_t> items(std::size_t total) const;
  /// "2/4", as on the command line.
  std::string text() const;
  bool operator==(const Shard&) const = default;
};

/// Parses "I/N". Error: not two whole numbers with 1 <= I <= N <= kMaxShards.
Result<Shard> parse_shard(const std::string& text);
/// As above; nullopt if the option was not given.
Result<std::optional<Shard>> parse_shard(const std::optional<std::string>& given);
/// Adds the option. `unit`: what is divided, for the help: "images".
void add_shard_option(CLI::App& command, std::optional<std::string>& given, const std::string& unit);

/// Name of a shard's own output instead of `path`, which is the output of the whole: "out/lines.shard-2-of-4.csv" for "out/lines.csv".
std::string part_path(const std::string& path, const Shard& shard);
/// Returns the shard that part_path() has put into the name of a file in the folder of `path`; nullopt if `name` is no part of `path`.
std::optional<Shard> shard_of_part(const std::string& path, const std::string& name);

/// The sentence for a shard without items: "shard 5/8 has none of the 3 images: nothing to do".
std::string empty_shard_message(const Shard& shard, std::size_t total, const std::string& unit);

}  // namespace catena::app
