// SPDX-License-Identifier: BSL-1.0
#include "composition.hpp"

#include <cmath>
#include <limits>

#include "refuse.hpp"

namespace nysalt::detail {

namespace {

/// Coefficients of schemes are sums, whose rounding differs.
bool is_equal(double a, double b) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::abs(a - b) <= rounding;
}

}  // namespace

exported_letters composition_in_bath_of(const exported_method& method, const std::string& host) {
  const exported_letters all = kernel_of(method);
  if (method.method.letters().is_processed()) {
    refuse_export(
        "export: the method for {} must be a list of letters, got {} with a processor; export to c, cpp, "
        "fortran, python or julia, or take the method without the processor",
        host, method.method.name());
  }
  if (all.count('D') > 0) {
    refuse_export(
        "export: the method for {} must be drifts and kicks, got {} with a displaced kick; take a method of "
        "the letters A and B (nysalt list)",
        host, method.method.name());
  }
  exported_letters result;
  for (std::size_t i = 0; i < all.letters.size(); ++i) {
    if (all.coefficients[i] == 0.0) continue;
    const bool joins = !result.letters.empty() && result.letters.back() == all.letters[i];
    if (joins && all.letters[i] != 'O') {
      result.coefficients.back() += all.coefficients[i];
    } else {
      result.letters += all.letters[i];
      result.coefficients.push_back(all.coefficients[i]);
    }
  }
  return result;
}

exported_letters composition_of(const exported_method& method, const std::string& host) {
  if (has_bath(method)) {
    refuse_export(
        "export: the method for {} must be drifts and kicks, got {} with letters O, of a bath; take the "
        "method without a bath, or export to c, cpp, fortran, python, julia, jax, ase, openmm or lammps",
        host, method.method.name());
  }
  return composition_in_bath_of(method, host);
}

bool is_palindrome(const exported_letters& word) {
  const std::size_t n = word.letters.size();
  for (std::size_t i = 0; i < n / 2; ++i) {
    if (word.letters[i] != word.letters[n - 1 - i]) return false;
    if (!is_equal(word.coefficients[i], word.coefficients[n - 1 - i])) return false;
  }
  return n % 2 == 1;
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

double two_stage_lambda(const exported_method& method, const std::string& host) {
  const exported_letters word = composition_of(method, host);
  const auto& c = word.coefficients;
  if (word.letters != "BABAB" || !is_palindrome(word) || !is_equal(c[1], 0.5) ||
      !is_equal(2.0 * c[0] + c[2], 1.0)) {
    refuse_export(
        "export: the method for {} must be B(lambda) A(1/2) B(1 - 2 lambda) A(1/2) B(lambda), given by one "
        "number, lambda, got {} with the letters {}; learn bab2, or take mclachlan2v or bcss2v",
        host, method.method.name(), word.letters);
  }
  return c[0];
}

}  // namespace nysalt::detail
