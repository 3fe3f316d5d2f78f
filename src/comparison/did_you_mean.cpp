// SPDX-License-Identifier: BSL-1.0
#include "did_you_mean.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "refusal.hpp"

namespace nysalt::program {

namespace {

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// Mistakes from a to b, each a letter inserted, removed or replaced, or two neighbours exchanged; no letter
/// takes part in two (the optimal string alignment distance).
std::size_t mistakes_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t wrong = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + wrong});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view typed, const std::vector<std::string>& known) {
  constexpr std::size_t letters_a_mistake = 3;
  constexpr std::size_t longest = 100;  // a longer text is no name, and costs the square of its length
  if (typed.empty() || typed.size() > longest) return {};
  const std::string text = in_lower_case(typed);
  const std::size_t most = std::max<std::size_t>(1, text.size() / letters_a_mistake);
  std::string nearest;
  std::size_t least = most + 1;
  for (const auto& name : known) {
    const std::string known_name = in_lower_case(name);
    const bool is_beginning = text.size() >= letters_a_mistake && known_name.starts_with(text);
    const std::size_t mistakes = is_beginning && known_name != text ? 1 : mistakes_between(text, known_name);
    if (mistakes >= least || mistakes >= std::max(text.size(), known_name.size()))
      continue;  // no letter is left
    least = mistakes;
    nearest = name;
  }
  return nearest;
}

std::string did_you_mean(std::string_view typed, const std::vector<std::string>& known,
                         std::string_view otherwise) {
  constexpr std::size_t few = 12;  // names that fit on a line or two
  if (const auto name = nearest_name(typed, known); !name.empty()) return "did you mean " + name + "?";
  return known.size() <= few ? "it is one of " + listed(known) : std::string(otherwise);
}

}  // namespace nysalt::program
