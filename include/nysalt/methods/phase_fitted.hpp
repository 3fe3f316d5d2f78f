// SPDX-License-Identifier: BSL-1.0
// Phase-fitted methods: coefficients for which an oscillation of one frequency keeps its phase.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "nysalt/detail/requirements.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/run_time_family.hpp"
#include "nysalt/run_time_word.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {
/// The highest frequency of the modes; of systems that declare none, the end of the highest band.
template <System S>
double frequency_to_fit(const S& system) {
  if constexpr (HasModes<S>) {
    if (has_modes(system)) return system.modes().frequencies.maxCoeff();
  }
  if constexpr (HasFrequencyBands<S>) return highest_frequency(system.frequency_bands());
  return 0.0;
}
}  // namespace detail

}  // namespace nysalt

// The equations of phase fitting, and their solution.

namespace nysalt::detail {

/// By how much a step of a word differs from the rotation by z, z^2 = x, on q'' = -x q, each relative to
/// the power of x at which consistent words begin to differ, so that nothing cancels as z -> 0:
///   (trace/2 - cos z)/x^2,  (M_qp - sin z/z)/x,  (M_pq + z sin z)/x^2
/// and, where the word is not symmetric, (M_qq - M_pp)/(2 x). As the determinant is 1, one of them follows
/// from the others; but which does depends on z.
Eigen::VectorXd defect_of_rotation(const run_time_word& word, const std::vector<double>& coefficients,
                                   bool symmetric, double x);

/// d defect_i / d theta_k. The matrix of a word is affine in each coefficient (but those of rotations), so
/// that a difference over a step of 1 is the derivative.
Eigen::MatrixXd jacobian_of_defect(const run_time_family& family, const Eigen::VectorXd& theta, double x);

/// Result of a continuation.
struct phase_fitting {
  std::optional<Eigen::VectorXd> theta;  ///< at the z that was asked for; nothing: it ended before
  double reached;                        ///< the last z with a solution
};

/// The parameters that turn the oscillator exactly by z in a step, nearest to `nearest`: the solution at z
/// that continues those for smaller z. Nothing where there are fewer parameters than equations, or where a
/// quadratic part is split off.
phase_fitting fit_phase(const run_time_family& family, const Eigen::VectorXd& nearest, double z);

}  // namespace nysalt::detail

// A start of a search where the highest frequency is known.

namespace nysalt {

/// The member of a family whose step is the exact rotation on the oscillator at z = step * frequency, near to
/// one of the starts of the family: its classical members in their order, then the others. Letters O count
/// for nothing. Nothing where the word rotates by itself, has fewer parameters than the rotation has
/// equations (two if it is symmetric, else three), or no start leads to a member in the ranges. Throws
/// std::invalid_argument unless z is positive and finite. Cost: some milliseconds.
std::optional<named_parameters> phase_fitted_start(const run_time_family& family, double z);

/// A classical method M with its coefficients changed, within a family F of its word, such that its step is
/// the exact rotation on the oscillator at z = h omega: trace/2 = cos z and M_qp = sin z/z. Such methods are
/// called phase-fitted and amplification-fitted [van_de_vyver_2007]; exponentially or trigonometrically
/// fitted where they are built from the functions that they keep [simos_vigo_aguiar_2003;
/// monovasilis_kalogiratou_simos_2013]. Of the parameters with that property they are those nearest to M's
/// own, which they become as z -> 0. Hence the order is that of M if h -> 0 at a fixed omega; at a fixed z it
/// is 2.
///
/// The frequency must be known; no data are needed. Of BAGAB (fg_chin) they have a closed form,
///   b = 2/z^2 - cot(z/2)/z,  c = ((1 - 2 b) z^2 - 4 (1 - sin z/z))/(2 z^4).
/// Words of two kicks without gradient cannot: trace/2 would need a term z^4/24, and z^4/32 is the most.
/// Others follow from z = 0 by Newton's method until their coefficients have no real continuation.
template <Family F, Method M>
class phase_fitted {
  static_assert(std::is_same_v<typename F::word, typename M::word>,
                "nysalt: the family and the classical method of phase_fitted must have the same word");
  static_assert(F::symmetric && F::parameters >= 2 && F::word::reads == field::whole,
                "nysalt: phase_fitted solves two equations: it needs a symmetric family without rotations of "
                "two parameters or more");
  static_assert(M::order >= 4, "nysalt: only a method of order 4 or more is the limit of phase-fitted ones");

 public:
  using word = typename M::word;
  static constexpr int order = M::order;
  static constexpr bool symmetric = true;
  static constexpr std::string_view source = "van_de_vyver_2007";
  static constexpr bool requires_quadratic_kinetic =
      M::requires_quadratic_kinetic || F::requires_quadratic_kinetic;
  static std::string name() {
    std::string text = "phase_fitted_";  // in steps: g++ 12 warns wrongly about a chain of +
    text += M::name();
    return text;
  }

  /// The member that turns an oscillator by z in a step. Throws std::invalid_argument unless z is positive
  /// and finite, and below the end of the coefficients. Cost: a millisecond; they are right to rounding.
  explicit phase_fitted(double z) : z_(z) {
    if (!(z > 0.0) || !std::isfinite(z)) {
      throw std::invalid_argument(
          sentence("{}: z = step * frequency must be positive and finite, got {}; fit to a mode that moves",
                   name(), z));
    }
    const run_time_family family{F{}};
    const auto classical = F::of(M());
    const auto fit =
        detail::fit_phase(family, Eigen::Map<const Eigen::VectorXd>(classical.data(), F::parameters), z);
    if (!fit.theta) {
      const double reached = std::floor(1000.0 * fit.reached) / 1000.0;
      throw std::invalid_argument(sentence(
          "{}: z = step * frequency must be at most {}, where its coefficients end, got {}; take a smaller "
          "step",
          name(), reached, std::round(1000.0 * z) / 1000.0));
    }
    for (std::size_t k = 0; k < theta_.size(); ++k) theta_[k] = (*fit.theta)[static_cast<Eigen::Index>(k)];
  }

  const parameters_of<F>& parameters() const { return theta_; }  ///< parameters in the family
  typename word::template coefficients<double> coefficients() const { return F{}.coefficients(theta_); }
  double z() const { return z_; }  ///< z as given

 private:
  double z_;
  parameters_of<F> theta_;
};

/// The member for a system at a step: fitted to |step| times the highest frequency of the system's modes, or
/// of its bands if it declares no modes. (Bands have room for what soft forces add, which phases should not
/// have.) Throws what phase_fitted throws.
template <Family F, Method M, System S>
phase_fitted<F, M> phase_fitted_for(const S& system, double step) {
  require_suited<phase_fitted<F, M>, S>();
  static_assert(HasModes<S> || HasFrequencyBands<S>,
                "nysalt: phase_fitted_for needs the system's highest frequency; give the system modes() or "
                "frequency_bands(), or use phase_fitted(step * frequency)");
  return phase_fitted<F, M>(std::abs(step) * detail::frequency_to_fit(system));
}

}  // namespace nysalt
