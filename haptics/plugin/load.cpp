// SPDX-License-Identifier: MIT
#include "haptics/plugin/load.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cfenv>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>

#include "engine/base/hash.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "haptics/constraints/presets/mode_presets.h"
#include "haptics/plugin/plugin_file.h"

namespace catena::haptics::plugin {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20;
constexpr unsigned kTrialSeconds = 10;
constexpr int kThrew = 100;  // exit code of a trial that threw

std::vector<LoadedPlugin>& list_of_loaded() {
  static std::vector<LoadedPlugin> list;
  return list;
}

/// Returns who besides this user and root may change the file at a path; empty if nobody. A group counts as others unless it is the owner's
/// private group, which has the owner's number; in a folder with the sticky bit nobody can remove the files of others.
std::string changed_by_others(const fs::path& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return "cannot be examined";
  if (about.st_uid != 0 && about.st_uid != ::geteuid()) return "belongs to another user";
  const bool group = (about.st_mode & S_IWGRP) != 0 && about.st_gid != about.st_uid;
  if (S_ISDIR(about.st_mode) && (about.st_mode & S_ISVTX) != 0) return {};
  return group || (about.st_mode & S_IWOTH) != 0 ? "can be written by others" : "";
}

Outcome check_statement(const AbiStamp& stated) {
  static constexpr AbiStamp kOwn = make_abi_stamp(CATENA_PLUGIN_INTERFACE);
  const auto other = [](const char* what, const char* theirs, const char* own) {
    return Error{std::string("was built ") + what + " " + sanitize_for_terminal(theirs) + ", but this program " + what + " " + own +
                 "; a plug-in that was built like this program was expected"};
  };
  if (std::strcmp(stated.headers, kOwn.headers) != 0) return other("for Catena", stated.headers, kOwn.headers);
  if (std::strcmp(stated.compiler, kOwn.compiler) != 0) return other("by", stated.compiler, kOwn.compiler);
  return Done{};
}

bool is_word(const std::string& text) {
  return text.size() <= 60 && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos && !text.empty() &&
         text[0] >= 'a';
}

/// Checks a new type against the known ones, including the plug-in's own types before it.
Outcome check_type(const ConstraintType& type, const std::vector<std::string>& before) {
  if (!is_word(type.type))
    return Error{"defines a type named " + in_quotes(type.type) +
                 "; a name of lower-case letters, digits and _ that starts with a letter was expected"};
  const std::string named = "defines the type " + in_quotes(type.type);
  const ConstraintType* const known = find_constraint_type(type.type);
  if (known != nullptr && !known->plugin.empty())
    return Error{named + ", which the plug-in " + sanitize_for_terminal(known->plugin) + " already defines; another name was expected"};
  if (known != nullptr || find_mode_preset(type.type) != nullptr)
    return Error{named + ", which exists in Catena; another name was expected"};
  if (std::find(before.begin(), before.end(), type.type) != before.end()) return Error{named + " twice; another name was expected"};
  if (type.build == nullptr) return Error{named + " without a build function; ConstraintType::build was expected"};
  std::vector<std::string_view> keys = schema::key_names(common_keys());
  for (const schema::Key& key : type.keys) {
    if (!is_word(key.name) || std::find(keys.begin(), keys.end(), key.name) != keys.end())
      return Error{named + " with the key " + in_quotes(key.name) +
                   "; a valid name that differs from all other keys of the link was expected"};
    keys.push_back(key.name);
  }
  return Done{};
}

/// Returns all types of the plug-in, or an Error.
Result<std::vector<ConstraintType>> types_of(const PluginEntry& entry) {
  std::vector<ConstraintType> types;
  try {
    entry.add_types(types);
  } catch (const std::exception& error) {
    return Error{"its function for types threw an exception (" + sanitize_for_terminal(error.what()) + "); a list of types was expected"};
  } catch (...) {
    return Error{"its function for types threw an exception; a list of types was expected"};
  }
  if (types.empty()) return Error{"defines no type; at least one was expected"};
  std::vector<std::string> before;
  for (const ConstraintType& type : types) {
    CATENA_CHECK(check_type(type, before));
    before.push_back(type.type);
  }
  return types;
}

/// Runs the library's static initializers in a child process first: they may throw, crash or hang.
Outcome try_library(const std::string& path) {
  const pid_t child = ::fork();
  if (child < 0) return system_error("a process to test the plug-in", errno);
  if (child == 0) {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    ::alarm(kTrialSeconds);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);  // /dev/null for the dynamic linker's own messages
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
    void* (*volatile const open)(const char*, int) =
        ::dlopen;  // dlopen is declared as not throwing; the call through a volatile pointer lets exceptions propagate
    try {
      open(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    } catch (...) {
      ::_exit(kThrew);
    }
    ::_exit(0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
  const std::string how = !WIFSIGNALED(status)          ? WEXITSTATUS(status) == kThrew ? "throws an exception" : "ends the program"
                          : WTERMSIG(status) == SIGALRM ? fmt::format("does not return within {} s", kTrialSeconds)
                                                        : fmt::format("crashes (signal {})", WTERMSIG(status));
  return Error{how + " when loaded; a library that can be loaded was expected"};
}

/// Loads the library, which runs its static initializers.
Result<const PluginEntry*> open_library(const std::string& path, const AbiStamp& stated) {
  std::fenv_t rounding;  // a library linked with -ffast-math sets flush-to-zero for the whole thread; the environment is restored
  std::fegetenv(&rounding);
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  std::fesetenv(&rounding);
  if (library == nullptr) {
    std::string why = ::dlerror();
    if (why.starts_with(path + ": ")) why.erase(0, path.size() + 2);
    return Error{"cannot be loaded (" + sanitize_for_terminal(why) +
                 "); a library that uses only the headers of the target catena::plugin was expected"};
  }
  const auto* const entry = static_cast<const PluginEntry*>(::dlsym(library, "catena_plugin"));
  if (entry == nullptr || entry->add_types == nullptr || std::memcmp(&entry->abi_stamp, &stated, sizeof stated) != 0)
    return Error{"has an entry that differs from the file; the entry of CATENA_CONSTRAINT_PLUGIN was expected"};
  return entry;
}

Outcome load_checked(const fs::path& path) {
  CATENA_TRY(const std::string bytes, read_text_file(path.string(), "a plug-in", kMaxBytes));
  const auto failed = [&](const std::string& why) { return Error{one_line(path.string() + ": " + why)}; };
  const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size());
  for (const LoadedPlugin& other : loaded_plugins())
    if (other.hash == hash) return Done{};
  for (const fs::path& place : {path, path.parent_path()})
    if (const std::string why = changed_by_others(place); !why.empty())
      return Error{one_line(place.string() + ": " + why + "; a file and a folder that only you and root can change were expected")};
  const auto file = read_file(bytes);
  if (!file) return failed(file.error().message);
  if (const Outcome same = check_statement(file->abi_stamp); !same) return failed(same.error().message);
  if (file->links_catena) return failed("links libcatena.so, which loads Catena twice; the target catena::plugin was expected instead");
  if (const Outcome tried = try_library(path.string()); !tried) return with_cause(failed(tried.error().message), tried.error());
  const auto entry = open_library(path.string(), file->abi_stamp);
  if (!entry) return failed(entry.error().message);
  auto types = types_of(**entry);
  if (!types) return failed(types.error().message);
  LoadedPlugin plugin{path.filename().string(), hash, {}};
  for (ConstraintType& type : *types) {
    plugin.types.push_back(type.type);
    type.help = one_line(type.help);
    type.paper = one_line(type.paper);
    type.plugin = plugin.file;
    register_constraint(std::move(type));
  }
  list_of_loaded().push_back(std::move(plugin));
  return Done{};
}

}  // namespace

const std::vector<LoadedPlugin>& loaded_plugins() { return list_of_loaded(); }

std::string refusal_reason() {
  uid_t real = 0, effective = 0, saved = 0;
  if (::getresuid(&real, &effective, &saved) != 0 || real == 0 || effective == 0 || saved == 0)
    return "plug-ins are not loaded as root; a normal user was expected";
  if (::getauxval(AT_SECURE) != 0 || real != effective || real != saved)
    return "plug-ins are not loaded by a program with more rights than its user; a program without such rights was expected";
  return {};
}

Outcome load(const std::string& path) {
  if (const std::string why = refusal_reason(); !why.empty()) return Error{one_line(path + ": " + why)};
  std::error_code code;
  const fs::path whole = fs::canonical(path, code);  // an absolute name, so that no library search path applies
  return load_checked(code ? fs::path(path) : whole);
}

}  // namespace catena::haptics::plugin
