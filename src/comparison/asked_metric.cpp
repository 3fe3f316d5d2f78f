// SPDX-License-Identifier: BSL-1.0
#include "asked_metric.hpp"

#include <algorithm>
#include <vector>

#include "did_you_mean.hpp"
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
    refuse("--metric {}: {} is of no observable; path, relative, distribution and acf are", text, asked.name);
  }
  if (asked.observable.empty()) refuse("--metric {}: name an observable after the colon", text);
  return asked;
}

}  // namespace nysalt::program
