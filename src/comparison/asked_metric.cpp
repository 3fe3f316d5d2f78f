// SPDX-License-Identifier: BSL-1.0
#include "asked_metric.hpp"

#include <algorithm>
#include <vector>

#include "did_you_mean.hpp"
#include "purpose.hpp"
#include "refusal.hpp"

namespace nysalt::program {

asked_metric metric_named(std::string_view text, const std::string& otherwise) {
  static const std::vector<std::string> known{"path",   "relative",   "state",        "exchange",
                                              "energy", "acceptance", "distribution", "acf"};
  const auto colon = text.find(':');
  asked_metric asked{.name = std::string(text.substr(0, colon))};
  if (std::ranges::count(known, asked.name) == 0) {
    refuse("unknown metric '{}': {}", asked.name, did_you_mean(asked.name, known));
  }
  if (colon == std::string_view::npos) {
    if (asked.takes_observable()) asked.observable = otherwise;
    return asked;
  }
  asked.observable = text.substr(colon + 1);
  if (!asked.takes_observable()) {
    refuse_value("metric", "must be path, relative, distribution or acf to have an observable, got {}", text);
  }
  if (asked.observable.empty())
    refuse_value("metric", "must have an observable after the colon, got {}", text);
  return asked;
}

bool asked_metric::sees_phases() const {
  if (name == "state") return true;
  const bool is_coordinate = 1 < observable.size() && (observable[0] == 'q' || observable[0] == 'p') &&
                             observable.find_first_not_of("0123456789", 1) == std::string::npos;
  return (name == "path" || name == "relative") && is_coordinate;
}

std::string advice_on_purpose(std::span<const asked_metric> metrics, const std::string& purpose) {
  if (purpose != for_state || std::ranges::any_of(metrics, &asked_metric::sees_phases)) return {};
  return fmt::format(
      "what is measured does not see the phases of the state, which methods are learned for: {} leaves these "
      "out",
      spelled("purpose", "energy"));
}

}  // namespace nysalt::program
