// SPDX-License-Identifier: BSL-1.0
// A loss as text, and from it.
#include "nysalt/losses/loss_choice.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

namespace nysalt {

namespace {

/// The number K of steps, of decimal digits only; nothing for any other text.
std::optional<int> steps_in(std::string_view text) {
  int steps = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), steps);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || steps < 1 || text.front() == '0') return std::nullopt;
  return steps;
}

}  // namespace

std::string loss_choice::description() const {
  return kind->counts_steps ? fmt::format("{}:{}", kind->name, steps) : std::string(kind->name);
}

std::optional<loss_choice> find_loss(std::string_view text) {
  const auto colon = text.find(':');
  for (const loss_kind* kind : losses()) {
    if (kind->name != text.substr(0, colon)) continue;
    if (colon == std::string_view::npos) return loss_choice{kind, 1};
    const auto steps = kind->counts_steps ? steps_in(text.substr(colon + 1)) : std::nullopt;
    if (steps) return loss_choice{kind, *steps};
  }
  return std::nullopt;
}

loss_choice usual_loss(const bath& around) { return around.acts() ? loss_named("state:1") : loss_choice{}; }

loss_choice loss_named(std::string_view text) {
  if (const auto found = find_loss(text)) return *found;
  throw std::invalid_argument(
      fmt::format("unknown loss '{}': it is one of {} with the number K of steps, and {}", text,
                  loss_patterns(true), loss_patterns(false)));
}

std::string loss_patterns(bool count_steps) {
  std::string all;
  for (const loss_kind* kind : losses()) {
    if (kind->counts_steps != count_steps) continue;
    all += fmt::format("{}{}{}", all.empty() ? "" : ", ", kind->name, count_steps ? ":K" : "");
  }
  return all;
}

}  // namespace nysalt
