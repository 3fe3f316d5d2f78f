// SPDX-License-Identifier: BSL-1.0
#include "child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>

#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

std::atomic<pid_t> running = 0;

/// A file without a name.
class anonymous_file {
 public:
  anonymous_file() : descriptor_(memfd_create("nysalt", MFD_CLOEXEC)) {}
  ~anonymous_file() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  anonymous_file(const anonymous_file&) = delete;
  anonymous_file& operator=(const anonymous_file&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  std::string text() const {
    std::string all;
    std::array<char, 65536> some{};
    off_t at = 0;
    while (true) {
      const ssize_t count = ::pread(descriptor_, some.data(), some.size(), at);
      if (count <= 0) return all;
      all.append(some.data(), static_cast<std::size_t>(count));
      at += count;
    }
  }

 private:
  int descriptor_;
};

/// The folders of PATH that are named from the root. In one that is named from the current folder, as an
/// empty one is, a file may lie that the user does not mean to run. Without any, those of the system.
std::string whole_folders_of_path() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  std::string whole;
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.starts_with('/')) whole += (whole.empty() ? "" : ":") + folder;
  }
  return whole.empty() ? "/usr/bin:/bin" : whole;
}

/// The program of a name, where the PATH has it; empty if there is none.
std::string on_the_path(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (name.find('/') != std::string::npos) return fs::absolute(name, ignored).string();
  std::istringstream folders(whole_folders_of_path());
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) return file.string();
  }
  return {};
}

/// The environment of this process, in which programs say in English what is searched here (LANGUAGE would
/// win over LC_ALL), and find others, as a compiler its assembler, in whole folders alone.
std::vector<std::string> environment_of_child() {
  std::vector<std::string> all{"LC_ALL=C.UTF-8", "PATH=" + whole_folders_of_path()};
  for (char** one = environ; *one != nullptr; ++one) {
    const std::string_view text(*one);
    if (!text.starts_with("LC_ALL=") && !text.starts_with("LANGUAGE=") && !text.starts_with("PATH="))
      all.emplace_back(text);
  }
  return all;
}

/// As the C library takes texts.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (const auto& text : texts) all.push_back(const_cast<char*>(text.c_str()));
  all.push_back(nullptr);
  return all;
}

/// What the child does before the program begins; it has a process group of its own, which can be ended
/// whole.
class spawn_settings {
 public:
  spawn_settings(const std::filesystem::path& folder, const anonymous_file& output, error_output errors,
                 const sigset_t& signals) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output.descriptor(), STDOUT_FILENO);
    if (errors == error_output::kept) {
      posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setsigmask(&attributes_, &signals);
  }
  ~spawn_settings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  spawn_settings(const spawn_settings&) = delete;
  spawn_settings& operator=(const spawn_settings&) = delete;

  bool of(const std::vector<std::string>& command, pid_t& child) const {
    const std::string program = on_the_path(command.front());
    const auto environment = environment_of_child();
    return posix_spawn(&child, program.c_str(), &actions_, &attributes_, pointers_to(command).data(),
                       pointers_to(environment).data()) == 0;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

child_result run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
                       error_output errors) {
  const anonymous_file output;
  if (!output.is_open()) return {};
  pid_t child = 0;
  {
    const nysalt::detail::held_signals held;  // no handler between the start of a child and `running`
    if (!spawn_settings(folder, output, errors, held.before()).of(command, child)) return {};
    running = child;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  running = 0;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output.text()};
}

void end_child() noexcept {
  const pid_t child = running;
  if (child <= 0) return;
  ::kill(-child, SIGTERM);
  for (int n = 0; n < 100; ++n) {
    if (waitpid(child, nullptr, WNOHANG) != 0) return;
    ::poll(nullptr, 0, 10);
  }
  ::kill(-child, SIGKILL);
}

}  // namespace nysalt::program
