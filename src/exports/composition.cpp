// SPDX-License-Identifier: BSL-1.0
#include "composition.hpp"

#include <cmath>
#include <limits>

#include "comparison/refusal.hpp"
#include "fill.hpp"

namespace nysalt::program {

exported_letters composition_of(const exported_method& method, const std::string& host) {
  const exported_letters all = kernel_of(method);
  if (method.method.letters().is_processed()) {
    refuse(
        "export: {} has a processor, and {} takes a list of drifts and kicks alone: export to c, cpp, "
        "fortran, "
        "python or julia, or take the method without the processor",
        method.method.name(), host);
  }
  if (all.count('D') > 0) {
    refuse(
        "export: {} has a displaced kick, and {} takes drifts and kicks alone: take a method of the letters "
        "A and "
        "B (nysalt list)",
        method.method.name(), host);
  }
  exported_letters result;
  for (std::size_t i = 0; i < all.letters.size(); ++i) {
    if (all.coefficients[i] == 0.0) continue;
    if (!result.letters.empty() && result.letters.back() == all.letters[i]) {
      result.coefficients.back() += all.coefficients[i];
    } else {
      result.letters += all.letters[i];
      result.coefficients.push_back(all.coefficients[i]);
    }
  }
  return result;
}

bool is_palindrome(const exported_letters& word) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const std::size_t n = word.letters.size();
  for (std::size_t i = 0; i < n / 2; ++i) {
    if (word.letters[i] != word.letters[n - 1 - i]) return false;
    if (std::abs(word.coefficients[i] - word.coefficients[n - 1 - i]) > rounding) return false;
  }
  return n % 2 == 1;
}

std::vector<std::pair<std::string, std::string>> values_of_list(const exported_method& method,
                                                                const std::vector<double>& list) {
  return {{"NAME", method.name},
          {"HEADER", header(method, "#")},
          {"LIST", digits(list)},
          {"Q", digits(self_test_of(method).q)},
          {"P", digits(self_test_of(method).p)}};
}

std::pair<std::vector<double>, std::vector<double>> in_stages(const exported_letters& word, char first) {
  std::vector<double> firsts, seconds;
  for (std::size_t i = 0; i < word.letters.size(); ++i) {
    const bool is_first = word.letters[i] == first;
    if (is_first || i == 0) {
      firsts.push_back(0.0);
      seconds.push_back(0.0);
    }
    (is_first ? firsts : seconds).back() = word.coefficients[i];
  }
  return {firsts, seconds};
}

}  // namespace nysalt::program
