// SPDX-License-Identifier: MIT
// The programs have the requested hardening: position independent, relocations read-only before main, no executable stack, stack
// canaries, checked functions of the C library, checked containers of the C++ library.
#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "tests/support/support.h"

namespace catena::hardening_test {

/// A 64-bit ELF program of this machine, as bytes.
class Program {
 public:
  explicit Program(const std::string& path) : bytes_(test::read_file(path)) {
    EXPECT_GT(bytes_.size(), sizeof header_) << path;
    EXPECT_EQ(std::memcmp(bytes_.data(), ELFMAG, SELFMAG), 0) << path;
    std::memcpy(&header_, bytes_.data(), sizeof header_);
    for (std::size_t i = 0; i < header_.e_phnum; ++i) segments_.push_back(at<Elf64_Phdr>(header_.e_phoff + i * header_.e_phentsize));
    for (const Elf64_Phdr& segment : segments_)
      if (segment.p_type == PT_DYNAMIC)
        for (std::size_t k = 0; k + sizeof(Elf64_Dyn) <= segment.p_filesz; k += sizeof(Elf64_Dyn))
          dynamic_.push_back(at<Elf64_Dyn>(segment.p_offset + k));
    read_imports();
  }

  const Elf64_Phdr* segment(std::uint32_t type) const {
    for (const Elf64_Phdr& segment : segments_)
      if (segment.p_type == type) return &segment;
    return nullptr;
  }
  bool has_writable_code() const {
    for (const Elf64_Phdr& segment : segments_)
      if (segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0 && (segment.p_flags & PF_X) != 0) return true;
    return false;
  }
  std::uint64_t dynamic(std::int64_t tag) const {
    for (const Elf64_Dyn& entry : dynamic_)
      if (entry.d_tag == tag) return entry.d_un.d_val;
    return 0;
  }
  const Elf64_Ehdr& header() const { return header_; }
  const std::set<std::string>& imports() const { return imports_; }

 private:
  template <class T>
  T at(std::size_t offset) const {
    T out{};
    if (offset + sizeof out <= bytes_.size()) std::memcpy(&out, bytes_.data() + offset, sizeof out);
    return out;
  }
  void read_imports() {
    for (std::size_t i = 0; i < header_.e_shnum; ++i) {
      const auto section = at<Elf64_Shdr>(header_.e_shoff + i * header_.e_shentsize);
      if (section.sh_type != SHT_DYNSYM) continue;
      const auto names = at<Elf64_Shdr>(header_.e_shoff + section.sh_link * header_.e_shentsize);
      for (std::size_t k = 0; k + sizeof(Elf64_Sym) <= section.sh_size; k += sizeof(Elf64_Sym)) {
        const auto symbol = at<Elf64_Sym>(section.sh_offset + k);
        if (symbol.st_shndx == SHN_UNDEF && names.sh_offset + symbol.st_name < bytes_.size())
          imports_.insert(bytes_.c_str() + names.sh_offset + symbol.st_name);
      }
    }
  }

  std::string bytes_;
  Elf64_Ehdr header_{};
  std::vector<Elf64_Phdr> segments_;
  std::vector<Elf64_Dyn> dynamic_;
  std::set<std::string> imports_;
};

TEST(Hardening, TheProgramsAreHardened) {
#ifdef CATENA_NOT_HARDENED
  GTEST_SKIP() << "the sanitizers have checks of their own";
#endif
  for (const std::string& path : {test::program_path(), test::binary_dir() + "/catena-watchdog"}) {
    SCOPED_TRACE(path);
    const Program program(path);
    EXPECT_EQ(program.header().e_type, ET_DYN) << "a position-independent program";
    EXPECT_NE(program.dynamic(DT_FLAGS_1) & DF_1_PIE, 0u);
    EXPECT_NE(program.segment(PT_GNU_RELRO), nullptr);
    EXPECT_NE(program.dynamic(DT_FLAGS_1) & DF_1_NOW, 0u) << "all of the relocations before main, then read-only";
    ASSERT_NE(program.segment(PT_GNU_STACK), nullptr);
    EXPECT_EQ(program.segment(PT_GNU_STACK)->p_flags & PF_X, 0u);
    EXPECT_FALSE(program.has_writable_code());
    EXPECT_TRUE(program.imports().contains("__stack_chk_fail"));
  }
  const Program program(test::program_path());
  EXPECT_TRUE(program.imports().contains("__snprintf_chk") || program.imports().contains("__memcpy_chk") ||
              program.imports().contains("__read_chk"))
      << "_FORTIFY_SOURCE";
  bool checked = false;
  for (const std::string& name : program.imports()) checked = checked || name.find("__glibcxx_assert_fail") != std::string::npos;
  EXPECT_TRUE(checked) << "_GLIBCXX_ASSERTIONS";
}

}  // namespace catena::hardening_test
