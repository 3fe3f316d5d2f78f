// SPDX-License-Identifier: BSL-1.0
#include "plugin.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>
#include <string_view>

#include "../program/refusal.hpp"
#include "build.hpp"
#include "named_signals.hpp"
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
  if (found == nullptr) refuse("{}: the library declares no system: NYSALT_SYSTEM(...) is missing", path);
  return found;
}

/// What dlerror() says, without the path, which the message has already.
std::string why_not_loaded(const fs::path& file) {
  const char* told = dlerror();
  std::string text = told == nullptr ? "unknown" : told;
  const std::string prefix = file.string() + ": ";
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  return text;
}

void require_sound(const system_declaration& declared, const std::string& path) {
  std::vector<std::string> names;
  for (const auto& parameter : declared.parameters) {
    const std::string& name = parameter.name;
    const auto may_stand = [](char c) {
      return ('a' <= c && c <= 'z') || ('0' <= c && c <= '9') || c == '_';
    };
    if (name.empty() || !std::ranges::all_of(name, may_stand) || name.front() < 'a') {
      refuse("{}: a parameter is called '{}': take lower-case letters, digits and _, a letter first", path,
             name);
    }
    if (std::ranges::count(names, name) > 0) refuse("{}: two parameters are called '{}'", path, name);
    names.push_back(name);
  }
}

system_declaration load(const std::string& path) {
  const fs::path file = fs::absolute(is_source(path) ? compiled(path) : fs::path(path));
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) refuse("{}: there is no such file", path);
  name_signals(path);
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) refuse("{}: this is no library that can be loaded: {}", path, why_not_loaded(file));
  auto* const stamp_of = function_in<const char*()>(library, "nysalt_plugin_stamp", path);
  const std::string stamp = stamp_of();
  if (stamp != detail::plugin_stamp()) {
    refuse("{}: it was built for '{}', and this is '{}': build it again, by nysalt build", path, stamp,
           detail::plugin_stamp());
  }
  system_declaration declared;
  auto* const declare = function_in<void(system_declaration&)>(library, "nysalt_plugin_declare", path);
  try {
    declare(declared);
  } catch (const std::exception& problem) {  // of the user's code
    refuse("{}: {}", path, problem.what());
  }
  require_sound(declared, path);
  return declared;
}

}  // namespace

const system_declaration& plugin_at(const std::string& path) {
  auto& all = all_loaded();
  const auto known = std::ranges::find_if(all, [&](const auto& one) { return one->path == path; });
  if (known != all.end()) return (*known)->declared;
  return all.emplace_back(std::make_unique<loaded>(loaded{path, load(path)}))->declared;
}

std::vector<const system_declaration*> loaded_plugins() {
  std::vector<const system_declaration*> result;
  for (const auto& one : all_loaded()) result.push_back(&one->declared);
  return result;
}

}  // namespace nysalt::program
