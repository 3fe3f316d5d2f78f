// SPDX-License-Identifier: BSL-1.0
#include "write_file.hpp"

#include <filesystem>
#include <string_view>

#include "nysalt/atomic_file.hpp"

namespace nysalt {

void write_file(const std::filesystem::path& path, std::string_view text) {
  atomic_file file(path);
  file.write(text);
  file.commit(true);
}

}  // namespace nysalt
