// SPDX-License-Identifier: BSL-1.0
// Efficiency against ranks: as measured beside the model, and as the model goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "../../../src/report/figure.hpp"
#include "jobs.hpp"
#include "tables.hpp"

namespace nysalt::bench {

inline panel panel_of_efficiencies(const std::string& title) {
  panel result;
  result.title = title;
  result.x_label = "ranks";
  result.log_log = true;
  result.linear_y = true;
  result.y_label = "efficiency";
  result.y_range = "[0:1.1]";
  return result;
}

inline panel measured_panel(const measured& all, const fitted& model) {
  panel result = panel_of_efficiencies("Measured, and the model (dashed)");
  result.x_label = "ranks: 1, 2, 4, ... and all of the machine";
  for (const std::string what : {"BAOAB", "pass"}) {
    for (const std::string scaling : {"strong", "weak"}) {
      curve points{.label = fmt::format("{}, {}", what, scaling), .x = {1.0}, .y = {1.0}, .error = {0.0}};
      curve line{.label = "", .x = {1.0}, .y = {1.0}, .dashed = true};
      line.label = fmt::format("{}, model", points.label);
      const double alone = model.seconds(all.find(what, "strong", 1, 1));
      for (const series& work : all.of(what)) {
        if (work.scaling != scaling || work.threads > 1 || work.ranks == 1) continue;
        const ratio e = efficiency_of(all, work);
        points.x.push_back(work.ranks);
        points.y.push_back(e.value);
        points.error.push_back(0.5 * (e.high - e.low));
        line.x.push_back(work.ranks);
        line.y.push_back(alone / model.seconds(work) / (scaling == "strong" ? work.ranks : 1.0));
      }
      result.curves.push_back(points);
      if (scaling == "strong") result.curves.push_back(line);
    }
  }
  return result;
}

inline panel foretold_panel(const foretold& on) {
  panel result = panel_of_efficiencies("Foretold, at fixed trajectories");
  const auto add = [&](const std::string& label, const std::function<double(std::int64_t)>& seconds) {
    curve line{.label = label, .x = {}, .y = {}};
    for (std::int64_t ranks = 1; ranks <= 1'048'576; ranks *= 2) {
      line.x.push_back(static_cast<double>(ranks));
      line.y.push_back(efficiency(seconds, ranks));
    }
    result.curves.push_back(line);
  };
  constexpr std::int64_t n = steps_of_learning;
  constexpr std::int64_t most = trajectories_of_jobs;
  add("10^6, learn()", [&](std::int64_t r) { return on.learning(1'000'000, n, r); });
  add("10^6, pass", [&](std::int64_t r) { return on.pass(1'000'000, n, r); });
  add("10^9, learn()", [&](std::int64_t r) { return on.learning(most, n, r); });
  add("10^9, pass", [&](std::int64_t r) { return on.pass(most, n, r); });
  add("10^9, BAOAB", [&](std::int64_t r) { return on.run(most, steps_of_run, looks_of_run, r); });
  return result;
}

inline figure picture(const measured& all, const fitted& model, const foretold& on) {
  return {.name = "scaling",
          .panels = {measured_panel(all, model), foretold_panel(on)},
          .width = 1200,
          .height = 560};
}

}  // namespace nysalt::bench
