// SPDX-License-Identifier: MIT
#include "haptics/plugin/plugin_file.h"

#include <elf.h>

#include <bit>
#include <cstring>
#include <optional>

namespace catena::haptics::plugin {
namespace {

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#elif defined(__riscv)
constexpr Elf64_Half kMachine = EM_RISCV;
#else
constexpr Elf64_Half kMachine = EM_NONE;  // the dynamic linker rejects other machines
#endif

static_assert(std::endian::native == std::endian::little && sizeof(void*) == 8, "64-bit little-endian ELF");

/// Returns the object of type T at an offset; nullopt if it does not lie within the bytes.
template <class T>
std::optional<T> at(std::string_view bytes, std::uint64_t offset) {
  if (offset > bytes.size() || bytes.size() - offset < sizeof(T)) return {};
  T out;
  std::memcpy(&out, bytes.data() + offset, sizeof out);
  return out;
}

/// Returns the bytes of a section that lie in the file.
std::string_view part(std::string_view bytes, const Elf64_Shdr& section) {
  if (section.sh_type == SHT_NOBITS || section.sh_offset > bytes.size() || section.sh_size > bytes.size() - section.sh_offset) return {};
  return bytes.substr(section.sh_offset, section.sh_size);
}

/// Returns whether the string at an offset of a string section starts with `words`.
bool says(std::string_view texts, std::uint64_t offset, std::string_view words) {
  return offset < texts.size() && texts.substr(offset).starts_with(words);
}

bool links_catena(std::string_view entries, std::string_view texts) {
  for (std::uint64_t k = 0;; k += sizeof(Elf64_Dyn)) {
    const auto entry = at<Elf64_Dyn>(entries, k);
    if (!entry || entry->d_tag == DT_NULL) return false;
    if (entry->d_tag == DT_NEEDED && says(texts, entry->d_un.d_val, "libcatena.so")) return true;
  }
}

bool ends(const char* text, std::size_t size) { return std::memchr(text, 0, size) != nullptr; }

}  // namespace

Result<PluginFile> read_file(std::string_view bytes) {
  const auto head = at<Elf64_Ehdr>(bytes, 0);
  if (!head || std::memcmp(head->e_ident, ELFMAG, SELFMAG) != 0 || head->e_type != ET_DYN || head->e_ident[EI_CLASS] != ELFCLASS64 ||
      head->e_ident[EI_DATA] != ELFDATA2LSB || (kMachine != EM_NONE && head->e_machine != kMachine))
    return Error{"is not a shared library for this machine; a plug-in was expected"};
  const auto section = [&](std::uint64_t i) -> std::optional<Elf64_Shdr> {
    if (i >= head->e_shnum || head->e_shoff > bytes.size() || head->e_shentsize != sizeof(Elf64_Shdr)) return {};
    return at<Elf64_Shdr>(bytes, head->e_shoff + i * sizeof(Elf64_Shdr));
  };
  const auto names = section(head->e_shstrndx);
  if (!names) return Error{"is truncated, or has no section table; a complete shared library was expected"};

  PluginFile file;
  std::optional<AbiStamp> found;
  bool has_entries = false;                                // a library has one dynamic section
  constexpr std::string_view kName(".catena.plugin", 15);  // including its terminating zero
  for (std::uint64_t i = 0; i < head->e_shnum; ++i) {
    const auto one = section(i);
    if (!one) return Error{"is truncated; a complete shared library was expected"};
    if (says(part(bytes, *names), one->sh_name, kName)) found = at<AbiStamp>(part(bytes, *one), 0);
    if (one->sh_type != SHT_DYNAMIC || has_entries) continue;
    has_entries = true;
    if (const auto texts = section(one->sh_link)) file.links_catena = links_catena(part(bytes, *one), part(bytes, *texts));
  }
  if (!found || std::memcmp(found->magic, AbiStamp().magic, sizeof found->magic) != 0 || !ends(found->headers, sizeof found->headers) ||
      !ends(found->compiler, sizeof found->compiler))
    return Error{"has no plug-in interface; a plug-in (CATENA_CONSTRAINT_PLUGIN, haptics/plugin/plugin.h) was expected"};
  file.abi_stamp = *found;
  return file;
}

}  // namespace catena::haptics::plugin
