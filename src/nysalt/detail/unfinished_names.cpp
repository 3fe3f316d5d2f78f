// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/unfinished_names.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>

namespace nysalt::detail {

namespace {

constexpr std::size_t longest = 4096;  // PATH_MAX of Linux

struct slot {
  std::atomic<bool> is_taken = false;
  std::atomic<bool> is_set = false;
  std::array<char, longest> name{};
};
std::array<slot, 32> slots;

}  // namespace

unfinished_name::unfinished_name(const std::filesystem::path& file) : place_(slots.size()) {
  std::error_code ignored;
  const std::string name = std::filesystem::absolute(file, ignored).string();
  if (name.size() >= longest) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].is_taken.exchange(true)) continue;
    std::copy(name.begin(), name.end(), slots[i].name.begin());
    slots[i].name[name.size()] = '\0';
    slots[i].is_set = true;
    place_ = i;
    return;
  }
}

unfinished_name::~unfinished_name() {
  if (place_ >= slots.size()) return;
  slots[place_].is_set = false;
  slots[place_].is_taken = false;
}

void remove_unfinished_files() noexcept {
  for (slot& one : slots) {
    if (one.is_set) ::unlink(one.name.data());
  }
}

}  // namespace nysalt::detail
