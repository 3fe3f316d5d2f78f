// SPDX-License-Identifier: BSL-1.0
#include "output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>

#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "comparison/standard_error.hpp"
#include "mpi_session.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/detail/write_failure.hpp"
#include "report/manifest.hpp"

namespace nysalt::program {

void print(std::string_view text) {
  if (!speaks_for_all()) return;
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) std::_Exit(0);  // the reader has seen enough
  throw nysalt::detail::write_failure("cannot write the standard output: it is closed, or the disk is full");
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

namespace {

/// Throws refusal if a file system could not take the longest name that a file has while it is written.
void require_room_for_name(const std::filesystem::path& file) {
  constexpr std::size_t longest = NAME_MAX;  // bytes, of nearly all file systems
  const std::size_t needed = file.filename().string().size() + std::string_view(".sorted.part").size();
  if (needed <= longest) return;
  refuse(
      "cannot write {}: a file name must be at most {} bytes long, got {} with the ending of what is "
      "unfinished; take a shorter name",
      file.string(), longest, needed);
}

}  // namespace

void require_writable(const std::filesystem::path& named) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string whole = fs::absolute(named, ignored).lexically_normal().string();
  if (whole.starts_with("/dev/") || whole.starts_with("/proc/")) {
    refuse("cannot write {}: it is not a regular file; name another, or leave out --output", named.string());
  }
  const fs::path file = nysalt::detail::behind_links(named);
  require_no_input(file);
  require_room_for_name(file);
  if (fs::is_directory(file, ignored)) {
    refuse("cannot write {}: it is a folder; name another file", file.string());
  }
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) {
    refuse("cannot write {}: it is not a regular file; name another, or leave out --output", file.string());
  }
  const fs::path folder = folder_of(file);
  if (!fs::is_directory(folder, ignored)) {
    refuse("cannot write {}: there is no folder {}; make it first", file.string(), folder.string());
  }
  if (access(folder.c_str(), W_OK) != 0) {
    refuse("cannot write {}: the folder {} is not writable", file.string(), folder.string());
  }
}

void require_result(const std::filesystem::path& file) {
  require_writable(file);
  require_manifest(file);
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto whole = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  };
  return whole(a) == whole(b);
}

void require_table(const std::string& output, bool plot, const std::string& method) {
  if (plot && output.empty())
    refuse("--plot must come with --output; name the file beside which the picture goes");
  if (output.empty()) return;
  require_result(output);
  if (!method.empty() && is_same_file(method, output)) {
    refuse("--output must not be the file of the method, got {}; name another", output);
  }
  const std::string ending = std::filesystem::path(output).extension();
  if (plot && (ending == ".svg" || ending == ".png" || ending == ".dat" || ending == ".gp")) {
    refuse("--output must not have the ending of a file of --plot, got {}; let --output end in .csv", ending);
  }
}

std::string picture_name(const std::filesystem::path& table) {
  std::string name = table.stem().string();
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return name;
}

void require_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, ignored) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, ignored)) {
    refuse("cannot write into {}: {} is not a folder; name another", folder.string(), there.string());
  }
  if (access(there.c_str(), W_OK) != 0) {
    refuse("cannot write into {}: the folder {} is not writable", folder.string(), there.string());
  }
}

std::vector<std::filesystem::path> make_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code failure;
  std::vector<fs::path> made;
  for (fs::path there = fs::absolute(folder); !fs::exists(there, failure); there = there.parent_path()) {
    if (there.has_filename()) made.insert(made.begin(), there);
  }
  fs::create_directories(folder, failure);
  if (failure) refuse("cannot make the folder {}: {}", folder.string(), failure.message());
  return made;
}

namespace {

/// A text that quotes what is very long loses its middle; what to do is at the end.
std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 1200;  // bytes
  constexpr std::size_t end = 300;
  const auto is_within_letter = [&](std::size_t at) {
    return at < text.size() && static_cast<unsigned char>(text[at]) >> 6U == 2;
  };
  if (text.size() <= longest) return text;
  std::size_t first = longest - end;
  while (is_within_letter(first)) --first;
  std::size_t last = text.size() - end;
  while (is_within_letter(last)) ++last;
  return text.substr(0, first) + " [...] " + text.substr(last);
}

}  // namespace

void complain(std::string text) {
  text = shortened(of_letters(text));
  if (!speaks_for_all()) {
    keep_unsaid(text);
    return;
  }
  to_standard_error("nysalt: " + text + "\n");
}

void warn(std::string_view text) { complain("warning: " + std::string(text)); }

void warn_of_threads(const common_settings& common) {
  if (const auto advice = advice_on_threads(common.threads); !advice.empty()) warn(advice);
}

}  // namespace nysalt::program
