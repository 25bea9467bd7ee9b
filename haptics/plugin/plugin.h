/// A constraint of one's own in a shared library, a plug-in, which the program `catena` loads by `--plugin ring.so`, CATENA_PLUGINS or the
/// user's folder (docs/library.md). Scenes, the window, recordings and the schema then know it like any other.
///
///   ConstraintType ring();                    // haptics/constraints/registry.h
///   CATENA_CONSTRAINT_PLUGIN(ring)            // once in a plug-in, outside of every namespace; several functions: ring, knot
///
/// Build it as a MODULE library that links the target catena::plugin. That target has the headers and no library: what a plug-in calls is
/// in the program that loads it, and a plug-in that links libcatena.so is refused. The functions run once, at start-up, in the first
/// thread; what they give is checked (haptics/plugin/load.h).
///
/// The macro makes the one entry, `catena_plugin`. It states the headers and the compiler that the plug-in was built with; the program
/// reads that from the file, before any code of the plug-in runs, and loads only what states the same as itself.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "haptics/constraints/registry.h"

namespace catena::haptics::plugin {

/// What must be the same in a plug-in and in the program, as text that ends with zeros: plain bytes, of which no loader changes any.
struct AbiStamp {
  char magic[16] = "Catena plug-in";  ///< tells it from other data
  char headers[64] = {};              ///< Catena's version, and a hash of all public headers
  char compiler[192] = {};            ///< the compiler, its library and the sizes of what crosses, as the options of the build leave them
};

/// Appends words to a text of a AbiStamp. One that does not fit does not compile.
template <std::size_t N>
constexpr void append(char (&text)[N], std::string_view words) {
  std::size_t end = std::string_view(text).size();
  for (const char c : words) text[end++] = c;
  text[end] = '\0';
}

/// The same of a blank and a number.
template <std::size_t N>
constexpr void append(char (&text)[N], unsigned long number) {
  char digits[24] = {};
  std::size_t first = sizeof digits - 1;
  for (; first == sizeof digits - 1 || number > 0; number /= 10) digits[--first] = static_cast<char>('0' + number % 10);
  append(text, " ");
  append(text, std::string_view(digits + first));
}

/// The statement of what is being compiled. `headers`: CATENA_PLUGIN_INTERFACE, which the build of Catena defines.
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

/// The entry: the statement, and where the types come from.
struct PluginEntry {
  AbiStamp abi_stamp;                                     ///< read from the file first
  void (*add_types)(std::vector<ConstraintType>& types);  ///< appends the plug-in's types; may throw
};

}  // namespace catena::haptics::plugin

extern "C" {
/// The entry of a plug-in, defined by CATENA_CONSTRAINT_PLUGIN, in a section of its own, where the program finds it.
[[gnu::visibility("default"), gnu::section(".catena.plugin")]] extern const catena::haptics::plugin::PluginEntry catena_plugin;
}

/// Makes a shared library a plug-in, of one or several functions that return a ConstraintType.
#define CATENA_CONSTRAINT_PLUGIN(...)                                                                                                      \
  static void catena_plugin_add(std::vector<::catena::haptics::ConstraintType>& types) {                                                   \
    for (::catena::haptics::ConstraintType(*const make)() : {__VA_ARGS__}) types.push_back(make());                                        \
  }                                                                                                                                        \
  constinit const ::catena::haptics::plugin::PluginEntry catena_plugin{::catena::haptics::plugin::make_abi_stamp(CATENA_PLUGIN_INTERFACE), \
                                                                       &catena_plugin_add};
