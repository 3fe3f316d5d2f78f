// SPDX-License-Identifier: BSL-1.0
// What google-benchmark wrote of the races of one build.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace nysalt::bench {

/// Nanoseconds for a unit of work, one for each round; the rounds of a race are the same for all its runners.
using samples = std::vector<double>;

struct measurements {
  std::map<std::string, std::map<std::string, samples>> races;
  std::map<std::string, std::string> failures;  // what a race said that could not go on
  nlohmann::json context;

  bool has(const std::string& race, const std::string& runner) const {
    const auto found = races.find(race);
    return found != races.end() && found->second.contains(runner);
  }
  /// Throws std::runtime_error if nobody of that name ran.
  const samples& of(const std::string& race, const std::string& runner) const {
    if (has(race, runner)) return races.at(race).at(runner);
    if (failures.contains(race)) {
      throw std::runtime_error(fmt::format("the race '{}' failed: {}", race, failures.at(race)));
    }
    throw std::runtime_error(fmt::format("nobody called '{}' was measured in the race '{}'", runner, race));
  }
};

/// The numbers in the middle: the mean of two if they are even in number.
inline double median(samples x) {
  std::sort(x.begin(), x.end());
  return 0.5 * (x[(x.size() - 1) / 2] + x[x.size() / 2]);
}

/// Adds a document: one round is one repetition, with a counter "ns/RUNNER" for each. Throws
/// std::runtime_error if that is not what is there.
inline void read_measurements(const nlohmann::json& document, measurements& result) {
  const auto refuse = [](const std::string& why) {
    throw std::runtime_error("not what the races write: " + why);
  };
  if (!document.is_object() || !document.contains("benchmarks")) refuse("no benchmarks");
  result.context = document.value("context", nlohmann::json::object());
  for (const auto& round : document["benchmarks"]) {
    if (round.value("run_type", "iteration") != "iteration") continue;  // means and medians of theirs
    const std::string name = round.value("name", "");
    const std::string race_name = name.substr(0, name.find('/'));
    if (round.value("error_occurred", false)) {
      result.failures[race_name] = round.value("error_message", "no reason given");
      continue;
    }
    auto& race = result.races[race_name];
    for (const auto& [key, value] : round.items()) {
      if (key.rfind("ns/", 0) != 0) continue;
      if (!value.is_number() || !(value.get<double>() > 0.0) || !std::isfinite(value.get<double>())) {
        refuse(fmt::format("{} of {} is no time", key, name));
      }
      race[key.substr(3)].push_back(value.get<double>());
    }
  }
  for (const auto& [race, runners] : result.races) {
    if (runners.empty()) refuse(fmt::format("nobody ran in {}", race));
    for (const auto& [runner, times] : runners) {
      if (times.size() != runners.begin()->second.size()) {
        refuse(fmt::format("{} missed a round of {}", runner, race));
      }
    }
  }
}

/// All NAME.*.json of the folder: one for each time that the program was run. Throws std::runtime_error if
/// there is none, or if one cannot be read or is something else.
inline measurements read_measurements_of(const std::filesystem::path& folder, const std::string& name) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename();
    if (file.rfind(name + ".", 0) == 0 && file.ends_with(".json")) paths.push_back(entry.path());
  }
  if (paths.empty()) {
    throw std::runtime_error(fmt::format("no {}.*.json in {}: run ./dev bench", name, folder.string()));
  }
  std::sort(paths.begin(), paths.end());
  measurements result;
  for (const auto& path : paths) {
    std::ifstream file(path);
    const auto document = nlohmann::json::parse(file, nullptr, false);
    if (document.is_discarded()) throw std::runtime_error(path.string() + " holds no JSON document");
    read_measurements(document, result);
  }
  return result;
}

}  // namespace nysalt::bench
