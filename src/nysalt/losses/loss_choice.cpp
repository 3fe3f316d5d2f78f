// SPDX-License-Identifier: BSL-1.0
// A loss as text, and from it.
#include "nysalt/losses/loss_choice.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

namespace nysalt {

std::string loss_choice::description() const {
  if (of == kind::covariance) return "covariance";
  return fmt::format("{}:{}", of == kind::state ? "state" : "energy", steps);
}

loss_choice loss_named(std::string_view text) {
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
