// SPDX-License-Identifier: BSL-1.0
// Words on an oscillator: matrices of a step, growth, energy, resonances.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/scalars/polynomial.hpp"
#include "nysalt/system.hpp"
#include "nysalt/word.hpp"

// The step of a word on the harmonic oscillator, letter by letter.

namespace nysalt {

namespace detail {

/// (q, p) after one step of size 1 of the word without its bath, on q'' = -(theta^2 + k) q. R rotates by
/// theta, S and H use k only, B and G all of it. times_k(x) is k x, so that k may be a number, the variable
/// of a polynomial, or, for two modes, a matrix; theta is a number, or an array of two. With a step h: theta
/// = h omega, k = h^2 kappa, and p counts in units of q/h.
template <class P, class Theta>
void step_on_oscillator(const nysalt::word& word, const std::vector<double>& coefficients, const Theta& theta,
                        const auto& times_k, P& q, P& p) {
  const split_stiffness<Theta, std::remove_cvref_t<decltype(times_k)>> stiffness{theta, times_k};
  const double* c = coefficients.data();
  for (std::size_t i = 0; i < word.length; ++i) {
    const bool is_known = detail::with_letter(word.letter(i), known_letters{}, [&](auto flow) {
      if constexpr (!StochasticFlow<decltype(flow)>) flow.on_oscillator(stiffness, c, q, p);
      c += flow.slots;
    });
    if (!is_known) {
      throw std::invalid_argument(
          sentence("the word {} must have letters whose action on an oscillator is known, got {}; examine "
                   "its stability by trial runs",
                   word.letters(), word.letter(i)));
    }
  }
}

/// The 2 x 2 matrix of step_on_oscillator() in (q, p), with entries in the ring of T: numbers, dual numbers,
/// series or polynomials. The word has no processor.
template <class T>
struct oscillator_matrix {
  T qq;  ///< q after the step from q = 1, p = 0
  T pq;  ///< p from there
  T qp;  ///< q after the step from q = 0, p = 1
  T pp;  ///< p from there

  oscillator_matrix(const nysalt::word& word, const std::vector<double>& coefficients, double theta,
                    const T& zero, const T& one, const auto& times_k)
      : qq(one), pq(zero), qp(zero), pp(one) {
    step_on_oscillator(word, coefficients, theta, times_k, qq, pq);
    step_on_oscillator(word, coefficients, theta, times_k, qp, pp);
  }

  /// trace/2
  T half_trace() const {
    T sum = qq;
    sum += pp;
    return 0.5 * sum;
  }
};

/// The matrix at one frequency: of a step 1, all of k = z^2, or of k and an angle theta of rotations.
inline oscillator_matrix<double> matrix_on_oscillator(const nysalt::word& word,
                                                      const std::vector<double>& coefficients, double k,
                                                      double theta = 0.0) {
  return {word, coefficients, theta, 0.0, 1.0, [k](double x) { return k * x; }};
}

}  // namespace detail

// trace/2 of a word on the harmonic oscillator, as a polynomial.

namespace detail {

/// trace/2 of step_on_oscillator() as a polynomial in k, low <= k <= high. The step is stable where it is
/// within +-1.
detail::bernstein_polynomial half_trace(const nysalt::word& word, const std::vector<double>& coefficients,
                                        double theta, double low, double high);

}  // namespace detail

// By how much a symmetric word changes the energy of a harmonic oscillator, exactly.

namespace detail {

/// A number r with r^2 = rho, and dr/dc_i for each coefficient c_i of a word.
struct energy_defect {
  double value;
  Eigen::VectorXd slopes;
};
energy_defect energy_defect_on_oscillator(const nysalt::word& word, const std::vector<double>& coefficients,
                                          double z);

/// Energy error rho of a symmetric word at z = h omega. With the matrix [[A, B], [C, A]] of a step in (omega
/// q, p),
///   rho = (B + C)^2 / (2 (1 - A^2)):
/// after n steps from the canonical distribution the energy has grown by sin^2(n t) rho kT on average, cos t
/// = A [blanes_casas_sanz_serna_2014]. Infinite where |A| >= 1, as the word is not stable there. Cost: two
/// evaluations of each letter on one number. Throws std::invalid_argument unless there is a coefficient for
/// each slot, or if the word rotates, has letters O or a processor.
double energy_error_on_oscillator(const nysalt::word& word, const std::vector<double>& coefficients,
                                  double z);

}  // namespace detail

// Distance of the steps of a word from half turns of a stiff oscillation.

namespace detail {

/// A step of a word turns a stiff oscillation by nearly k half turns, and small nonlinear errors add up from
/// step to step.
struct resonance {
  frequency_band band;  ///< frequency band that holds the resonant frequency
  int half_turns;       ///< k
};

/// Number of steps from which a run is long: in shorter ones nothing was seen of a resonance that is as far
/// as resonance_distance or a few times nearer.
inline constexpr std::int64_t long_run = 10'000;
/// The share of k pi that the phase of a step should keep from k pi in long runs. On the FPU chain (omega =
/// 50) the largest energy error of 20 000 steps was, over the largest of the first tenth of the steps, 1.0
/// to 1.5 for learned fg4 up to 16 % below 2 pi, 1.6 at 10 %, 2.1 at 7 % and 3 at 10 % above; for learned
/// aba6 1.0 at 28 %, 3 at 13 %.
inline constexpr double resonance_distance = 0.1;

/// The first resonance of a band that does not begin at zero, of a word whose step has nearly the phase h
/// omega there, as those that follow the motion have; nothing if there is none, and of words with rotations.
/// A processor changes nothing. Cost: some 32 steps on an oscillator for each band.
std::optional<resonance> near_resonance(const nysalt::word& word, const std::vector<double>& coefficients,
                                        const std::vector<frequency_band>& bands, double step);

/// "a step turns the frequencies 49 to 51 by nearly 2 pi ..."
std::string in_words(const resonance& near);

}  // namespace detail

// Growth of two coupled modes under a word with rotations.

namespace detail {

/// Logarithm of the spectral radius of one step on q'' = -(Theta^2 + K) q with Theta = diag(theta) and a
/// symmetric 2 x 2 matrix K, see step_on_oscillator(); 0 where the step is stable. A symplectic matrix of
/// four rows has eigenvalues in pairs lambda, 1/lambda, and y = lambda + 1/lambda solves y^2 - a y + b - 2 =
/// 0 with a = tr M and b = (a^2 - tr M^2)/2. Two modes that K couples grow where theta_1 + theta_2 is near 2
/// pi k: there eigenvalues of opposite Krein signature meet [hairer_lubich_wanner_2006, section XIII].
/// Infinite where a coefficient is not finite. Cost: four steps on two oscillators.
double growth_of_pair(const nysalt::word& word, const std::vector<double>& coefficients,
                      const Eigen::Array2d& theta, const Eigen::Matrix2d& k);

}  // namespace detail

// Transient growth: how much a word with rotations magnifies an oscillation, by resonances above all.

namespace detail {

/// Largest |M^n| of n = 1 .. steps steps on q'' = -(theta^2 + k) q, k > 0, in the norm of its energy, which
/// the motion itself conserves; see step_on_oscillator(). Stable or not is too coarse a question where words
/// rotate: at h omega = j pi the impulse method has the trace 2 (-1)^j for every soft force, and grows
/// without a bound, but slowly; others are stable there but for a width or a rate that is nil. With trace/2 =
/// +-cos t, t <= pi/2, +-M^n = cos(n t) + (+-M - cos t) sin(n t)/sin t, taken at n t = pi/2 or the last step,
/// whichever is first; cosh and sinh where it is unstable. NaN where a coefficient is. Cost: a step.
double transient_growth(const nysalt::word& word, const std::vector<double>& coefficients, double theta,
                        double k, std::int64_t steps);

}  // namespace detail

// Stability of a linear symplectic step, and how near it is to a loss of stability.

namespace detail {

/// Eigenvalues of a symplectic matrix of 2 n rows, in coordinates (q, p). Those on the unit circle have a
/// Krein signature, the sign of i x^* Omega x of their vectors x; where two of opposite signature meet an
/// arbitrarily small perturbation moves both off the circle, and where two of like signature meet none does:
/// the step is strongly stable [krein_1950], [gelfand_lidskii_1955], [hairer_lubich_wanner_2006, section
/// XIII].
struct symplectic_spectrum {
  double growth = 0.0;  ///< logarithm of the spectral radius
  /// Rounding splits a double eigenvalue that has one vector by the square root of its own size: what grows
  /// by less counts as on the circle.
  static constexpr double rounding = 1e-6;
  /// Smallest difference in phase, in radian, of two eigenvalues of opposite signature; 0 where two coincide,
  /// or where one is off the circle.
  double krein_distance = std::numbers::pi;
  /// Phase of the one of positive signature, in (-pi, pi]; where one is off the circle, of that which is
  /// farthest off.
  double first = 0.0;
  double second = 0.0;  ///< phase of the other

  /// Whether no eigenvalue is off the circle.
  bool is_on_circle() const { return growth <= rounding; }
};

/// The spectrum of a symplectic matrix. Infinite growth of a matrix that is not finite; of a matrix without
/// rows the spectrum of no eigenvalues, a growth of 0 and a distance of pi. Throws std::invalid_argument
/// unless it is square with an even number of rows. Cost: its eigenvectors.
symplectic_spectrum spectrum_of(const Eigen::MatrixXd& step);

/// Largest |M^n| over the powers of two n <= steps, which is that over all n <= steps to a factor 2/sqrt(3)
/// where two eigenvalues come near each other: their phases, n times as far apart, pass 2 pi/3 at one of the
/// powers, and are 4 pi/3 apart at most there. At least 1; infinite where it grows beyond 10^6. Cost:
/// log2(steps) products of matrices.
double largest_power(const Eigen::MatrixXd& step, std::int64_t steps);

}  // namespace detail

}  // namespace nysalt
