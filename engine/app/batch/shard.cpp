// SPDX-License-Identifier: MIT
#include "engine/app/batch/shard.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "engine/app/cli/options.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

/// Parses digits without a sign or leading zeros, 1 to kMaxShards.
std::optional<std::size_t> parse_shard_number(std::string_view digits) {
  const bool only_digits = std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  if (digits.empty() || !only_digits || digits.front() == '0') return std::nullopt;
  const auto number = parse_integer(digits);
  if (!number || *number < 1 || *number > static_cast<long long>(kMaxShards)) return std::nullopt;
  return static_cast<std::size_t>(*number);
}

std::optional<Shard> parse_shard_pair(std::string_view text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  const auto index = parse_shard_number(text.substr(0, at)), count = parse_shard_number(text.substr(at + separator.size()));
  if (!index || !count || *index > *count) return std::nullopt;
  return Shard{*index, *count};
}

}  // namespace

std::vector<std::size_t> Shard::items(std::size_t total) const {
  std::vector<std::size_t> all;
  for (std::size_t item = first_item(); item < total; item += count) all.push_back(item);
  return all;
}

std::string Shard::text() const { return fmt::format("{}/{}", index, count); }

Result<Shard> parse_shard(const std::string& text) {
  if (const auto shard = parse_shard_pair(text, "/")) return *shard;
  return Error{"--shard " + in_quotes(text) + ": I/N was expected, such as 1/4, 2/4, 3/4 or 4/4"};
}

Result<std::optional<Shard>> parse_shard(const std::optional<std::string>& given) {
  if (!given) return std::optional<Shard>();
  CATENA_TRY(const Shard shard, parse_shard(*given));
  return std::optional(shard);
}

void add_shard_option(CLI::App& command, std::optional<std::string>& given, const std::string& unit) {
  command
      .add_option("--shard", given, "the I-th of N shares of the " + unit + ", every N-th one, for the tasks of a cluster (default: all)")
      ->type_name("I/N")
      ->check(accepted("1 <= I <= N"));
}

std::string part_path(const std::string& path, const Shard& shard) {
  const std::filesystem::path whole(path);
  return (whole.parent_path() /
          fmt::format("{}.shard-{}-of-{}{}", whole.stem().string(), shard.index, shard.count, whole.extension().string()))
      .string();
}

std::optional<Shard> shard_of_part(const std::string& path, const std::string& name) {
  const std::filesystem::path whole(path);
  const std::string before = whole.stem().string() + ".shard-", after = whole.extension().string();
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) return std::nullopt;
  return parse_shard_pair(std::string_view(name).substr(before.size(), name.size() - before.size() - after.size()), "-of-");
}

std::string empty_shard_message(const Shard& shard, std::size_t total, const std::string& unit) {
  return fmt::format("shard {} has none of the {} {}: nothing to do", shard.text(), total, unit);
}

}  // namespace catena::app
