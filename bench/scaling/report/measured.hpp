// SPDX-License-Identifier: BSL-1.0
// The lines that nysalt_scaling printed, by what they measure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "../../ratios/verdict.hpp"

namespace nysalt::bench {

/// Rounds of one piece of work. Round i of all pieces of the same `what` was made at about the same time.
struct series {
  std::string what;
  std::string scaling;
  int ranks = 1;
  int threads = 1;
  std::int64_t trajectories = 0;
  std::int64_t steps = 0;
  std::int64_t largest_share = 0;
  samples seconds{};

  double middle() const { return median(seconds); }
  double largest_pairs() const { return static_cast<double>(largest_share * steps); }
};

struct sums {
  int ranks;
  int cores;
  int doubles;
  samples seconds{};     // medians of thousands
  samples seconds_90{};  // 90 % of these were shorter

  bool has_cores() const { return ranks <= cores; }
};

struct memory_of_rank {
  int ranks;
  std::int64_t trajectories;  // of all ranks
  std::int64_t steps;
  std::int64_t share;  // trajectories
  double bytes;
};

struct written {
  samples seconds{};  // a row
  double bytes = 0.0;
};

struct measured {
  std::vector<series> times{};
  std::vector<sums> reductions{};
  std::vector<memory_of_rank> memory{};
  std::map<std::string, written> rows{};  // of text, of bytes

  std::vector<series> of(const std::string& what) const {
    std::vector<series> result;
    for (const series& one : times) {
      if (one.what == what) result.push_back(one);
    }
    return result;
  }
  /// Throws std::runtime_error if it is not there.
  const series& find(const std::string& what, const std::string& scaling, int ranks, int threads) const {
    for (const series& one : times) {
      if (one.what == what && one.scaling == scaling && one.ranks == ranks && one.threads == threads)
        return one;
    }
    throw std::runtime_error(
        fmt::format("{} on {} ranks was not measured: run ./dev scaling on two cores or more", what, ranks));
  }
};

namespace detail {

template <class T>
T& found_or_new(std::vector<T>& all, const T& wanted, const std::function<bool(const T&)>& is_it) {
  for (T& one : all) {
    if (is_it(one)) return one;
  }
  all.push_back(wanted);
  return all.back();
}

inline void add_times(const nlohmann::json& row, measured& result) {
  const series work{row.at("what"),         row.at("scaling"), row.at("ranks"),        row.at("threads"),
                    row.at("trajectories"), row.at("steps"),   row.at("largest_share")};
  auto& known = found_or_new<series>(result.times, work, [&](const series& one) {
    return one.what == work.what && one.scaling == work.scaling && one.ranks == work.ranks &&
           one.threads == work.threads && one.trajectories == work.trajectories && one.steps == work.steps;
  });
  known.seconds.push_back(row.at("seconds"));
}

inline void add_row(const nlohmann::json& row, measured& result) {
  const std::string what = row.at("what");
  if (what == "reduction") {
    const sums reduction{row.at("ranks"), row.at("cores"), row.at("doubles")};
    auto& known = found_or_new<sums>(result.reductions, reduction, [&](const sums& one) {
      return one.ranks == reduction.ranks && one.doubles == reduction.doubles;
    });
    known.seconds.push_back(row.at("seconds"));
    known.seconds_90.push_back(row.at("seconds_90"));
  } else if (what == "memory") {
    result.memory.push_back(
        {row.at("ranks"), row.at("trajectories"), row.at("steps"), row.at("share"), row.at("bytes")});
  } else if (what.starts_with("row of ")) {
    result.rows[what].seconds.push_back(row.at("seconds"));
    result.rows[what].bytes = row.at("bytes");
  } else {
    add_times(row, result);
  }
}

}  // namespace detail

/// All *.jsonl of the folder. Throws std::runtime_error if there is none, or one holds something else.
inline measured read_measured(const std::filesystem::path& folder) {
  measured result;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".jsonl") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      try {
        detail::add_row(nlohmann::json::parse(line), result);
      } catch (const nlohmann::json::exception& problem) {
        throw std::runtime_error(fmt::format("{}: {}", entry.path().string(), problem.what()));
      }
    }
  }
  if (result.times.empty()) {
    throw std::runtime_error(fmt::format("no times in {}: run ./dev scaling", folder.string()));
  }
  return result;
}

}  // namespace nysalt::bench
