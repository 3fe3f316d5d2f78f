// SPDX-License-Identifier: BSL-1.0
#include "spelling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>

namespace nysalt::program {

namespace {

constexpr spelling in_cpp{.prefix = "",
                          .between_words = '_',
                          .learning = "learning.",
                          .renamed = [](std::string_view field) { return field; },
                          .equals = " = ",
                          .switched_on = " = true",
                          .quote = "\"",
                          .separator = ", ",
                          .learn = "learn(system, ",
                          .learned = ")"};
std::atomic<const spelling*> current = &in_cpp;

std::string with_value(std::string_view field, const std::string& value) {
  return spelled(field) + current.load()->equals + value;
}

}  // namespace

void spell(const spelling& surface) { current = &surface; }

std::string spelled(std::string_view field) {
  const spelling& surface = *current;
  constexpr std::string_view learning = "learning.";
  std::string name(surface.renamed(field));
  if (name.starts_with(learning)) name.replace(0, learning.size(), surface.learning);
  std::ranges::replace(name, '_', surface.between_words);
  return surface.prefix + name;
}

std::string spelled(std::string_view field, std::string_view text) {
  return with_value(field, fmt::format("{0}{1}{0}", current.load()->quote, text));
}

std::string spelled(std::string_view field, double number) {
  return with_value(field, fmt::format("{:.12g}", number));
}

std::string switched_on(std::string_view field) { return spelled(field) + current.load()->switched_on; }

std::string spelled_together(const std::vector<std::string>& settings) {
  return fmt::format("{}", fmt::join(settings, current.load()->separator));
}

std::string spelled_learning(const std::string& family, std::string_view placement,
                             std::optional<double> step) {
  std::vector<std::string> settings{spelled("family", family)};
  if (!placement.empty()) settings.push_back(spelled("placement", placement));
  settings.push_back(step ? spelled("step", *step) : with_value("step", "STEP"));
  return current.load()->learn + spelled_together(settings) + current.load()->learned;
}

}  // namespace nysalt::program
