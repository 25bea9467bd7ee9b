// SPDX-License-Identifier: MIT
/// Plug-in interface: constraint types in a shared library, which the program `catena` loads by `--plugin ring.so`, CATENA_PLUGINS or from
/// the user's folder (docs/user/library.md). Scenes, the window, recordings and the schema then support the types like built-in ones.
///
///   ConstraintType ring();                    // haptics/constraints/registry.h
///   CATENA_CONSTRAINT_PLUGIN(ring)            // once per plug-in, outside all namespaces; several functions: ring, knot
///
/// Build it as a MODULE library that links the target catena::plugin. That target provides the headers and no library: the functions that a
/// plug-in calls are in the program that loads it, and a plug-in that links libcatena.so is rejected. The functions run once, at start-up,
/// in the main thread; the types that they return are checked (haptics/plugin/load.h).
///
/// The macro defines the entry `catena_plugin`. Its ABI stamp names the headers and the compiler with which the plug-in was built; the
/// program reads it from the file before any code of the plug-in runs, and loads only plug-ins with its own ABI stamp.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "haptics/constraints/registry.h"

namespace catena::haptics::plugin {

/// ABI stamp: properties that must be the same in a plug-in and in the program, as zero-terminated texts. Plain bytes, so that no loader
/// relocates any of them.
struct AbiStamp {
  char magic[16] = "Catena plug-in";  ///< identifies the stamp
  char headers[64] = {};              ///< version of Catena and a hash of all public headers
  char compiler[192] = {};            ///< compiler, standard library and sizes of the shared types, as the build options determine them
};

/// Appends text to a text of an AbiStamp. A text that does not fit fails to compile.
template <std::size_t N>
constexpr void append(char (&text)[N], std::string_view words) {
  std::size_t end = std::string_view(text).size();
  for (const char c : words) text[end++] = c;
  text[end] = '\0';
}

/// Appends a space and a number.
template <std::size_t N>
constexpr void append(char (&text)[N], unsigned long number) {
  char digits[24] = {};
  std::size_t first = sizeof digits - 1;
  for (; first == sizeof digits - 1 || number > 0; number /= 10) digits[--first] = static_cast<char>('0' + number % 10);
  append(text, " ");
  append(text, std::string_view(digits + first));
}

/// Returns the ABI stamp of the present compilation. `headers`: CATENA_PLUGIN_INTERFACE, which Catena's build defines.
consteval AbiStamp make_abi_stamp(std::string_view headers) {
  AbiStamp out;
  append(out.headers, headers);
#ifdef __clang__
  append(out.compiler, "Clang");
  append(out.compiler, __clang_major__);
#else
  append(out.compiler, "GCC");
  append(out.compiler, __GNUC__);
#endif
#ifdef _GLIBCXX_RELEASE
  append(out.compiler, ", libstdc++");
  append(out.compiler, _GLIBCXX_RELEASE);
  append(out.compiler, _GLIBCXX_USE_CXX11_ABI ? "" : " with old strings");
#else
  append(out.compiler, ", another library");
#endif
#ifdef _GLIBCXX_DEBUG
  append(out.compiler, ", debug containers");
#endif
#ifdef __SANITIZE_ADDRESS__
  append(out.compiler, ", address sanitizer");
#endif
#ifdef __SANITIZE_THREAD__
  append(out.compiler, ", thread sanitizer");
#endif
  append(out.compiler, ", C++");
  append(out.compiler, __cplusplus / 100 % 100);
  append(out.compiler, ", sizes");
  for (const std::size_t size : {sizeof(LinkState), sizeof(LinkScratch), sizeof(Constraint), sizeof(ConstraintType), sizeof(BuildContext),
                                 sizeof(schema::Key), sizeof(json::Node), sizeof(flow::Flow)})
    append(out.compiler, size);
  return out;
}

/// Entry of a plug-in: its ABI stamp and the function that adds its types.
struct PluginEntry {
  AbiStamp abi_stamp;                                     ///< read from the file before any code runs
  void (*add_types)(std::vector<ConstraintType>& types);  ///< appends the plug-in's types; may throw
};

}  // namespace catena::haptics::plugin

extern "C" {
/// Entry of a plug-in, defined by CATENA_CONSTRAINT_PLUGIN, in a section of its own where the program finds it.
[[gnu::visibility("default"), gnu::section(".catena.plugin")]] extern const catena::haptics::plugin::PluginEntry catena_plugin;
}

/// Defines the entry of a plug-in from one or several functions that return a ConstraintType.
#define CATENA_CONSTRAINT_PLUGIN(...)                                                                                                      \
  static void catena_plugin_add(std::vector<::catena::haptics::ConstraintType>& types) {                                                   \
    for (::catena::haptics::ConstraintType(*const make)() : {__VA_ARGS__}) types.push_back(make());                                        \
  }                                                                                                                                        \
  constinit const ::catena::haptics::plugin::PluginEntry catena_plugin{::catena::haptics::plugin::make_abi_stamp(CATENA_PLUGIN_INTERFACE), \
                                                                       &catena_plugin_add};
