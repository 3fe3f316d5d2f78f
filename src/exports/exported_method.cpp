// SPDX-License-Identifier: BSL-1.0
#include "exported_method.hpp"

#include <algorithm>

#include "comparison/refusal.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::program {

namespace {

/// The system of the self-tests.
struct pinned_oscillators {
  static constexpr int dimension = 2;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5 + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] * (1.0 / 3.0);
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = -q[0] - q[0] * q[1] * 2.0;
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  }
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.5; }
};

exported_letters with_letters(std::string letters, std::vector<double> coefficients) {
  return {std::move(letters), std::move(coefficients)};
}

void require_known(const exported_method& method, const std::string& letters) {
  const auto at = letters.find_first_not_of("ABD");
  if (at == std::string::npos) return;
  const char letter = letters[at];
  if (letter == 'G') {
    refuse(
        "export: {} has the letter G, a gradient kick, whose f'(q) v no host has: give --displaced for the "
        "displaced kick, which agrees with it up to h^5, keeps volume and is reversible, but is not "
        "symplectic",
        method.method.name());
  }
  if (letter == 'O') {
    refuse(
        "export: {} has letters O, and so far only words without a bath are exported: export the method "
        "without "
        "--placement, and place its letters O in the host",
        method.method.name());
  }
  refuse(
      "export: {} has the letter {}, which needs the quadratic part of the system: take a method of the "
      "letters A, "
      "B and D (nysalt list)",
      method.method.name(), letter);
}

}  // namespace

std::size_t exported_letters::count(char letter) const {
  return static_cast<std::size_t>(std::ranges::count(letters, letter));
}

exported_letters kernel_of(const exported_method& method) {
  const run_time_word& word = method.method.letters();
  const auto all = method.method.coefficients();
  const std::string letters = word.letters().substr(0, word.length);
  require_known(method, letters);
  return with_letters(letters, {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(word.kernel_slots)});
}

exported_letters start_of(const exported_method& method) {
  const run_time_word& word = method.method.letters();
  if (!word.is_processed()) return {};
  return with_letters(detail::pre_processor(word).letters(),
                      detail::pre_processor_coefficients(word, method.method.coefficients()));
}

exported_letters finish_of(const exported_method& method) {
  const run_time_word& word = method.method.letters();
  if (!word.is_processed()) return {};
  return with_letters(detail::post_processor(word).letters(),
                      detail::post_processor_coefficients(word, method.method.coefficients()));
}

exported_method with_displaced_kicks(const exported_method& method) {
  const run_time_word& word = method.method.letters();
  std::string letters = word.letters();
  std::vector<double> c = method.method.coefficients();
  std::size_t slot = 0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (letters[i] == 'G') {
      if (c[slot] == 0.0) {
        refuse(
            "export: {} has a gradient kick G(b, c) with b = 0, which no displaced kick is like: take "
            "another "
            "method",
            method.method.name());
      }
      letters[i] = 'D';
      c[slot + 1] *= 2.0 / c[slot];
    }
    slot += letters[i] == 'D' ? 2 : 1;
  }
  if (letters == word.letters()) return method;
  exported_method result = method;
  method_properties promised = method.method;
  promised.order = std::min(promised.order, 4);  // D agrees with G up to h^5 in a step
  result.method = tabulated(method.method.name(), run_time_word(letters), c, promised);
  result.about.push_back(
      "The gradient kicks G(b, c) are displaced kicks D(b, 2 c/b) here, which agree with them up "
      "to h^5: the map keeps volume and is reversible, but is not symplectic.");
  return result;
}

self_test self_test_of(const exported_method& method) {
  const pinned_oscillators system;
  const stepper<pinned_oscillators, run_time_word> own(system, method.method.letters(),
                                                       method.method.coefficients(), 0.1);
  phase_point<double, 2> x;
  x.q << 0.3, 0.2;
  x.p << 0.1, -0.25;
  const auto end = integrate(
                       own, x, 10, [](auto&&...) {}, 10)
                       .finish;
  return {{end.q[0], end.q[1]}, {end.p[0], end.p[1]}};
}

}  // namespace nysalt::program
