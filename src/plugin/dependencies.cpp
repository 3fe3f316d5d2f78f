// SPDX-License-Identifier: BSL-1.0
#include "dependencies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <span>
#include <sstream>
#include <string_view>

#include "cache.hpp"
#include "comparison/child_process.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

/// The names behind the colon of a rule for make, which escapes blanks and # by \, and $ by $$.
std::vector<std::string> names_in_rule(std::string_view rule) {
  std::vector<std::string> names;
  std::string name;
  const auto finish = [&] {
    if (!name.empty()) names.push_back(std::move(name));
    name.clear();
  };
  rule.remove_prefix(std::min(rule.find(": "), rule.size() - 1) + 1);
  for (std::size_t i = 0; i < rule.size(); ++i) {
    const char c = rule[i];
    const char next = i + 1 < rule.size() ? rule[i + 1] : '\0';
    if (c == '\\' && next == '\n') {
      ++i;
      finish();
    } else if ((c == '\\' && (next == ' ' || next == '#')) || (c == '$' && next == '$')) {
      name += next;
      ++i;
    } else if (c == ' ' || c == '\n') {
      finish();
    } else {
      name += c;
    }
  }
  finish();
  return names;
}

/// Where headers lie that change with a package or with nysalt alone.
std::vector<std::string> folders_of_others(const recipe& how) {
  std::vector<std::string> folders{"/usr/include/", "/usr/lib/"};
  for (std::size_t i = 0; i < how.before.size(); ++i) {
    const std::string_view flag = how.before[i];
    if (flag.starts_with("-I")) folders.push_back(std::string(flag.substr(2)) + '/');
    if (flag == "-isystem" && i + 1 < how.before.size()) folders.push_back(how.before[i + 1] + '/');
  }
  return folders;
}

/// Where the compiler looks for what the source includes, but the folders of the flags.
std::vector<fs::path> searched_folders(const fs::path& of_source) {
  std::vector<fs::path> all{of_source};
  for (const char* name : {"CPATH", "CPLUS_INCLUDE_PATH"}) {
    const char* const value = std::getenv(name);
    std::istringstream folders(value != nullptr ? value : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      all.emplace_back(folder.empty() ? "." : folder);
  }
  return all;
}

/// Whether another file has one of the names by which a file may have been found, in any of the folders:
/// which of the two the compiler takes now, it must be asked.
bool may_be_hidden(const fs::path& file, const std::vector<fs::path>& folders) {
  fs::path name = file.filename();
  std::error_code ignored;
  for (fs::path above = file.parent_path(); above.has_relative_path(); above = above.parent_path()) {
    const bool has_other = std::ranges::any_of(folders, [&](const fs::path& folder) {
      return fs::exists(folder / name, ignored) && !fs::equivalent(folder / name, file, ignored);
    });
    if (has_other) return true;
    name = above.filename() / name;
  }
  return false;
}

fs::path whole(const fs::path& path) {
  std::error_code ignored;
  return fs::absolute(path, ignored);
}

}  // namespace

std::string first_error(const std::string& messages) {
  std::istringstream lines(messages);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view of_ours = "static assertion failed: nysalt: ";
    constexpr std::string_view by_clang = "static_assert failed";
    if (const auto at = line.find(of_ours); at != std::string::npos) return line.substr(at + of_ours.size());
    if (line.find(by_clang) != std::string::npos && line.find("nysalt: ") != std::string::npos) {
      return line.substr(line.find("nysalt: ") + std::string_view("nysalt: ").size());
    }
    const bool is_error =
        line.find("error:") != std::string::npos || line.find("undefined reference") != std::string::npos;
    if (is_error && first.empty()) first = line;
  }
  return first.empty() ? "the compiler says no more" : first;
}

dependencies dependencies_of(const fs::path& source, const recipe& how) {
  std::vector<std::string> command = how.before;
  for (const char* flag : {"-M", "-x", "c++"}) command.emplace_back(flag);
  command.push_back(whole(source).string());
  const child_result found = run_child(command, {}, error_output::kept);
  if (!found.code || *found.code == 127)
    refuse("cannot compile {}: the compiler {} cannot be started; install it", source.string(),
           command.front());
  if (!found.succeeded()) refuse("cannot compile {}: {}", source.string(), first_error(found.output));
  const auto others = folders_of_others(how);
  dependencies files{whole(source)};
  for (const auto& name : names_in_rule(found.output)) {
    const fs::path file = whole(name);
    const bool is_of_others =
        std::ranges::any_of(others, [&](const auto& folder) { return file.string().starts_with(folder); });
    if (!is_of_others && std::ranges::find(files, file) == files.end()) files.push_back(file);
  }
  return files;
}

std::string contents_of(const dependencies& files) {
  std::string all;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    if (stream) text << stream.rdbuf();
    if (!stream) refuse("cannot compile {}: {} cannot be read", files.front().string(), file.string());
    all += fmt::format("{} {}\n", text.view().size(), text.view());
  }
  return all;
}

std::string environment_of_compiler() {
  std::string all;
  for (const char* name : {"CPATH", "C_INCLUDE_PATH", "CPLUS_INCLUDE_PATH", "LIBRARY_PATH", "COMPILER_PATH",
                           "GCC_EXEC_PREFIX"}) {
    const char* value = std::getenv(name);
    if (value != nullptr) all += fmt::format("{}={}\n", name, value);
  }
  std::error_code ignored;
  if (!all.empty()) all += fs::current_path(ignored).string() + '\n';  // in which relative folders are found
  return all;
}

// The file holds the name of the library, and a line for each dependency but the source; what lies below the
// folder of the source is named from there, so that a copy of all of it elsewhere has the same library.
std::optional<kept_dependencies> dependencies_kept_in(const fs::path& file, const fs::path& source) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  std::ifstream lines(file);
  kept_dependencies found{.files = {whole(source)}, .library = {}};
  if (!std::getline(lines, found.library)) return std::nullopt;
  const fs::path folder = found.files.front().parent_path();
  auto folders = searched_folders(folder);
  for (std::string line; std::getline(lines, line);) {
    found.files.push_back(folder / line);
    if (!fs::is_regular_file(found.files.back(), ignored)) return std::nullopt;
    // What a file includes in quotes is looked for beside it first.
    const fs::path beside = found.files.back().parent_path();
    if (std::ranges::find(folders, beside) == folders.end()) folders.push_back(beside);
  }
  const auto included = std::span(found.files).subspan(1);
  if (std::ranges::any_of(included, [&](const fs::path& one) { return may_be_hidden(one, folders); }))
    return std::nullopt;
  return found;
}

void keep_dependencies(const fs::path& file, const kept_dependencies& found) {
  // What a source asks for by __has_include may come later: it is asked again each time.
  if (contents_of(found.files).find("__has_include") != std::string::npos) return;
  const std::string folder = found.files.front().parent_path().string() + '/';
  std::string text = found.library + '\n';
  for (std::size_t i = 1; i < found.files.size(); ++i) {
    const std::string name = found.files[i].string();
    if (name.find('\n') != std::string::npos) return;  // asked again each time
    text += (name.starts_with(folder) ? name.substr(folder.size()) : name) + '\n';
  }
  write_to_cache(file, text);
}

}  // namespace nysalt::program
