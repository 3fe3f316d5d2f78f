// SPDX-License-Identifier: BSL-1.0
#include "recipe.hpp"

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

/// The file that this code was loaded from.
fs::path own_file() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&recipe_of_library), &info) == 0 || info.dli_fname == nullptr)
    return {};
  std::error_code ignored;
  fs::path file = info.dli_fname;
  // Of a program that was found on the path the name is not where it lies.
  if (!fs::exists(file, ignored) || !file.has_parent_path())
    file = fs::read_symlink("/proc/self/exe", ignored);
  return fs::weakly_canonical(file, ignored);
}

/// Whether it is a regular file of the user, of root or of who owns this code, and no one else may write it.
bool is_trusted(const fs::path& file, const fs::path& code) {
  struct stat found {};
  struct stat own {};
  if (stat(file.c_str(), &found) != 0 || stat(code.c_str(), &own) != 0) return false;
  if (!S_ISREG(found.st_mode)) return false;  // who reads a FIFO waits
  const bool is_known = found.st_uid == 0 || found.st_uid == geteuid() || found.st_uid == own.st_uid;
  return is_known && (found.st_mode & S_IWOTH) == 0U;
}

/// The lines of a file of flags, where the prefix is the folder.
std::optional<recipe> recipe_in(const fs::path& file, const fs::path& prefix) {
  std::ifstream lines(file);
  recipe result;
  auto* to = &result.before;
  constexpr std::string_view mark = "{prefix}";
  for (std::string line; std::getline(lines, line);) {
    if (const auto at = line.find(mark); at != std::string::npos)
      line.replace(at, mark.size(), prefix.string());
    if (line == "--") {
      to = &result.libraries;
    } else if (!line.empty()) {
      to->push_back(line);
    }
  }
  if (result.before.empty()) return std::nullopt;
  return result;
}

}  // namespace

recipe recipe_of_library() {
  const fs::path code = own_file();
  const fs::path here = code.parent_path();
  struct place {
    const char* prefix;  // from the folder of this code
    const char* flags;   // from the prefix
  };
  constexpr const char* installed = "share/nysalt/plugin.flags";
  for (const place& one :
       std::array{place{".", "plugin.flags"},             // the program in the build folder
                  place{"..", "plugin.flags"},            // its tests
                  place{"../..", "plugin.flags"},         // its Python module
                  place{"..", installed},                 // bin/nysalt
                  place{"../../../..", installed},        // lib/python3/dist-packages/nysalt
                  place{"../../../../..", installed}}) {  // a module for one kind of processor
    const fs::path prefix = (here / one.prefix).lexically_normal();
    const fs::path file = prefix / one.flags;
    if (!is_trusted(file, code)) continue;
    if (auto found = recipe_in(file, prefix)) return *std::move(found);
  }
  refuse(
      "cannot compile plug-ins: share/nysalt/plugin.flags, the command to compile by, is missing; install "
      "nysalt's development files");
}

}  // namespace nysalt::program
