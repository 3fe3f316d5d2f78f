// SPDX-License-Identifier: BSL-1.0
// A family of methods: one word, whose coefficients are functions of a few parameters.
#pragma once

#include <array>
#include <concepts>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Range of a parameter. Open: the coefficients are not defined at the ends. Closed: the ends may be
/// attained.
struct parameter_range {
  double low;   ///< lower end
  double high;  ///< upper end
  bool open;    ///< whether the ends are excluded

  /// Whether a parameter may be x. NaN may not.
  bool contains(double x) const { return open ? low < x && x < high : low <= x && x <= high; }
};

/// theta: one number for each parameter of the family F.
template <class F>
using parameters_of = std::array<double, static_cast<std::size_t>(F::parameters)>;

/// Bound of a parameter where a family has none: beyond it coefficients of opposite sign leave less than half
/// of their digits of each other. A search that ends here has found nothing.
inline constexpr double farthest_parameter = 4.0;

/// A classical method that a family contains.
template <int Parameters>
struct classical_member {
  std::string_view name;                                           ///< name of the method
  std::array<double, static_cast<std::size_t>(Parameters)> theta;  ///< parameters of the method in the family
};

/// Carries the derivatives by theta, which learning needs.
template <class F>
using theta_dual = dual<double, F::parameters>;

/// theta -> coefficients of a word, over double and over derivatives with respect to theta:
///   letters, name, parameters, parameter_names
///   order, symmetric, requires_quadratic_kinetic   what holds for every theta
///   ranges(), start()                              where theta may lie, and where a search begins
///   coefficients(theta)                            over any scalar, one for each slot of the letters
/// All but the last are static; letters and coefficients() may depend on the constructor arguments of the
/// family. And, if wanted, further points from which a search begins: classical_members(), and
/// further_starts(), thetas without a name; most_stable_member(), the member with the longest stability
/// interval, for steps at which the others are unstable; and source, the key in docs/bibliography.bib of
/// where it comes from.
template <class F>
concept Family = std::copyable<F> &&
                 requires(const F& family, const parameters_of<F>& theta,
                          const std::array<theta_dual<F>, static_cast<std::size_t>(F::parameters)>& lifted) {
                   { family.letters } -> std::convertible_to<const word&>;
                   { F::name } -> std::convertible_to<std::string_view>;
                   { F::parameter_names[0] } -> std::convertible_to<std::string_view>;
                   { F::order } -> std::convertible_to<int>;
                   { F::symmetric } -> std::convertible_to<bool>;
                   { F::requires_quadratic_kinetic } -> std::convertible_to<bool>;
                   {
                     F::ranges()
                   } -> std::same_as<std::array<parameter_range, static_cast<std::size_t>(F::parameters)>>;
                   { F::start() } -> std::same_as<parameters_of<F>>;
                   { family.coefficients(theta)[0] } -> std::convertible_to<double>;
                   { family.coefficients(lifted)[0] } -> std::convertible_to<theta_dual<F>>;
                 };

namespace detail {
inline void require_in_range(std::string_view family, std::string_view parameter,
                             const parameter_range& range, double theta) {
  if (range.contains(theta)) return;
  const auto [low, high, open] = range;
  throw std::invalid_argument(sentence("{}: the parameter {} must lie in {}{}, {}{}, got {}", family,
                                       parameter, open ? '(' : '[', low, high, open ? ')' : ']', theta));
}
}  // namespace detail

}  // namespace nysalt
