// SPDX-License-Identifier: BSL-1.0
#include "elf_file.hpp"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace nysalt::program {

namespace {

/// Namespaces of libraries that are the same wherever they are compiled, as they stand in mangled names.
constexpr std::array<std::string_view, 5> libraries{"NSt", "NKSt", "5Eigen", "5boost", "3fmt"};

/// A file whose places are read as what they hold.
class elf_file {
 public:
  explicit elf_file(const std::filesystem::path& file) : input_(file, std::ios::binary) {
    is_elf_ = read(0, header_) && std::memcmp(header_.e_ident, ELFMAG, SELFMAG) == 0;
  }

  bool is_elf() const { return is_elf_; }
  const ElfW(Ehdr) & header() const { return header_; }
  bool read(std::uint64_t at, auto& to) { return read(at, &to, sizeof to); }
  bool read(std::uint64_t at, void* to, std::size_t bytes) {
    input_.clear();
    input_.seekg(static_cast<std::streamoff>(at));
    return static_cast<bool>(input_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)));
  }
  /// A section, as its elements; empty where it cannot be read.
  template <class T>
  std::vector<T> elements(const ElfW(Shdr) & section) {
    constexpr std::uint64_t most = 1U << 30U;  // bytes: sections of names are far shorter
    if (section.sh_size > most) return {};
    std::vector<T> all(section.sh_size / sizeof(T));
    if (!read(section.sh_offset, all.data(), all.size() * sizeof(T))) return {};
    return all;
  }

 private:
  std::ifstream input_;
  ElfW(Ehdr) header_{};
  bool is_elf_ = false;
};

}  // namespace

bool is_whole(const std::filesystem::path& file) {
  std::error_code failure;
  const std::uintmax_t length = std::filesystem::file_size(file, failure);
  elf_file elf(file);
  if (failure || !elf.is_elf() || elf.header().e_phentsize != sizeof(ElfW(Phdr))) return true;
  for (int k = 0; k < elf.header().e_phnum; ++k) {
    ElfW(Phdr) segment{};
    if (!elf.read(elf.header().e_phoff + static_cast<std::uint64_t>(k) * sizeof segment, segment))
      return false;
    if (segment.p_filesz > length || segment.p_offset > length - segment.p_filesz) return false;
  }
  return true;
}

std::set<std::string> unique_symbols_of(const std::filesystem::path& file) {
  elf_file elf(file);
  if (!elf.is_elf() || elf.header().e_shentsize != sizeof(ElfW(Shdr))) return {};
  const auto section = [&](std::uint64_t k) {
    ElfW(Shdr) found{};
    elf.read(elf.header().e_shoff + k * sizeof found, found);
    return found;
  };
  std::set<std::string> names;
  for (int k = 0; k < elf.header().e_shnum; ++k) {
    const ElfW(Shdr) symbols = section(static_cast<std::uint64_t>(k));
    if (symbols.sh_type != SHT_DYNSYM) continue;
    std::vector<char> texts = elf.elements<char>(section(symbols.sh_link));
    texts.push_back('\0');
    for (const auto& symbol : elf.elements<ElfW(Sym)>(symbols)) {
      if (ELF64_ST_BIND(symbol.st_info) != STB_GNU_UNIQUE || symbol.st_shndx == SHN_UNDEF) continue;
      if (symbol.st_name >= texts.size()) continue;
      const std::string_view name = &texts[symbol.st_name];
      const auto begins_with = [&](std::string_view space) {
        return name.find(space) < 8;
      };  // behind _ZNK and its like
      if (std::ranges::none_of(libraries, begins_with)) names.emplace(name);
    }
  }
  return names;
}

}  // namespace nysalt::program
