// SPDX-License-Identifier: BSL-1.0
#include "manifest.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ceres/version.h>
#include <Eigen/Core>
#include <array>
#include <boost/version.hpp>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "build_info.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"
#include "write_file.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

constexpr const char* name_of_manifest = "manifest.json";
constexpr const char* format_of_manifest = "nysalt manifest";
constexpr int version_of_manifest = 1;
constexpr std::array kinds_of_pictures{".svg", ".png", ".gp", ".dat"};

std::string is_foreign(const fs::path& manifest) {
  errno = 0;
  if (fs::is_regular_file(manifest) && !std::ifstream(manifest)) {
    return fmt::format("{} cannot be read ({})", manifest.string(), std::generic_category().message(errno));
  }
  return fmt::format("{} is no manifest of this version of nysalt, or too large to be read",
                     manifest.string());
}

/// The manifest for writing, when no other process writes it.
std::unique_ptr<atomic_file> locked(const fs::path& manifest, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds between_attempts(5);
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    try {
      return std::make_unique<atomic_file>(manifest);
    } catch (const nysalt::detail::file_in_use&) {
      if (std::chrono::steady_clock::now() > end) throw;
    }
    std::this_thread::sleep_for(between_attempts);
  }
}

/// The name of a file as JSON holds it.
std::string name_in(const fs::path& file) { return as_kept(file.filename().string()).get<std::string>(); }

/// Whether an earlier version recorded how it made the file.
bool has_earlier_manifest(const fs::path& file) {
  const fs::path earlier = earlier_manifest_of(file);
  if (!is_there(earlier)) return false;
  const json found = document_in(earlier);
  return found.is_object() && found.contains("options") && found.contains("versions") &&
         found.value("file", json()) == name_in(file);
}

void remove_unless_input(const fs::path& file) {
  std::error_code ignored;
  if (!is_input(file)) fs::remove(file, ignored);
}

/// What an earlier version recorded of the file that was there before would contradict the new entry.
void remove_earlier(const fs::path& file) {
  if (has_earlier_manifest(file)) remove_unless_input(earlier_manifest_of(file));
}

json entry_for(const common_settings& common) {
  return {{"command", common.command},
          {"options", common.options},
          {"seed", common.seed},
          {"versions", versions()},
          {"compiler", compiler},
          {"flags", compiler_flags},
          {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
}

/// The entries that are there are read only once no other process can change them.
void add_entries(const fs::path& manifest, const std::vector<fs::path>& files, const json& entry,
                 std::chrono::milliseconds patience) {
  const auto file = locked(manifest, patience);
  json all{{"format", format_of_manifest}, {"version", version_of_manifest}, {"files", json::object()}};
  if (is_there(manifest)) {
    all["files"] = entries_in(manifest);
    if (all["files"].is_null()) throw std::runtime_error(is_foreign(manifest));
  }
  for (const auto& path : files) {
    json whole{{"file", name_in(path)}};
    whole.update(entry);
    all["files"][name_in(path)] = whole;
  }
  file->write(program::text_of(all));
  file->commit(true);
}

}  // namespace

fs::path manifest_of(const fs::path& file) { return file.parent_path() / name_of_manifest; }

fs::path earlier_manifest_of(fs::path file) { return file += ".manifest.json"; }

json entries_in(const fs::path& manifest) {
  json found = document_in(manifest);
  if (!found.is_object() || found.value("format", json()) != format_of_manifest) return {};
  if (found.value("version", json()) != version_of_manifest) return {};
  const auto files = found.find("files");
  return files != found.end() && files->is_object() ? std::move(*files) : json();
}

void require_manifest(const fs::path& file) {
  const fs::path manifest = manifest_of(file);
  const fs::path name = nysalt::detail::behind_links(file).filename();
  if (name == name_of_manifest || name == std::string(name_of_manifest) + ".new.part") {
    refuse("cannot write {}: the folder's record of how its files were made has that name; take another",
           file.string());
  }
  std::error_code ignored;
  if (fs::is_directory(manifest, ignored)) {
    refuse(
        "cannot write {}: it is a folder, and a record of how {} is made goes there; name a file elsewhere",
        manifest.string(), file.string());
  }
  require_replaceable(manifest);
  const fs::path folder = nysalt::detail::behind_links(manifest).parent_path();
  if (fs::is_symlink(manifest, ignored) && !folder.empty() && !fs::is_directory(folder, ignored))
    refuse("cannot write {}: it leads to {}, where there is no folder; remove it", manifest.string(),
           folder.string());
  if (!is_there(manifest)) return;
  if (entries_in(manifest).is_null()) {
    refuse(
        "cannot write {}: {}, where a record of how the file is made would go; name a file in another folder",
        file.string(), is_foreign(manifest));
  }
}

json versions() {
  const auto eigen = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  const auto boost =
      fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
  const auto of_fmt =
      fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
  return {{"nysalt", version},
          {"Eigen", eigen},
          {"Boost", boost},
          {"Ceres", CERES_VERSION_STRING},
          {"fmt", of_fmt}};
}

void record_results(const std::vector<fs::path>& files, const common_settings& common, const json& more,
                    std::chrono::milliseconds patience) {
  if (common.command.empty() || files.empty()) return;
  const fs::path manifest = manifest_of(files.front());
  require_no_input(manifest);
  json entry = entry_for(common);
  if (!more.is_null()) entry.update(more);
  try {
    add_entries(manifest, files, entry, patience);
  } catch (const std::runtime_error& problem) {
    const std::string others =
        files.size() == 1 ? ", which is" : fmt::format(" and {} more, which are", files.size() - 1);
    throw nysalt::detail::write_failure(message("cannot write the manifest of {}{} whole: {}",
                                                files.front().string(), others, problem.what()));
  }
  for (const auto& path : files) remove_earlier(path);
}

void write_unrecorded(const fs::path& file, std::string_view text) {
  require_no_input(file);
  write_file(file, text);
}

void write_result(const fs::path& file, std::string_view text, const common_settings& common) {
  write_unrecorded(file, text);
  record_results({file}, common);
}

std::vector<fs::path> files_of_picture(const std::string& name, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* kind : kinds_of_pictures) files.push_back(folder / (name + kind));
  return files;
}

void require_picture(const std::string& name, const fs::path& folder) {
  for (const auto& file : files_of_picture(name, folder)) require_replaceable(file);
}

void require_pictures(const fs::path& folder) {
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure)) {
    const std::string name = at->path().filename().string();
    for (const char* kind : kinds_of_pictures) {
      const auto dot = name.rfind(kind);
      if (dot != std::string::npos) require_picture(name.substr(0, dot), folder);
    }
  }
}

void remove_earlier_pictures(const figure& picture, const fs::path& folder) {
  for (const fs::path& file : files_of_picture(picture.name, folder)) {
    if (!has_earlier_manifest(file)) continue;
    remove_unless_input(file);
    remove_unless_input(earlier_manifest_of(file));
  }
}

std::string write_pictures(const figure& picture, const fs::path& folder, const common_settings& common) {
  require_picture(picture.name, folder);
  if (!draw(picture, folder)) {
    return fmt::format(
        "gnuplot could not draw {}, and may not be installed; the script and the data are there",
        picture.name);
  }
  record_results(files_of_picture(picture.name, folder), common);
  return {};
}

}  // namespace nysalt::program
