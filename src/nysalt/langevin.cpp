// SPDX-License-Identifier: BSL-1.0
#include "nysalt/langevin.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <string>

namespace nysalt {

word thermostatted(const word& letters, placement where) {
  const std::string text = letters.letters();
  if (letters.stochastic_letters > 0) {
    throw std::invalid_argument(fmt::format("thermostat: the word must have no letters O, got {}", text));
  }
  if (letters.is_processed()) {
    throw std::invalid_argument(
        fmt::format("thermostat: the word in a bath must have no processor, got {}; take one without, as a "
                    "kernel that is made for a processor gives modes another temperature",
                    text));
  }
  const std::string o(1, detail::bath_letter);
  if (where == placement::end) return letters.with_letters(text + o);
  if (where == placement::symmetric) return letters.with_letters(o + text + o);
  if (text.size() % 2 == 0) {
    throw std::invalid_argument(fmt::format(
        "thermostat: the word must have a central letter to split, got {}; place O at the end, or "
        "symmetric",
        text));
  }
  const std::size_t central = text.size() / 2;
  return letters.with_letters(text.substr(0, central + 1) + o + text.substr(central));
}

detail::noise_intervals detail::intervals_of_noise(const word& letters,
                                                   const std::vector<double>& coefficients) {
  std::vector<double> of_bath;
  for (std::size_t i = 0; i < letters.length; ++i) {
    if (letters.letter(i) == detail::bath_letter) of_bath.push_back(coefficients[letters.first_slot(i)]);
  }
  return detail::intervals_of_noise(letters.letters(), of_bath);
}

}  // namespace nysalt
