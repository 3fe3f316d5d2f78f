// SPDX-License-Identifier: BSL-1.0
#include "inputs.hpp"

#include <fstream>
#include <mutex>
#include <set>
#include <string>
#include <system_error>

#include "nysalt/atomic_file.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

std::mutex guard;
std::set<std::string>& all() {
  static std::set<std::string> files;
  return files;
}

std::string whole(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file, ignored), ignored).string();
}

}  // namespace

bool is_there(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

void require_readable(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto there = std::filesystem::status(file, ignored);
  const bool is_plain = !exists(there) || is_regular_file(there) || is_directory(there);
  const std::string name = std::filesystem::absolute(file, ignored).lexically_normal().string();
  const bool is_of_shell = name == "/dev/stdin" || name == "/dev/null" || name.starts_with("/dev/fd/") ||
                           name.starts_with("/proc/self/fd/");
  if (is_plain || is_of_shell) return;
  refuse("cannot read {}: it is not a regular file; name another, or a pipe as /dev/stdin", file.string());
}

void note_input(const std::filesystem::path& file) {
  require_readable(file);
  const std::lock_guard lock(guard);
  all().insert(whole(file));
}

std::string contents_of(const std::filesystem::path& file, std::size_t longest, std::string_view what) {
  std::error_code ignored;
  note_input(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, ignored))
    refuse("cannot read {}: there is no readable file of this name; name {}", file.string(), what);
  std::string text(longest + 1, '\0');
  stream.read(text.data(), std::ssize(text));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

void forget_inputs() {
  const std::lock_guard lock(guard);
  all().clear();
}

bool is_input(const std::filesystem::path& file) {
  const std::lock_guard lock(guard);
  return all().contains(whole(file));
}

std::vector<std::filesystem::path> names_while_written(const std::filesystem::path& output) {
  const std::string file = nysalt::detail::behind_links(output).string();
  std::vector<std::filesystem::path> names{file};
  for (const char* ending :
       {".part", ".new.part", ".next.part", ".sorted.part", ".work", ".work.next.part"}) {
    names.emplace_back(file + ending);
  }
  return names;
}

void require_no_input(const std::filesystem::path& output) {
  for (const auto& name : names_while_written(output)) {
    if (is_input(name)) refuse("cannot write {}: it was read as input; name another file", name.string());
  }
}

void require_replaceable(const std::filesystem::path& output) {
  require_no_input(output);
  if (const auto why = nysalt::detail::objection_to_replacing(output); !why.empty()) {
    refuse("cannot write {}: {}", output.string(), why);
  }
  for (const auto& name : names_while_written(output)) {
    std::error_code ignored;
    const auto found = std::filesystem::symlink_status(name, ignored);
    if (!std::filesystem::exists(found) || std::filesystem::is_regular_file(found)) continue;
    refuse("cannot write {}: {} exists and is not a regular file; remove it", output.string(), name.string());
  }
}

}  // namespace nysalt::program
