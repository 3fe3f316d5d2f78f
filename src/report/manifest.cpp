// SPDX-License-Identifier: BSL-1.0
#include "manifest.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ceres/version.h>
#include <Eigen/Core>
#include <boost/version.hpp>
#include <ctime>

#include "build_info.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/detail/write_failure.hpp"
#include "write_file.hpp"

namespace nysalt::program {

std::filesystem::path manifest_of(std::filesystem::path file) { return file += ".manifest.json"; }

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

void write_manifest(const std::filesystem::path& file, const common_settings& common, const json& more) {
  if (common.command.empty()) return;
  json manifest{{"file", file.filename().string()},
                {"command", common.command},
                {"options", common.options},
                {"seed", common.seed},
                {"versions", versions()},
                {"compiler", compiler},
                {"flags", compiler_flags},
                {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))}};
  if (!more.is_null()) manifest.update(more);
  require_no_input(manifest_of(file));
  try {
    write_file(manifest_of(file), text_of(manifest));
  } catch (const std::runtime_error& problem) {
    throw nysalt::detail::write_failure(
        message("{} is whole, but not the manifest: {}", file.string(), problem.what()));
  }
}

void write_result(const std::filesystem::path& file, std::string_view text, const common_settings& common) {
  require_no_input(file);
  write_file(file, text);
  write_manifest(file, common);
}

std::string write_pictures(const figure& picture, const std::filesystem::path& folder,
                           const common_settings& common) {
  if (!draw(picture, folder)) {
    return fmt::format("gnuplot could not draw {}: is it installed? The script and the data are there",
                       picture.name);
  }
  for (const char* kind : {".svg", ".png", ".gp", ".dat"})
    write_manifest(folder / (picture.name + kind), common);
  return {};
}

}  // namespace nysalt::program
