// SPDX-License-Identifier: MIT
/// Identity of a run: the command, its options and the content of its inputs, but not where these files are nor which shard is run. Parts
/// are put together only if their keys are equal.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/hash.h"

namespace catena::app {

/// Hash of everything that determines the output of a run. One thread.
class RunKey {
 public:
  /// `command`: "trace". The version of the program is added.
  explicit RunKey(std::string_view command);
  RunKey& add(std::string_view words);
  RunKey& add(double number);
  /// Adds input files by content: up to 4 MiB completely, larger ones by their size and 64 blocks of 4 KiB that are spread over the file;
  /// folders by the names and sizes of their files. A file that cannot be read adds nothing: the command reports it.
  RunKey& add_files(const std::vector<std::string>& paths);
  /// The key, 16 hexadecimal digits.
  std::string text() const;

 private:
  void add_file(const std::string& path);
  Fnv1a hash_;
};

}  // namespace catena::app
