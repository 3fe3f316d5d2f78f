// SPDX-License-Identifier: BSL-1.0
#include "plugin.hpp"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "build.hpp"
#include "cache.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "elf_file.hpp"
#include "force_library.hpp"
#include "named_signals.hpp"
#include "names.hpp"
#include "nysalt/core/rounding.hpp"
#include "nysalt/plugin.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

/// Which file lay at a path when it was loaded.
struct identity_of_file {
  std::string path;
  dev_t device = 0;
  ino_t number = 0;
  off_t length = 0;
  std::int64_t seconds = 0;  // of the last change
  std::int64_t nanoseconds = 0;

  bool operator==(const identity_of_file&) const = default;
};

identity_of_file identity_of(const fs::path& file) {
  std::error_code ignored;
  identity_of_file found{.path = fs::weakly_canonical(file, ignored).string()};
  struct stat now {};
  if (stat(file.c_str(), &now) != 0) return found;  // the loader says more
  found.device = now.st_dev;
  found.number = now.st_ino;
  found.length = now.st_size;
  found.seconds = now.st_mtim.tv_sec;
  found.nanoseconds = now.st_mtim.tv_nsec;
  return found;
}

struct loaded {
  identity_of_file from;
  system_declaration declared;
  std::set<std::string> unique_symbols;
};

/// What is loaded, for any number of threads. No thread waits here for what another one compiles or loads.
class all_loaded {
 public:
  const system_declaration* known(const identity_of_file& file) const {
    const std::lock_guard lock(guard_);
    const auto found = std::ranges::find_if(all_, [&](const auto& one) { return one->from == file; });
    return found == all_.end() ? nullptr : &(*found)->declared;
  }
  /// Whether another file was loaded from the path of this one.
  bool was_replaced(const identity_of_file& file) const {
    const std::lock_guard lock(guard_);
    return std::ranges::any_of(all_, [&](const auto& one) { return one->from.path == file.path; });
  }
  /// Throws refusal where the loader would give the library variables of another one.
  void require_apart(const std::set<std::string>& symbols, const std::string& shown) const {
    const std::lock_guard lock(guard_);
    for (const auto& one : all_) {
      for (const auto& symbol : symbols) {
        if (!one->unique_symbols.contains(symbol)) continue;
        refuse(
            "cannot load {}: the library must have variables of its own, got {}, which is that of {}, loaded "
            "before; build it with -fno-gnu-unique, or begin a new process",
            shown, symbol, one->from.path);
      }
    }
  }
  const system_declaration& keep(loaded one) {
    if (const auto* found = known(one.from)) return *found;  // another thread was first
    const std::lock_guard lock(guard_);
    return all_.emplace_back(std::make_unique<loaded>(std::move(one)))->declared;
  }
  std::vector<const system_declaration*> declarations() const {
    const std::lock_guard lock(guard_);
    std::vector<const system_declaration*> result;
    for (const auto& one : all_) result.push_back(&one->declared);
    return result;
  }

 private:
  mutable std::mutex guard_;
  std::vector<std::unique_ptr<loaded>> all_;
};

all_loaded& everything() {
  static all_loaded all;
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
  // A library that was compiled with -ffast-math flushes subnormal numbers from its loading on.
  const nysalt::detail::usual_rounding rounding;
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

/// Of the library at a path another one was loaded: the loader of the system would give that one again, so
/// this one is loaded from a copy, by the name of its contents.
fs::path copy_of(const fs::path& library) {
  std::ifstream stream(library, std::ios::binary);
  std::ostringstream contents;
  contents << stream.rdbuf();
  fs::path copy = cache_folder() / (name_of(contents.view()) + ".so");
  std::error_code ignored;
  if (stream && !fs::exists(copy, ignored)) write_to_cache(copy, contents.view());
  return copy;
}

const system_declaration& load(const fs::path& library, const std::string& shown) {
  const identity_of_file file = identity_of(library);
  if (const auto* known = everything().known(file)) return *known;
  const bool is_another = everything().was_replaced(file);
  auto symbols = unique_symbols_of(library);
  everything().require_apart(symbols, shown);
  return everything().keep(
      {file, declared_in(is_another ? copy_of(library) : library, shown), std::move(symbols)});
}

}  // namespace

const system_declaration& plugin_at(const std::string& path, const std::string& name_shown) {
  const std::string& shown = name_shown.empty() ? path : name_shown;
  note_input(path);
  if (!is_source(path)) return load(path, shown);
  const fs::path kept = compiled(path);
  try {
    return load(kept, shown);
  } catch (const unloadable&) {  // a damaged library in the cache is compiled again, once
    std::error_code ignored;
    fs::remove(kept, ignored);
  }
  return load(compiled(path), shown);
}

std::vector<const system_declaration*> loaded_plugins() { return everything().declarations(); }

}  // namespace nysalt::program
