// SPDX-License-Identifier: BSL-1.0

#include "exported_method.hpp"

#include <algorithm>
#include <cmath>

#include "nysalt/integrate.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::detail {

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

struct pinned_oscillators_in_bath : pinned_oscillators {
  nysalt::bath pinned_bath = nysalt::bath::of_temperature(1.5, 0.7);

  const nysalt::bath& bath() const { return pinned_bath; }
};

/// sin(1), sin(2), ... in the order in which letters O draw.
struct sines {
  static constexpr bool is_memoryless = false;
  std::int64_t letters;  ///< O, in a step

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    const std::int64_t drawn = (at.step * letters + at.flow) * xi.size();
    for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = T(std::sin(static_cast<double>(drawn + i + 1)));
  }
};

void require_known(const exported_method& method, const std::string& letters) {
  const auto at = letters.find_first_not_of("ABDO");
  if (at == std::string::npos) return;
  const char letter = letters[at];
  if (letter == 'G') {
    refuse_export(
        "export: the method must have no letter G, a gradient kick, whose f'(q) v no host has, got {}; take "
        "the displaced kick (displaced), equal up to h^5, volume-preserving and reversible, but not "
        "symplectic",
        method.method.name());
  }
  refuse_export(
      "export: the method must have letters A, B, D and O only, got {} with {}, which needs the quadratic "
      "part of the system; take another method (nysalt list)",
      method.method.name(), letter);
}

exported_word with_coefficients(const std::string& letters, const std::vector<double>& all) {
  exported_word result;
  std::size_t slot = 0;
  for (const char letter : letters) {
    result.push_back({letter, all[slot++]});
    if (letter == 'D') result.back().d = all[slot++];
  }
  return result;
}

self_test end_of(const auto& stepper) {
  phase_point<double, 2> x;
  x.q << 0.3, 0.2;
  x.p << 0.1, -0.25;
  const auto end = integrate(
                       stepper, x, 10, [](auto&&...) {}, 10)
                       .finish;
  return {{end.q[0], end.q[1]}, {end.p[0], end.p[1]}};
}

}  // namespace

exported_word kernel_of(const exported_method& method) {
  const nysalt::word& word = method.method.letters();
  const std::string letters = word.letters().substr(0, word.length);
  require_known(method, letters);
  return with_coefficients(letters, method.method.coefficients());
}

exported_word start_of(const exported_method& method) {
  const nysalt::word& word = method.method.letters();
  if (!word.is_processed()) return {};
  return with_coefficients(pre_processor(word).letters(),
                           pre_processor_coefficients(word, method.method.coefficients()));
}

exported_word finish_of(const exported_method& method) {
  const nysalt::word& word = method.method.letters();
  if (!word.is_processed()) return {};
  return with_coefficients(post_processor(word).letters(),
                           post_processor_coefficients(word, method.method.coefficients()));
}

exported_word composition_of(const exported_method& method) {
  exported_word result;
  for (const exported_letter& one : kernel_of(method)) {
    if (one.c == 0.0) continue;
    const bool joins =
        !result.empty() && result.back().letter == one.letter && (one.letter == 'A' || one.letter == 'B');
    if (joins) result.back().c += one.c;
    if (!joins) result.push_back(one);
  }
  return result;
}

std::string letters_written(const exported_word& word) {
  std::string result;
  for (const exported_letter& one : word) result += one.letter;
  return result;
}

std::vector<double> coefficients_of(const exported_word& word) {
  std::vector<double> result;
  for (const exported_letter& one : word) {
    result.push_back(one.c);
    if (one.letter == 'D') result.push_back(one.d);
  }
  return result;
}

bool has_bath(const exported_method& method) { return method.method.letters().stochastic_letters > 0; }

exported_method with_displaced_kicks(const exported_method& method) {
  const nysalt::word& word = method.method.letters();
  std::string letters = word.letters();
  std::vector<double> c = method.method.coefficients();
  std::size_t slot = 0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (letters[i] == 'G') {
      if (c[slot] == 0.0) {
        refuse_export(
            "export: b of a gradient kick G(b, c) must not be 0, where no displaced kick is like it, got 0 "
            "in {}; take another method",
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
  result.method = nysalt::method(method.method.name(), nysalt::word(letters), c, promised);
  result.about.push_back(
      "The gradient kicks G(b, c) are displaced kicks D(b, 2 c/b) here, which agree with them up "
      "to h^5: the map keeps volume and is reversible, but is not symplectic.");
  return result;
}

self_test self_test_of(const exported_method& method) {
  const nysalt::word& word = method.method.letters();
  if (!has_bath(method)) {
    const pinned_oscillators system;
    return end_of(stepper<pinned_oscillators>(system, word, method.method.coefficients(), 0.1));
  }
  const pinned_oscillators_in_bath system;
  return end_of(stepper<pinned_oscillators_in_bath, double, sines>(system, word, method.method.coefficients(),
                                                                   0.1, sines{word.stochastic_letters}));
}

}  // namespace nysalt::detail
