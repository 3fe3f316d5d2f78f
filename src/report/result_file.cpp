// SPDX-License-Identifier: BSL-1.0
#include "result_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ceres/version.h>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/version.hpp>
#include <ctime>
#include <sstream>
#include <utility>

#include "build_info.hpp"
#include "comparison/inputs.hpp"
#include "write_file.hpp"

namespace nysalt::program {

namespace {

namespace fs = std::filesystem;

constexpr std::array kinds_of_pictures{".svg", ".png", ".gp", ".dat"};

}  // namespace

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

json written_by(const char* format) {
  json libraries = versions();
  json result{{"format", format}, {"format_version", 1}, {"nysalt", libraries["nysalt"]}};
  libraries.erase("nysalt");
  result["libraries"] = std::move(libraries);
  return result;
}

json provenance_of(const common_settings& common) {
  if (common.command.empty()) return {};
  return {{"command", common.command},
          {"options", common.options},
          {"seed", common.seed},
          {"versions", versions()},
          {"compiler", compiler},
          {"flags", compiler_flags},
          {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
}

std::string first_line_of_table(const json& made) {
  std::string line(mark_of_table);
  bool is_text = false;     // within quotes
  bool is_escaped = false;  // behind a backslash there
  for (const char c : made.dump(-1, ' ', true, json::error_handler_t::replace)) {
    // A spreadsheet takes what follows a comma for a formula if it begins so.
    const bool begins_formula = line.back() == ',' && (c == '=' || c == '+' || c == '-' || c == '@');
    if (c == '"' && !is_escaped) is_text = !is_text;
    is_escaped = is_text && c == '\\' && !is_escaped;
    if (begins_formula && is_text) {
      line += fmt::format("\\u{:04x}", c);
    } else {
      if (begins_formula) line += ' ';  // a number
      line += c;
    }
  }
  return line + '\n';
}

void write_result(const fs::path& file, std::string_view text) {
  require_no_input(file);
  write_file(file, text);
}

void write_document(const fs::path& file, json document, const common_settings& common) {
  if (json made = provenance_of(common); !made.is_null()) document["provenance"] = std::move(made);
  write_result(file, text_of(document));
}

std::string deciding_options(const std::string& options) {
  constexpr std::array others{"json", "output", "plot", "resume", "threads", "verbose"};
  std::istringstream lines(options);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const auto name = line.substr(0, line.find('=')).substr(line.find('.') + 1);
    if (std::ranges::find(others, name) == others.end()) result += line + '\n';
  }
  return result;
}

void write_table(const fs::path& file, const std::string& rows, const common_settings& common) {
  json made = provenance_of(common);
  if (made.is_null()) return write_result(file, rows);
  for (const char* differs : {"command", "time"}) made.erase(differs);
  made["options"] = deciding_options(common.options);
  write_result(file, first_line_of_table(made) + rows);
}

std::vector<fs::path> files_of_picture(const std::string& name, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* kind : kinds_of_pictures) files.push_back(folder / (name + kind));
  return files;
}

void require_picture(const std::string& name, const fs::path& folder) {
  for (const auto& file : files_of_picture(name, folder)) require_replaceable(file);
}

std::string write_pictures(const figure& picture, const fs::path& folder) {
  require_picture(picture.name, folder);
  if (!draw(picture, folder)) {
    return fmt::format(
        "gnuplot could not draw {}, and may not be installed; the script and the data are there",
        picture.name);
  }
  return {};
}

}  // namespace nysalt::program
