// SPDX-License-Identifier: BSL-1.0
// Preloaded into a program, has one call of the system fail, and sees whether files are on the disk before
// they get their names:
//   NYSALT_FAULT=OPERATION:NUMBER:HOW   OPERATION write, pwrite, fflush, fsync, rename or truncate; its call
//       NUMBER, from 1, on ordinary files; HOW nospace, nospace_for_good, io, skip (nothing is done, and
//       success is returned), kill, or signal_N (that comes before the call)
//   NYSALT_FAULT_COUNTS=FILE            at the end the calls of each are written there, and for each file
//       renamed without fsync after the last write a line "unsynced NAME"
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace {

enum operation { of_write, of_pwrite, of_fflush, of_fsync, of_rename, of_truncate, operations };
constexpr std::array<const char*, operations> names{"write", "pwrite", "fflush",
                                                    "fsync", "rename", "truncate"};
std::array<std::atomic<long>, operations> counts{};

/// Files that were written, the latest last, and whether fsync came after that.
struct written_file {
  dev_t device;
  ino_t number;
  bool is_on_disk;
};
std::mutex guard;
std::array<written_file, 256> written{};
std::size_t written_files = 0;
std::array<char, 1 << 16> unsynced{};

bool is_ordinary(int file) {
  struct stat found {};
  return file > STDERR_FILENO && fstat(file, &found) == 0 && S_ISREG(found.st_mode);
}

void note(const struct stat& found, bool is_on_disk) {
  const std::lock_guard lock(guard);
  for (std::size_t i = 0; i < written_files; ++i) {
    written_file& one = written[i];
    if (one.device == found.st_dev && one.number == found.st_ino) {
      one.is_on_disk = is_on_disk;
      return;
    }
  }
  if (written_files < written.size()) written[written_files++] = {found.st_dev, found.st_ino, is_on_disk};
}
void note(int file, bool is_on_disk) {
  struct stat found {};
  if (fstat(file, &found) == 0) note(found, is_on_disk);
}

void note_rename(const char* from) {
  struct stat found {};
  if (lstat(from, &found) != 0 || !S_ISREG(found.st_mode)) return;
  const std::lock_guard lock(guard);
  for (std::size_t i = 0; i < written_files; ++i) {
    const written_file& one = written[i];
    if (one.device == found.st_dev && one.number == found.st_ino && one.is_on_disk) return;
  }
  const std::size_t used = std::strlen(unsynced.data());
  std::snprintf(unsynced.data() + used, unsynced.size() - used, "unsynced %s\n", from);
}

enum class outcome { real, failure, skipped };

outcome outcome_of(operation which) {
  const char* asked = std::getenv("NYSALT_FAULT");
  const long now = ++counts[which];
  if (asked == nullptr) return outcome::real;
  const std::size_t length = std::strlen(names[which]);
  if (std::strncmp(asked, names[which], length) != 0 || asked[length] != ':') return outcome::real;
  char* how = nullptr;
  const long number = std::strtol(asked + length + 1, &how, 10);
  const bool for_good = std::strcmp(how, ":nospace_for_good") == 0;
  if (now != number && !(for_good && now > number)) return outcome::real;
  if (std::strcmp(how, ":kill") == 0) std::raise(SIGKILL);
  constexpr const char* signal = ":signal_";
  if (std::strncmp(how, signal, std::strlen(signal)) == 0) {
    std::raise(std::atoi(how + std::strlen(signal)));
    return outcome::real;
  }
  if (std::strcmp(how, ":skip") == 0) return outcome::skipped;
  errno = std::strcmp(how, ":io") == 0 ? EIO : ENOSPC;
  return outcome::failure;
}

template <class F>
F* real(F*, const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define REAL(name) real(static_cast<decltype(&name)>(nullptr), #name)

namespace {
/// What a call returns: what `call` does, -1 for a failure, or `skipped` where nothing is done.
template <class Call, class Result>
Result tried(operation which, Result skipped, const Call& call) {
  const auto how = outcome_of(which);
  return how == outcome::real ? call() : how == outcome::skipped ? skipped : Result(-1);
}
/// The same of what is written to a file, if that is an ordinary one.
template <class Call, class Result>
Result written_to(int file, operation which, Result skipped, const Call& call) {
  if (!is_ordinary(file)) return call();
  note(file, false);
  return tried(which, skipped, call);
}
}  // namespace

#pragma GCC visibility push(default)
extern "C" {

ssize_t write(int file, const void* from, std::size_t length) {
  return written_to(file, of_write, static_cast<ssize_t>(length),
                    [&] { return REAL(write)(file, from, length); });
}
ssize_t pwrite(int file, const void* from, std::size_t length, off_t at) {
  return written_to(file, of_pwrite, static_cast<ssize_t>(length),
                    [&] { return REAL(pwrite)(file, from, length, at); });
}
ssize_t pwrite64(int file, const void* from, std::size_t length, off64_t at) {
  return written_to(file, of_pwrite, static_cast<ssize_t>(length),
                    [&] { return REAL(pwrite64)(file, from, length, at); });
}
int fflush(std::FILE* stream) {
  const auto call = [&] { return REAL(fflush)(stream); };
  return stream == nullptr ? call() : written_to(fileno(stream), of_fflush, 0, call);
}
int fsync(int file) {
  const auto call = [&] {
    if (is_ordinary(file)) note(file, true);
    return REAL(fsync)(file);
  };
  return is_ordinary(file) ? tried(of_fsync, 0, call) : call();
}
int rename(const char* from, const char* to) {
  note_rename(from);
  return tried(of_rename, 0, [&] { return REAL(rename)(from, to); });
}
int truncate(const char* file, off_t length) {
  return tried(of_truncate, 0, [&] { return REAL(truncate)(file, length); });
}
int truncate64(const char* file, off64_t length) {
  return tried(of_truncate, 0, [&] { return REAL(truncate64)(file, length); });
}

}  // extern "C"
#pragma GCC visibility pop

namespace {
struct teller {
  ~teller() {
    const char* file = std::getenv("NYSALT_FAULT_COUNTS");
    std::FILE* out = file == nullptr ? nullptr : std::fopen(file, "a");
    if (out == nullptr) return;
    for (std::size_t i = 0; i < names.size(); ++i) std::fprintf(out, "%s %ld\n", names[i], counts[i].load());
    std::fputs(unsynced.data(), out);
    std::fclose(out);
  }
};
const teller at_the_end;
}  // namespace
