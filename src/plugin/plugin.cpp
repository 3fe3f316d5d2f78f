// SPDX-License-Identifier: BSL-1.0
#include "plugin.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include "build.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "force_library.hpp"
#include "named_signals.hpp"
#include "names.hpp"
#include "nysalt/plugin.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

struct loaded {
  std::string path;  // as it was named
  system_declaration declared;
};

std::vector<std::unique_ptr<loaded>>& all_loaded() {
  static std::vector<std::unique_ptr<loaded>> all;
  return all;
}

/// A function of the library by its name. Throws refusal if there is none.
template <class F>
F* function_in(void* library, const char* name, const std::string& path) {
  auto* const found = reinterpret_cast<F*>(dlsym(library, name));
  if (found == nullptr)
    refuse(
        "{}: the library must declare a system; write NYSALT_SYSTEM(...), or the functions of "
        "nysalt/c_force.h",
        path);
  return found;
}

/// The message of dlerror(), without the path, which the message has already.
std::string why_not_loaded(const fs::path& file) {
  const char* problem = dlerror();
  std::string text = problem == nullptr ? "unknown" : problem;
  const std::string prefix = file.string() + ": ";
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
}

/// What the loader of the system cannot take for a library.
class unloadable : public refusal {
 public:
  using refusal::refusal;
};

/// Whether all of the file that the loader would map is there; of one that was cut off the first use of what
/// is missing would end the process. What is no library of this machine the loader refuses itself.
bool is_whole(const fs::path& file) {
  std::error_code failure;
  const std::uintmax_t length = fs::file_size(file, failure);
  std::ifstream input(file, std::ios::binary);
  const auto read_into = [&](auto& to) {
    return static_cast<bool>(input.read(reinterpret_cast<char*>(&to), sizeof to));
  };
  ElfW(Ehdr) header{};
  if (failure || !read_into(header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return true;
  if (header.e_phentsize != sizeof(ElfW(Phdr))) return true;
  input.seekg(static_cast<std::streamoff>(header.e_phoff));
  for (int k = 0; k < header.e_phnum; ++k) {
    ElfW(Phdr) segment{};
    if (!read_into(segment)) return false;
    if (segment.p_filesz > length || segment.p_offset > length - segment.p_filesz) return false;
  }
  return true;
}

void require_sound(const system_declaration& declared, const std::string& path) {
  std::vector<std::string> names;
  for (const auto& parameter : declared.parameters) {
    const std::string& name = parameter.name;
    if (!is_plain_name(name)) {
      refuse("{}: the name of a parameter must be lower-case letters, digits and _, a letter first, got '{}'",
             path, name);
    }
    if (is_reserved_name(name))
      refuse("{}: the name of a parameter must not be one of nysalt's own, got '{}'; choose another", path,
             name);
    if (std::ranges::count(names, name) > 0)
      refuse("{}: parameters must have different names, got '{}' twice", path, name);
    names.push_back(name);
    try {
      parameter.require(parameter.usual);
    } catch (const std::invalid_argument& problem) {
      refuse("{}: a default must be within its bounds: {}", path, problem.what());
    }
  }
}

void require_named(const std::string& letters, const std::string& path) {
  for (const char letter : letters) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0)
      refuse("{}: the name of a letter must be a letter or a digit, got '{}'; take another", path, letter);
    if (std::ranges::count(letters, letter) > 1) {
      refuse("{}: letters must have different names, got '{}' twice; name one of the two otherwise", path,
             letter);
    }
  }
}

system_declaration declared_in(const fs::path& library_file, const std::string& shown) {
  std::error_code ignored;
  const fs::path file = fs::absolute(library_file, ignored);
  if (!fs::exists(file, ignored))
    refuse("cannot load {}: there is no such file; name a library or source of a system", shown);
  if (!fs::is_regular_file(file, ignored))
    refuse("cannot load {}: it is not a regular file; name a library or source of a system", shown);
  if (!is_whole(file))
    throw unloadable(message("cannot load {} as a library: the file is cut off; build it again", shown));
  name_signals(shown);
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw unloadable(message("cannot load {} as a library: {}; build it again", shown, why_not_loaded(file)));
  }
  if (has_c_force(library)) return declaration_of_c_force(library, file.string(), shown);
  auto* const stamp_of = function_in<const char*()>(library, "nysalt_plugin_stamp", shown);
  const std::string stamp = stamp_of();
  if (stamp != detail::plugin_stamp()) {
    refuse("{}: the library must be built for '{}', got '{}'; build it again, by nysalt build", shown,
           detail::plugin_stamp(), stamp);
  }
  system_declaration declared;
  auto* const declare = function_in<void(system_declaration&)>(library, "nysalt_plugin_declare", shown);
  try {
    declare(declared);
  } catch (const std::exception& problem) {  // of the user's code
    refuse("cannot load {}: {}", shown, problem.what());
  }
  require_sound(declared, shown);
  require_named(declared.letters, shown);
  declared.identity = function_in<const char*()>(library, "nysalt_plugin_source", shown)();
  return declared;
}

/// A damaged library in the cache is compiled again, once.
system_declaration load(const std::string& path, const std::string& shown) {
  if (!is_source(path)) return declared_in(path, shown);
  const fs::path kept = compiled(path);
  try {
    return declared_in(kept, shown);
  } catch (const unloadable&) {
    std::error_code ignored;
    fs::remove(kept, ignored);
  }
  return declared_in(compiled(path), shown);
}

}  // namespace

void require_plugin(const std::string& path) { load(path, path); }

const system_declaration& plugin_at(const std::string& path, const std::string& shown) {
  auto& all = all_loaded();
  note_input(path);
  const auto known = std::ranges::find_if(all, [&](const auto& one) { return one->path == path; });
  if (known != all.end()) return (*known)->declared;
  return all.emplace_back(std::make_unique<loaded>(loaded{path, load(path, shown.empty() ? path : shown)}))
      ->declared;
}

std::vector<const system_declaration*> loaded_plugins() {
  std::vector<const system_declaration*> result;
  for (const auto& one : all_loaded()) result.push_back(&one->declared);
  return result;
}

}  // namespace nysalt::program
