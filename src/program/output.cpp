// SPDX-License-Identifier: BSL-1.0
#include "output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "build_info.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "comparison/standard_error.hpp"
#include "mpi_session.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/core/fingerprint.hpp"
#include "output/written_arrays.hpp"
#include "recorded_options.hpp"
#include "report/comparison_report.hpp"

namespace nysalt::program {

namespace {
std::exception_ptr failed_write;  // while write_and_print() prints what could not be written
}  // namespace

void print(std::string_view text) {
  if (!speaks_for_all()) return;
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return;
  if (errno == EPIPE && failed_write) std::rethrow_exception(failed_write);
  if (errno == EPIPE) std::_Exit(0);  // the reader has seen enough
  throw nysalt::detail::write_failure("cannot write the standard output: it is closed, or the disk is full");
}

text_form form_of(const common_settings& common) {
  text_form form{.is_verbose = common.verbose};
  constexpr std::size_t least = 60;  // columns, of which a table of results takes as many
  winsize terminal{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &terminal) == 0 && terminal.ws_col > 0)
    form.width = std::clamp<std::size_t>(terminal.ws_col, least, form.width);
  return form;
}

std::string line_of_written(std::string_view file) { return fmt::format("Written: {}\n", of_letters(file)); }

void write_and_print(const std::function<void()>& write, const std::function<void(bool)>& print_all) {
  try {
    write();
  } catch (const nysalt::detail::write_failure&) {
    failed_write = std::current_exception();
  } catch (const std::runtime_error& problem) {  // another process writes there, or put something there
    failed_write = std::make_exception_ptr(nysalt::detail::write_failure(problem.what()));
  } catch (...) {
    failed_write = std::current_exception();
  }
  try {
    print_all(!failed_write);
  } catch (...) {
    failed_write = nullptr;
    throw;
  }
  if (failed_write) std::rethrow_exception(std::exchange(failed_write, nullptr));
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

namespace {

/// Throws refusal if a file system could not take the longest name that a file has while it is written.
void require_room_for_name(const std::filesystem::path& file) {
  constexpr std::size_t longest = NAME_MAX;  // bytes, of nearly all file systems
  const std::size_t needed = file.filename().string().size() + std::string_view(".work.next.part").size();
  if (needed <= longest) return;
  refuse(
      "cannot write {}: a file name must be at most {} bytes long, got {} with the ending of what is "
      "unfinished; take a shorter name",
      file.string(), longest, needed);
}

/// The path from the root. Throws refusal for one in the current folder, if that is no more.
std::filesystem::path whole_path(const std::filesystem::path& path) {
  std::error_code failure;
  auto whole = std::filesystem::absolute(path, failure);
  if (failure) {
    refuse("cannot write {}: the current folder cannot be found ({}); change to one that is there",
           path.string(), failure.message());
  }
  return whole;
}

/// Says once that nothing keeps two processes from writing one file, where the file system has no locks.
void warn_of_missing_locks(int file, const std::filesystem::path& folder) {
  static bool is_said = false;
  if (is_said || nysalt::detail::ask_for_lock(file) != nysalt::detail::lock_outcome::unavailable) return;
  is_said = true;
  warn(fmt::format(
      "the file system of {} has no locks: two commands that write one file there are not told apart",
      folder.string()));
}

/// Why no file can be made in a folder; empty if one was made, and is gone. Permissions do not decide
/// this: a file system may take no file even of the superuser.
std::string objection_to_files_in(const std::filesystem::path& folder) {
  int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);  // without a name
  if (file < 0) {  // as file systems such as NFS have no files without names
    std::string name = folder / ".nysalt_trial_XXXXXX";
    file = mkostemp(name.data(), O_CLOEXEC);
    if (file < 0) {
      return fmt::format("the folder {} must be writable, got the error: {}; name another", folder.string(),
                         std::generic_category().message(errno));
    }
    unlink(name.c_str());
  }
  struct stat made {};
  const bool is_own = fstat(file, &made) != 0 || (made.st_mode & 0600U) == 0600U;
  warn_of_missing_locks(file, folder);
  close(file);
  if (!is_own) {
    return fmt::format(
        "a file that is made must be readable and writable by the user, got the mode {:03o}; type umask 022",
        made.st_mode & 0777U);
  }
  return {};
}

}  // namespace

void require_writable(const std::filesystem::path& named) {
  namespace fs = std::filesystem;
  whole_path(named);  // asks for the current folder
  require_replaceable(named);
  const fs::path file = nysalt::detail::behind_links(named);
  if (nysalt::detail::is_locked(file))
    refuse("cannot write {}: another process writes it; wait for that, or name another file", file.string());
  require_room_for_name(file);
  const fs::path folder = folder_of(file);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    refuse("cannot write {}: there is no folder {}; make it first", file.string(), folder.string());
  }
  if (const auto why = objection_to_files_in(folder); !why.empty())
    refuse("cannot write {}: {}", file.string(), why);
}

void require_result(const std::filesystem::path& file) {
  require_writable(file);
  require_no_work(file);
}

std::unique_ptr<work_file> begin_work(const std::string& output, const json& question, bool resume) {
  if (output.empty()) {
    if (resume) refuse("--resume must come with --output; name the output of the work to go on with");
    return nullptr;
  }
  bool is_finished = false;
  on_first(all_ranks(), [&] { is_finished = resume && is_there(output) && !is_there(work_of(output)); });
  broadcast(all_ranks(), is_finished);
  if (is_finished) {
    refuse("cannot resume the work for {}: the output is there, and no {}; leave --resume out to do it again",
           output, work_of(output).string());
  }
  return std::make_unique<work_file>(work_of(output), question, resume);
}

void tell_of_parts(const work_file* work) {
  if (work != nullptr && work->found() > 0)
    warn(fmt::format("{} finished parts were taken from the work file", work->found()));
  tell_of_origin(work);
}

void tell_of_origin(const work_file* work) {
  if (work != nullptr && !work->warning().empty()) warn(work->warning());
}

json question_of(const prepared_problem& system, const common_settings& common) {
  const recorded_options given(deciding_options(common.options));
  json question{{"command", given.command()}};
  for (const auto& [name, value] : given.all()) question[name].push_back(value);
  question["problem"] = system.parameters();
  question["starts"] = system.starts();
  question["program"] = fmt::format("nysalt {}, {} {}", version, compiler, compiler_flags);
  return question;
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto whole = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  };
  return whole(a) == whole(b);
}

void require_table(const std::string& output, bool plot, bool may_be_array) {
  if (plot && output.empty())
    refuse("--plot must come with --output; name the file beside which the picture goes");
  if (output.empty()) return;
  require_result(output);
  const std::string ending = std::filesystem::path(output).extension();
  if (!ending.empty() && ending != ".csv" && ending != ".txt" && !(may_be_array && is_of_arrays(output))) {
    refuse("--output must end in .csv{}, as what is written is no other kind of file, got {}",
           may_be_array ? ", .h5 or .npy" : "", output);
  }
  if (plot) require_picture(picture_name(output), folder_of(output));
}

std::string picture_name(const std::filesystem::path& table) {
  std::string name = table.stem().string();
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  // "a-npy" for a.npy, so that a.csv has another; and what else would have the same name has a fingerprint.
  const std::string ending = table.extension();
  const std::string kind = ending == ".csv" ? "" : ending.empty() ? "-" : "-" + ending.substr(1);
  const bool is_taken = std::ranges::any_of(std::array{"-", "-npy", "-h5", "-hdf5", "-txt"},
                                            [&](const char* other) { return name.ends_with(other); });
  if (name == table.stem().string() && !is_taken) return name + kind;
  nysalt::detail::fingerprint sum;
  for (const char c : table.filename().string()) sum.add(static_cast<unsigned char>(c));
  return name + "-" + sum.text();
}

void require_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path there = whole_path(folder);
  while (!fs::exists(fs::symlink_status(there, ignored)) && there.has_relative_path())
    there = there.parent_path();
  if (!fs::is_directory(there, ignored)) {
    refuse("cannot write into {}: {} is not a folder; name another", folder.string(), there.string());
  }
  if (const auto why = objection_to_files_in(there); !why.empty())
    refuse("cannot write into {}: {}", folder.string(), why);
}

void require_files_in(const std::filesystem::path& folder, const std::vector<std::string>& files) {
  require_folder(folder);
  for (const auto& file : files) require_replaceable(folder / file);
}

std::vector<std::filesystem::path> make_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code failure;
  std::vector<fs::path> made;
  for (fs::path there = whole_path(folder); !fs::exists(there, failure) && there.has_relative_path();
       there = there.parent_path()) {
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
  if (const auto advice = advice_on_threads(common.execution.threads); !advice.empty()) warn(advice);
}

}  // namespace nysalt::program
