// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// Several steps of a method with an equal part of the step each, as one method: the first coefficient of a
/// letter goes with h, the second of gradient kicks with h^3, that of displaced kicks with h^2. Throws
/// std::invalid_argument unless there is at least one step, or, of several steps, if the word has letters O
/// or a processor.
inline tabulated repeated(const tabulated& method, int times) {
  const run_time_word& word = method.letters();
  if (times == 1) return method;
  if (times < 1 || word.stochastic_letters > 0 || word.is_processed()) {
    throw std::invalid_argument(
        sentence("repeated: the number of steps must be at least 1 and the word without letters O and "
                 "processor, got {} steps of {}; place the letters O afterwards",
                 times, word.letters()));
  }
  const double part = 1.0 / times;
  std::string letters;
  std::vector<double> coefficients;
  const std::vector<double> of_one = method.coefficients();
  const auto part_of_second = [&](char letter) {
    return letter == displaced_kick::letter ? part * part : part * part * part;
  };
  for (int n = 0; n < times; ++n) {
    letters += word.letters();
    for (std::size_t i = 0; i < word.length; ++i) {
      for (std::size_t k = 0; k < word.slots_of(i); ++k) {
        coefficients.push_back(of_one[word.first_slot(i) + k] *
                               (k == 0 ? part : part_of_second(word.letters()[i])));
      }
    }
  }
  return {std::to_string(times) + " x " + method.name(), word.with_letters(letters), coefficients, method};
}

}  // namespace nysalt
