// SPDX-License-Identifier: BSL-1.0
// Which loss to learn with.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>

namespace nysalt {

/// state       the state's error after K steps; K = 1 is the paper's loss, and the default
/// energy      the energy's error after K steps
/// covariance  of a thermostatted word, that of its stationary covariance: no data are asked
struct loss_choice {
  /// Of the state, of the energy, or of the stationary covariance.
  enum class kind { state, energy, covariance };
  kind of = kind::state;  ///< what the loss is of
  int steps = 1;          ///< K; of no account for a covariance

  friend bool operator==(const loss_choice&, const loss_choice&) = default;  ///< equal in both

  /// The text that loss_named() reads, such as "state:1".
  std::string description() const {
    if (of == kind::covariance) return "covariance";
    return fmt::format("{}:{}", of == kind::state ? "state" : "energy", steps);
  }
};

/// "state:5", "energy:10", "covariance"; K is 1 where it is not said. Throws std::invalid_argument for
/// anything else.
inline loss_choice loss_named(std::string_view text) {
  if (text == "covariance") return {loss_choice::kind::covariance, 1};
  const std::string_view name = text.substr(0, text.find(':'));
  loss_choice result{name == "energy" ? loss_choice::kind::energy : loss_choice::kind::state, 1};
  bool is_known = name == "state" || name == "energy";
  if (is_known && name.size() < text.size()) {
    const std::string_view number = text.substr(name.size() + 1);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), result.steps);
    is_known = error == std::errc() && end == number.data() + number.size() && result.steps >= 1 &&
               number.front() != '0';
  }
  if (is_known) return result;
  throw std::invalid_argument(fmt::format(
      "unknown loss '{}': it is one of state:K, energy:K with the number K of steps, and covariance", text));
}

}  // namespace nysalt
