// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "../../src/report/table.hpp"
#include "measurements.hpp"

namespace nysalt::bench {

/// Seconds that the heaviest run of [li_lu_tao_ye_2023] takes, and the same with learned steps.
inline nysalt::table heaviest_run(const measurements& gnu, const measurements& clang) {
  nysalt::table result({"seconds", "threads", "g++", "clang++"}, 1);
  for (const std::string run :
       {"BAOAB, step .0001", "learned, O at the end, step .019", "learned, O symmetric, step .019"}) {
    for (const std::string threads : {"one", "two"}) {
      const std::string race = fmt::format("heaviest run, {} thread{}", threads, threads == "one" ? "" : "s");
      const auto seconds = [&](const measurements& all) {
        return all.has(race, run) ? fmt::format("{:.3g}", 1e-9 * median(all.of(race, run)))
                                  : std::string("-");
      };
      result.add({run, threads, seconds(gnu), seconds(clang)});
    }
  }
  return result;
}

}  // namespace nysalt::bench
