// SPDX-License-Identifier: BSL-1.0
#include "asked_metric.hpp"

#include "refusal.hpp"

namespace nysalt::program {

asked_metric metric_named(std::string_view text, const std::string& otherwise) {
  const auto colon = text.find(':');
  asked_metric asked{.name = std::string(text.substr(0, colon))};
  if (colon == std::string_view::npos) {
    if (asked.takes_observable()) asked.observable = otherwise;
    return asked;
  }
  asked.observable = text.substr(colon + 1);
  if (!asked.takes_observable()) {
    refuse("--metric {}: {} is of no observable; path, distribution and acf are", text, asked.name);
  }
  if (asked.observable.empty()) refuse("--metric {}: name an observable after the colon", text);
  return asked;
}

}  // namespace nysalt::program
