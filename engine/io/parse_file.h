// SPDX-License-Identifier: MIT
/// Private to this module: a parser of bytes as a reader of files.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/text.h"
#include "engine/io/formats.h"

namespace catena::io {

/// Reads a file with this kind of data, of at most MaxGigabytes GiB, and parses it. Files that are parsed have one time step. An Error
/// names the file.
template <auto Parse, DataKind Kind, int MaxGigabytes>
auto parse_file(const std::string& path, int /*step*/) -> decltype(Parse(std::string_view(), path)) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{MaxGigabytes} << 30;
  CATENA_TRY(const std::string bytes, read_text_file(path, describe_expected(Kind), kMaxBytes));
  return Parse(bytes, path);
}

}  // namespace catena::io
