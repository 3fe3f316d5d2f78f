// SPDX-License-Identifier: BSL-1.0
#include "cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

/// NAME.HOST.PROCESS.NUMBER.part: a home may be shared by machines, and a process has threads.
fs::path unique_name_of(const fs::path& target) {
  static std::atomic<int> number = 0;
  std::array<char, HOST_NAME_MAX + 1> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("{}.{}.{}.{}.part", target.string(), host.data(), ::getpid(), number++);
}

/// A folder of the user that no other may write, which is made if it is not there.
void require_own(const fs::path& folder) {
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    refuse("cannot make {}, the folder of compiled plug-ins: {}; set XDG_CACHE_HOME to another folder",
           folder.string(), std::generic_category().message(errno));
  struct stat found {};
  if (stat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode))
    refuse("cannot use {}, the folder of compiled plug-ins: it is no folder; set XDG_CACHE_HOME to another",
           folder.string());
  if (found.st_uid != geteuid())
    refuse(
        "cannot use {}, the folder of compiled plug-ins: it must be the user's own, as what lies there is "
        "run, got the "
        "user number {}; set XDG_CACHE_HOME to another folder",
        folder.string(), found.st_uid);
  if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0U)
    refuse(
        "cannot use {}, the folder of compiled plug-ins: only the user may write there, as what lies there "
        "is run, got "
        "the mode {:03o}; type chmod go-w, or set XDG_CACHE_HOME to another folder",
        folder.string(), found.st_mode & 0777U);
}

}  // namespace

void cannot_write_to_cache(const fs::path& file, const std::error_code& problem) {
  throw nysalt::detail::write_failure(fmt::format("cannot write {}: {}", file.string(), problem.message()));
}

fs::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder = cache != nullptr && *cache == '/' ? fs::path(cache)
                    : home != nullptr && *home == '/' ? fs::path(home) / ".cache"
                                                      : fs::path();
  if (folder.empty()) refuse("cannot compile plug-ins: they have no folder; set HOME or XDG_CACHE_HOME");
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem)
    refuse("cannot make {}, the folder of compiled plug-ins: {}; set XDG_CACHE_HOME to another folder",
           folder.string(), problem.message());
  folder /= "nysalt";
  require_own(folder);
  folder /= "plugins";
  require_own(folder);
  return folder;
}

std::string name_of(std::string_view text) {
  // FNV-1a from two beginnings.
  const auto hash = [&](std::uint64_t h) {
    for (const char c : text)
      h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;  // the prime of 64-bit FNV-1a
    return h;
  };
  return fmt::format("{:016x}{:016x}", hash(0xcbf29ce484222325U), hash(0x84222325cbf29ce4U));  // its offset
}

cache_part::cache_part(fs::path target)
    : target_(std::move(target)), path_(unique_name_of(target_)), name_(path_) {}

cache_part::~cache_part() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void cache_part::keep() const {
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  std::error_code problem(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  if (!done) cannot_write_to_cache(path_, problem);
  fs::rename(path_, target_, problem);
  if (problem) cannot_write_to_cache(target_, problem);
}

void write_to_cache(const fs::path& file, std::string_view text) {
  const cache_part part(file);
  errno = 0;
  std::ofstream stream(part.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) cannot_write_to_cache(file, {errno, std::generic_category()});
  part.keep();
}

void remove_left_parts() {
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code failure;
  for (fs::directory_iterator at(cache_folder(), failure), end; !failure && at != end;
       at.increment(failure)) {
    std::error_code ignored;
    const auto made = at->last_write_time(ignored);
    if (!ignored && at->path().extension() == ".part" && made < yesterday) fs::remove(at->path(), ignored);
  }
}

}  // namespace nysalt::program
