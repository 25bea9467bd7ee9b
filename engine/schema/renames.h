// SPDX-License-Identifier: MIT
/// Keys, values and command line options that version 0.3.0 renamed: the one table behind the message for an old name and behind
/// `catena upgrade`. The table will be removed in 0.5.0. Any thread.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/json.h"

namespace catena::schema {

/// Kind of a file by its keys. A study contains scenes (`scene` of a task) and chains (`chain` of a condition).
enum class FileKind { scene, study };

/// Returns the Error "FILE:LINE: "OLD" is now "NEW"; the new name was expected: `catena upgrade FILE` replaces the old names" for the first
/// old name; Done if there is none.
Outcome check_names(const json::Node& root, FileKind kind);

/// The text of a file with new names, and the number of names that were changed.
struct UpgradedText {
  std::string text;
  int changes = 0;
};
/// Replaces the old names and keeps comments, order and layout. Error: the text is not JSON, or an object with both an old key and its new
/// name.
Result<UpgradedText> upgrade_names(std::string_view text, const std::string& file, FileKind kind);

/// Returns the new name of a command line option ("--full-screen"); empty: the option was not renamed.
std::string_view renamed_option(std::string_view option);

}  // namespace catena::schema
