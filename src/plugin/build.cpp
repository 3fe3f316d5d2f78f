// SPDX-License-Identifier: BSL-1.0
#include "build.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "comparison/child_process.hpp"
#include "comparison/inputs.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/detail/objection_to_replacing.hpp"
#include "nysalt/detail/unfinished_names.hpp"
#include "nysalt/detail/write_failure.hpp"
#include "nysalt/plugin.hpp"
#include "plugin.hpp"
#include "report/write_file.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

std::optional<std::string> text_of_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The command by which plug-ins are compiled: the compiler, its arguments, and behind a line "--" what they
/// are linked with.
struct recipe {
  std::vector<std::string> before;
  std::vector<std::string> libraries;
};

/// The folder that this code was loaded from.
fs::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&is_source), &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code ignored;
  fs::path file = info.dli_fname;
  // Of a program that was found on the path the name is not where it lies.
  if (!fs::exists(file, ignored) || !file.has_parent_path())
    file = fs::read_symlink("/proc/self/exe", ignored);
  return fs::weakly_canonical(file, ignored).parent_path();
}

/// Of the build folder or installed tree that this code belongs to.
recipe recipe_of_library() {
  for (fs::path folder = own_folder(); !folder.empty(); folder = folder.parent_path()) {
    for (const fs::path& file : {folder / "plugin.flags", folder / "share" / "nysalt" / "plugin.flags"}) {
      const auto text = text_of_file(file);
      if (!text) continue;
      recipe result;
      auto* to = &result.before;
      std::istringstream lines(*text);
      for (std::string line; std::getline(lines, line);) {
        const auto at = line.find("{prefix}");
        if (at != std::string::npos) line.replace(at, std::strlen("{prefix}"), folder.string());
        if (line == "--") {
          to = &result.libraries;
        } else if (!line.empty()) {
          to->push_back(line);
        }
      }
      if (!result.before.empty()) return result;
    }
    if (folder == folder.root_path()) break;
  }
  refuse(
      "cannot compile plug-ins: share/nysalt/plugin.flags, the command to compile by, is missing; install "
      "nysalt's development files");
}

/// A source, and what it includes in quotes, one after the other.
void append_sources(const fs::path& file, std::set<fs::path>& seen, std::string& to) {
  constexpr std::size_t most = std::size_t{1} << 18U;  // bytes: the library's headers are not among them
  std::error_code ignored;
  if (!seen.insert(fs::weakly_canonical(file, ignored)).second) return;
  if (!fs::is_regular_file(file, ignored)) return;  // the compiler says more
  const auto length = fs::file_size(file, ignored);
  if (ignored || length > most - std::min(to.size(), most)) {
    refuse("{}: a source with what it includes must be at most 256 kB long; put data into a file of its own",
           file.string());
  }
  const auto text = text_of_file(file);
  if (!text) return;
  note_input(file);
  to += fmt::format("{} {}\n", text->size(), *text);
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    std::string_view rest = line;
    const auto skip = [&](std::string_view expected) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      if (!rest.starts_with(expected)) return false;
      rest.remove_prefix(expected.size());
      return true;
    };
    if (!skip("#") || !skip("include") || !skip("\"")) continue;
    append_sources(file.parent_path() / rest.substr(0, rest.find('"')), seen, to);
  }
}

/// 128 bits, by which different sources have different names: FNV-1a from two beginnings.
std::string name_of(std::string_view text) {
  const auto hash = [&](std::uint64_t h) {
    for (const char c : text)
      h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;  // the prime of 64-bit FNV-1a
    return h;
  };
  return fmt::format("{:016x}{:016x}", hash(0xcbf29ce484222325U), hash(0x84222325cbf29ce4U));  // its offset
}

fs::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder = cache != nullptr && *cache == '/' ? fs::path(cache)
                    : home != nullptr && *home == '/' ? fs::path(home) / ".cache"
                                                      : fs::path();
  if (folder.empty()) refuse("cannot compile plug-ins: they have no folder; set HOME or XDG_CACHE_HOME");
  folder = folder / "nysalt" / "plugins";
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem)
    refuse("cannot make {}, the folder of compiled plug-ins: {}; set XDG_CACHE_HOME to another folder",
           folder.string(), problem.message());
  return folder;
}

[[noreturn]] void cannot_write(const fs::path& file, const std::error_code& problem) {
  throw nysalt::detail::write_failure(fmt::format("cannot write {}: {}", file.string(), problem.message()));
}

/// The message to show first: a sentence of ours if there is one, else the first error.
std::string first_error(const std::string& messages) {
  std::istringstream lines(messages);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view of_ours = "static assertion failed: nysalt: ";
    constexpr std::string_view by_clang = "static_assert failed";
    if (const auto at = line.find(of_ours); at != std::string::npos) return line.substr(at + of_ours.size());
    if (line.find(by_clang) != std::string::npos && line.find("nysalt: ") != std::string::npos) {
      return line.substr(line.find("nysalt: ") + std::string_view("nysalt: ").size());
    }
    const bool is_error =
        line.find("error:") != std::string::npos || line.find("undefined reference") != std::string::npos;
    if (is_error && first.empty()) first = line;
  }
  return first.empty() ? "the compiler says no more" : first;
}

/// A file that is removed in any case, also by a signal.
struct temporary {
  explicit temporary(fs::path file) : path(std::move(file)), name(path) {}
  ~temporary() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  temporary(const temporary&) = delete;
  temporary& operator=(const temporary&) = delete;

  fs::path path;
  nysalt::detail::unfinished_name name;
};

/// Waits until the bytes of a file are on the disk: a name that is there after the machine stopped is of all
/// of the file.
void require_on_disk(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::error_code problem(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  if (!done) cannot_write(file, problem);
}

/// Removes what compilers left that were killed: none takes a day.
void remove_left_parts(const fs::path& folder) {
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    std::error_code ignored;
    const auto made = at->last_write_time(ignored);
    if (!ignored && at->path().extension() == ".part" && made < yesterday) fs::remove(at->path(), ignored);
  }
}

void compile(const fs::path& source, const std::string& identity, const fs::path& library,
             const recipe& how) {
  const std::string unique = fmt::format("{}.{}", library.string(), ::getpid());
  remove_left_parts(library.parent_path());
  const temporary made{unique + ".part"};
  std::vector<std::string> command = how.before;
  for (const char* flag :
       {"-shared", "-fPIC", "-fvisibility=hidden", "-fvisibility-inlines-hidden", "-x", "c++"}) {
    command.emplace_back(flag);
  }
  command.push_back(fmt::format("-DNYSALT_PLUGIN_SOURCE=\"{}\"", identity));
  command.push_back(fs::absolute(source).string());
  for (const char* flag : {"-x", "none", "-Wl,--as-needed", "-Wl,-z,defs", "-Wl,--exclude-libs,ALL", "-o"}) {
    command.emplace_back(flag);
  }
  command.push_back(made.path.string());
  command.insert(command.end(), how.libraries.begin(), how.libraries.end());
  progress shown;
  shown.part(fmt::format("compiling {}", source.filename().string()));
  const child_result compiler = run_child(command, {}, error_output::kept);
  if (!compiler.code || *compiler.code == 127)
    refuse("cannot compile {}: the compiler {} cannot be started; install it", source.string(),
           command.front());
  if (!compiler.succeeded()) {
    if (compiler.output.find("No space left on device") != std::string::npos)
      cannot_write(library, std::make_error_code(std::errc::no_space_on_device));
    refuse("cannot compile {}: {}", source.string(), first_error(compiler.output));
  }
  require_on_disk(made.path);
  std::error_code problem;
  fs::rename(made.path, library, problem);
  if (problem) cannot_write(library, problem);
}

}  // namespace

bool is_source(std::string_view path) { return path.ends_with(".hpp"); }

fs::path compiled(const fs::path& source) {
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored))
    refuse("cannot compile {}: there is no such file; name a source of a system", source.string());
  const recipe how = recipe_of_library();
  std::string all = detail::plugin_stamp() + '\n';
  for (const auto& flag : how.before) all += flag + '\n';
  for (const auto& library : how.libraries) {  // another build of the library may be another library
    const auto when = fs::last_write_time(library, ignored).time_since_epoch().count();
    all += fmt::format("{} {}\n", library, when);
  }
  std::set<fs::path> seen;
  std::string sources;
  append_sources(source, seen, sources);
  fs::path library = cache_folder() / (name_of(all + sources) + ".so");
  if (!fs::is_regular_file(library, ignored)) compile(source, name_of(sources), library, how);
  return library;
}

fs::path kept_source(const std::string& text) {
  fs::path file = cache_folder() / (name_of(text) + ".hpp");
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored) || text_of_file(file) != text) write_file(file, text);
  return file;
}

std::string library_of(const std::string& source, const std::string& output) {
  if (!is_source(source)) refuse("{}: a source must end in .hpp", source);
  fs::path to = output.empty() ? fs::path(source).stem() += ".so" : fs::path(output);
  if (to.extension() != ".so") refuse("--output must end in .so, got {}", to.string());
  if (!to.has_parent_path()) to = "." / to;
  return to.string();
}

std::string build_library(const std::string& source, const std::string& output) {
  std::string to = library_of(source, output);
  if (const auto why = nysalt::detail::objection_to_replacing(to); !why.empty())
    refuse("cannot write {}: {}", to, why);
  std::error_code ignored;
  if (fs::equivalent(source, to, ignored))
    refuse("cannot write {}: it was read as input; name another file", to);
  require_plugin(source);
  const fs::path library = compiled(source);
  const auto text = text_of_file(library);
  if (!text) refuse("cannot read {}: it was removed meanwhile; build again", library.string());
  write_file(to, *text);
  return to;
}

}  // namespace nysalt::program
