// SPDX-License-Identifier: BSL-1.0
#include "inputs.hpp"

#include <mutex>
#include <set>
#include <string>
#include <system_error>

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

void note_input(const std::filesystem::path& file) {
  const std::lock_guard lock(guard);
  all().insert(whole(file));
}

bool is_input(const std::filesystem::path& file) {
  const std::lock_guard lock(guard);
  return all().contains(whole(file));
}

void require_no_input(const std::filesystem::path& output) {
  if (!is_input(output)) return;
  refuse("cannot write {}: it was read as input; name another file", output.string());
}

}  // namespace nysalt::program
