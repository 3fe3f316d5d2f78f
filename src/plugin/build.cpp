// SPDX-License-Identifier: BSL-1.0
#include "build.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "cache.hpp"
#include "comparison/child_process.hpp"
#include "comparison/inputs.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "dependencies.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/plugin.hpp"
#include "plugin.hpp"
#include "recipe.hpp"
#include "report/write_file.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

/// Nothing for what is no regular file, as a FIFO, whose reader waits.
std::optional<std::string> text_of_file(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Throws refusal for a source that is too large to be one, or no regular file.
void require_source(const fs::path& source) {
  constexpr std::uintmax_t most = std::uintmax_t{1} << 18U;  // bytes
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored))
    refuse("cannot compile {}: there is no such file; name a source of a system", source.string());
  if (fs::file_size(source, ignored) > most || ignored)
    refuse("{}: a source must be at most 256 kB long; put data into a file of its own", source.string());
}

/// Compiles the contents that the files have had, unless they have changed in the end.
bool compile(const fs::path& source, const dependencies& files, const std::string& contents,
             const fs::path& library, const recipe& how) {
  const cache_part made(library);
  std::vector<std::string> command = how.before;
  for (const char* flag :
       {"-shared", "-fPIC", "-fvisibility=hidden", "-fvisibility-inlines-hidden", "-x", "c++"}) {
    command.emplace_back(flag);
  }
  command.push_back(fmt::format("-DNYSALT_PLUGIN_SOURCE=\"{}\"", name_of(contents)));
  command.push_back(files.front().string());
  for (const char* flag : {"-x", "none", "-o"}) command.emplace_back(flag);
  command.push_back(made.path().string());
  command.insert(command.end(), how.libraries.begin(), how.libraries.end());
  progress shown;
  shown.part(fmt::format("compiling {}", source.filename().string()));
  const child_result compiler = run_child(command, {}, error_output::kept);
  if (!compiler.code || *compiler.code == 127)
    refuse("cannot compile {}: the compiler {} cannot be started; install it", source.string(),
           command.front());
  if (!compiler.succeeded()) {
    if (compiler.output.find("No space left on device") != std::string::npos)
      cannot_write_to_cache(library, std::make_error_code(std::errc::no_space_on_device));
    refuse("cannot compile {}: {}", source.string(), first_error(compiler.output));
  }
  if (contents_of(files) != contents) return false;
  made.keep();
  return true;
}

}  // namespace

bool is_source(std::string_view path) { return path.ends_with(".hpp"); }

fs::path compiled(const fs::path& source) {
  require_source(source);
  const recipe how = recipe_of_library();
  std::string beginning = detail::plugin_stamp() + '\n' + environment_of_compiler();
  std::error_code ignored;
  for (const auto& flag : how.before) beginning += flag + '\n';
  for (const auto& library : how.libraries) {  // another build of the library may be another library
    const auto when = fs::last_write_time(library, ignored).time_since_epoch().count();
    beginning += fmt::format("{} {}\n", library, when);
  }
  const fs::path folder = cache_folder();
  const fs::path list = folder / (name_of(beginning + contents_of({source})) + ".dependencies");
  const auto library_name = [&](const std::string& contents) {
    return name_of(beginning + contents) + ".so";
  };
  if (const auto kept = dependencies_kept_in(list, source)) {
    fs::path library = folder / kept->library;
    if (library_name(contents_of(kept->files)) == kept->library && fs::is_regular_file(library, ignored)) {
      for (const auto& file : kept->files) note_input(file);
      return library;
    }
  }
  remove_left_parts();
  constexpr int attempts = 3;  // while files are edited
  for (int i = 0; i < attempts; ++i) {
    const dependencies files = dependencies_of(source, how);
    for (const auto& file : files) note_input(file);
    const std::string contents = contents_of(files);
    fs::path library = folder / library_name(contents);
    if (!fs::is_regular_file(library, ignored) && !compile(source, files, contents, library, how)) continue;
    keep_dependencies(list, {.files = files, .library = library.filename().string()});
    return library;
  }
  refuse("cannot compile {}: it was changed while it was compiled; try again", source.string());
}

fs::path kept_source(const std::string& text) {
  fs::path file = cache_folder() / (name_of(text) + ".hpp");
  if (text_of_file(file) != text) write_to_cache(file, text);
  return file;
}

std::string library_of(const std::string& source, const std::string& output) {
  if (!is_source(source)) refuse("{}: a source must end in .hpp", source);
  fs::path to = output.empty() ? fs::path(source).stem() += ".so" : fs::path(output);
  if (to.extension() != ".so") refuse_value("output", "must end in .so, got {}", to.string());
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
  plugin_at(source);
  const fs::path library = compiled(source);
  const auto text = text_of_file(library);
  if (!text) refuse("cannot read {}: it was removed meanwhile; build again", library.string());
  write_file(to, *text);
  return to;
}

}  // namespace nysalt::program
