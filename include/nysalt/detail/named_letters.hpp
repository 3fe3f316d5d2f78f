// SPDX-License-Identifier: BSL-1.0
// Letters of one's own by name: those of a system, and those that a file states.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/detail/own_letter.hpp"
#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

/// A letter of one's own, and the part of H whose time each of its coefficients is, a character for each
/// slot; empty where the letter has several and does not say.
struct named_letter {
  std::shared_ptr<const own_letter> letter;
  std::string times;
  std::string parts{};  ///< numbers of the parts whose force the letter evaluates, a digit for each
};
using named_letters = std::vector<named_letter>;

/// Those of L::times, or of a single coefficient the letter itself.
template <Flow L>
std::string times_of() {
  if constexpr (requires { std::string(L::times); }) {
    return std::string(L::times);
  } else {
    return L::slots == 1 ? std::string(1, L::letter) : std::string();
  }
}

/// Those that L::evaluations_of_part() names; none of a letter without that function.
template <Flow L>
std::string parts_of() {
  std::string parts;
  if constexpr (requires { L::evaluations_of_part(0); }) {
    for (char part = '0'; part <= '9'; ++part) {
      if (L::evaluations_of_part(static_cast<std::size_t>(part - '0')) > 0) parts.push_back(part);
    }
  }
  return parts;
}

/// What a file states of a letter of a system. A word with it can be read, and steps nothing before it has
/// the letters of the system.
class stated_letter final : public own_letter {
 public:
  stated_letter(const letter_facts& stated, std::string of_system)
      : own_letter(stated, std::move(of_system), true) {}

  prepared_own_letter<double> prepare(const double*, double) const override { refuse(); }
  prepared_own_letter<letter_slopes<double>> prepare(const letter_slopes<double>*, double) const override {
    refuse();
  }
  prepared_own_letter<letter_slopes<letter_lanes>> prepare(const letter_slopes<letter_lanes>*,
                                                           double) const override {
    refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument(
        sentence("the letter {} of {} must come with the system, got its name only; name the system",
                 facts.letter, system));
  }
};

/// Only the letters, as words take them.
inline std::vector<std::shared_ptr<const own_letter>> letters_in(const named_letters& all) {
  std::vector<std::shared_ptr<const own_letter>> result;
  for (const auto& one : all) result.push_back(one.letter);
  return result;
}

}  // namespace nysalt::detail
