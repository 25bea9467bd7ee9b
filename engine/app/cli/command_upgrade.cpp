// SPDX-License-Identifier: MIT
/// catena upgrade FILE...: rewrites scenes, studies and recordings of version 0.2 with the names of 0.3 (engine/schema/renames.h). The old
/// file stays beside the new one as FILE.bak.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/schema/renames.h"
#include "haptics/servo/log/rewrite.h"

namespace catena::app {
namespace {

namespace fs = std::filesystem;

struct UpgradeOptions {
  std::vector<std::string> files;
  bool without_backup = false;
};

/// Keeps the old content of a file as FILE.bak. Error: FILE.bak exists already, or cannot be written.
Outcome keep_backup(const std::string& file) {
  const std::string backup = file + ".bak";
  std::error_code code;
  if (fs::exists(fs::symlink_status(backup, code)))
    return Error{one_line(backup + ": exists already; this name is needed for the old content of " + file)};
  fs::copy_file(file, backup, code);
  return code ? Outcome(system_error(backup + ": cannot write", code.value())) : Outcome(Done{});
}

/// Replaces the file by the new text, atomically.
Outcome replace_text(const std::string& file, const std::string& text, bool backup) {
  if (backup) CATENA_CHECK(keep_backup(file));
  CATENA_TRY(OutputFile out, OutputFile::open(file));
  out.write(text);
  out.sync();
  return out.commit();
}

/// Replaces the old names in a scene or a study. Returns their number.
Result<int> upgrade_text(const std::string& file, bool backup) {
  CATENA_TRY(const std::string text, read_text_file(file, "a scene or a study (.json), or a recording (.catlog)", kMaxJsonBytes));
  CATENA_TRY(const json::Node root, json::parse(text, file));
  CATENA_CHECK(json::expect_object(root, "the file"));
  const bool is_study = root.find("tasks") != nullptr && root.find("conditions") != nullptr;
  CATENA_TRY(const schema::UpgradedText upgraded,
             schema::upgrade_names(text, file, is_study ? schema::FileKind::study : schema::FileKind::scene));
  if (upgraded.changes > 0) CATENA_CHECK(replace_text(file, upgraded.text, backup));
  return upgraded.changes;
}

/// Replaces the old names in the scene texts of a recording. Returns their number.
Result<int> upgrade_recording(const std::string& file, bool backup) {
  int changes = 0;
  const auto rewrite = [&](std::string_view text) -> Result<std::string> {
    if (text.empty()) return std::string();  // recorded without a scene file
    CATENA_TRY(schema::UpgradedText upgraded, schema::upgrade_names(text, file, schema::FileKind::scene));
    changes += upgraded.changes;
    return std::move(upgraded.text);
  };
  const std::string written = temporary_name(file);
  CATENA_CHECK(haptics::log::rewrite_scene_texts(file, written, rewrite));
  std::error_code code;
  const Outcome kept = changes > 0 && backup ? keep_backup(file) : Outcome(Done{});
  if (changes == 0 || !kept) {
    fs::remove(written, code);
    CATENA_CHECK(kept);
    return 0;
  }
  fs::permissions(written, fs::status(file, code).permissions(), code);
  fs::rename(written, file, code);
  if (code) return system_error(file + ": cannot write", code.value());
  return changes;
}

Outcome upgrade_files(const UpgradeOptions& options) {
  for (const std::string& file : options.files) {
    const bool backup = !options.without_backup;
    CATENA_TRY(const int changes, is_log_file(file) ? upgrade_recording(file, backup) : upgrade_text(file, backup));
    if (changes == 0)
      fmt::print("{}: has no old names\n", sanitize_for_terminal(file));
    else
      fmt::print("{}: {} old name{} replaced\n", sanitize_for_terminal(file), changes, changes == 1 ? "" : "s");
  }
  return Done{};
}

}  // namespace

void add_upgrade(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<UpgradeOptions>();
  CLI::App* command = program.add_subcommand("upgrade", "replaces the key names of version 0.2 in scenes, studies and recordings");
  command->add_option("FILE", options->files, "scenes and studies (.json), recordings (.catlog)")->type_name("OLD")->required();
  command->add_flag("--no-backup", options->without_backup, "does not keep the old file as FILE.bak");
  command->callback([&chosen, options] { chosen = [options] { return upgrade_files(*options); }; });
}

}  // namespace catena::app
