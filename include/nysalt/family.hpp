// SPDX-License-Identifier: BSL-1.0
// A family of methods: one word, whose coefficients are functions of a few parameters. A struct of a user
// describes a family; as a value it is what a search must know of it, so that learning is compiled once.
#pragma once

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/families/parameters.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

namespace detail {

/// Carries the derivatives by theta, which learning needs.
template <class F>
using theta_dual = dual<double, F::parameters>;

}  // namespace detail

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
concept Family =
    std::copyable<F> &&
    requires(const F& family, const detail::parameters_of<F>& theta,
             const std::array<detail::theta_dual<F>, static_cast<std::size_t>(F::parameters)>& lifted) {
      { family.letters } -> std::convertible_to<const word&>;
      { F::name } -> std::convertible_to<std::string_view>;
      { F::parameter_names[0] } -> std::convertible_to<std::string_view>;
      { F::order } -> std::convertible_to<int>;
      { F::symmetric } -> std::convertible_to<bool>;
      { F::requires_quadratic_kinetic } -> std::convertible_to<bool>;
      { F::ranges() } -> std::same_as<std::array<parameter_range, static_cast<std::size_t>(F::parameters)>>;
      { F::start() } -> std::same_as<detail::parameters_of<F>>;
      { family.coefficients(theta)[0] } -> std::convertible_to<double>;
      { family.coefficients(lifted)[0] } -> std::convertible_to<detail::theta_dual<F>>;
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

/// A method by its name and parameters.
struct named_parameters {
  std::string name;       ///< name of the point
  Eigen::VectorXd theta;  ///< parameters
};

namespace detail {

struct contained_family;

}  // namespace detail

/// The names, bounds and promises of a family, its word, and theta -> coefficients with their Jacobian.
class family {
 public:
  /// The family that a user's struct describes; it converts by itself. Throws std::logic_error if the family
  /// does not contain the one that it declares as `contained`.
  template <class F>
    requires(!std::same_as<F, family> && Family<F>)
  family(const F& family)  // NOLINT(google-explicit-constructor)
      : name(F::name),
        parameter_names(F::parameter_names.begin(), F::parameter_names.end()),
        order(F::order),
        symmetric(F::symmetric),
        requires_quadratic_kinetic(F::requires_quadratic_kinetic),
        letters(family.letters),
        coefficients_([family](const Eigen::VectorXd& theta) {
          const auto c = family.coefficients(array_from<F>(theta));
          return std::vector<double>(c.begin(), c.end());
        }),
        jacobian_([family](const Eigen::VectorXd& theta) { return jacobian_of(family, theta); }) {
    if constexpr (requires { F::source; }) source = F::source;
    const auto family_ranges = F::ranges();
    ranges.assign(family_ranges.begin(), family_ranges.end());
    const auto first = F::start();
    starts.push_back({"start", Eigen::Map<const Eigen::VectorXd>(first.data(), F::parameters)});
    if constexpr (requires { F::classical_members(); }) {
      for (const auto& known : F::classical_members()) {
        starts.push_back(
            {std::string(known.name), Eigen::Map<const Eigen::VectorXd>(known.theta.data(), F::parameters)});
      }
    }
    static_assert(
        !requires { F::refuge(); }, "refuge() of a family is named most_stable_member()");
    if constexpr (requires { F::most_stable_member(); }) {
      const auto theta = F::most_stable_member();
      most_stable_member = Eigen::Map<const Eigen::VectorXd>(theta.data(), F::parameters);
    }
    if constexpr (requires { F::further_starts(); }) {
      for (const auto& theta : F::further_starts()) {
        starts.push_back({"further start", Eigen::Map<const Eigen::VectorXd>(theta.data(), F::parameters)});
      }
    }
    if constexpr (requires { typename F::contained; }) contain(nysalt::family(typename F::contained{}));
  }
  /// A method as a family of one member, without parameters.
  family(std::string method_name, const word& letters, std::vector<double> coefficients);

  std::string name;
  std::string source;                                 ///< key in docs/bibliography.bib; empty: not published
  std::vector<std::string> parameter_names;           ///< names of the parameters
  std::vector<parameter_range> ranges;                ///< ranges of the parameters
  std::optional<Eigen::VectorXd> most_stable_member;  ///< the one with the longest stability interval
  std::vector<named_parameters> starts;  ///< the family's own, its classical members, further ones
  std::shared_ptr<const detail::contained_family>
      contained;  ///< contained family, whose optimum is a start, too; null: none
  int order;
  bool symmetric;
  bool requires_quadratic_kinetic;
  word letters;

  Eigen::Index parameters() const { return static_cast<Eigen::Index>(parameter_names.size()); }
  std::vector<double> coefficients(const Eigen::VectorXd& theta) const { return coefficients_(theta); }
  /// d c_i / d theta_k in row i, column k.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& theta) const { return jacobian_(theta); }

  /// Whether theta is within the open ranges: beyond them the coefficients are not defined.
  bool is_defined(const Eigen::VectorXd& theta) const;

  /// Whether theta is within all ranges, open or closed.
  bool is_in_range(const Eigen::VectorXd& theta) const;

  /// A family with letters O at a placement. Throws std::invalid_argument if it has some already, or no
  /// central letter to split.
  friend family thermostatted(const family& plain, placement where);

  /// A family with a processor P of pairs of letters B A, FAMILY+pPAIRS, whose coefficients are parameters
  /// p1, p2, ... within [-1, 1] but for the last two: the coefficients of A and of B add up to zero each, so
  /// that P is the identity but for terms of h^2 and P(-h) K^n P(h)^-1 has order 2 at least, for every P.
  /// Throws std::invalid_argument unless the family is symmetric and of the letters A, B and G, and there are
  /// from 2 to most_processor_pairs pairs. Cost of P(h)^-1, once a run, and of P(-h), each time that a run is
  /// observed: a force evaluation for each pair.
  friend family processed(const family& kernel, int pairs);

  friend family symmetric_word(std::string name, const word& letters, const std::string& times);

 private:
  /// `inner` has the same word, and the parameters here are the first coefficients of the word.
  void contain(family inner);

  template <Family F>
  static detail::parameters_of<F> array_from(const Eigen::VectorXd& theta) {
    detail::parameters_of<F> result;
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = theta[static_cast<Eigen::Index>(k)];
    return result;
  }

  template <Family F>
  static Eigen::MatrixXd jacobian_of(const F& family, const Eigen::VectorXd& theta) {
    std::array<detail::theta_dual<F>, detail::parameters_of<F>{}.size()> lifted;
    for (int k = 0; k < F::parameters; ++k) {
      lifted[static_cast<std::size_t>(k)] = detail::theta_dual<F>::variable(theta[k], k);
    }
    const auto c = family.coefficients(lifted);
    Eigen::MatrixXd result(static_cast<Eigen::Index>(c.size()), F::parameters);
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
      for (Eigen::Index k = 0; k < F::parameters; ++k) {
        result(i, k) = c[static_cast<std::size_t>(i)].derivative[static_cast<std::size_t>(k)];
      }
    }
    return result;
  }

  std::function<std::vector<double>(const Eigen::VectorXd&)> coefficients_;
  std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> jacobian_;
};

namespace detail {

/// A family of fewer parameters all of whose members are members of a larger one.
struct contained_family {
  nysalt::family family;
  Eigen::MatrixXd slopes;  ///< derivatives of the larger family's parameters by the parameters of this one
  Eigen::VectorXd origin;  ///< the larger family's parameters where the parameters of this one are 0

  /// The parameters of the member of the larger family.
  Eigen::VectorXd embed(const Eigen::VectorXd& theta) const { return origin + slopes * theta; }
};

}  // namespace detail

/// The methods of a word that reads the same from both ends, whose coefficients do, too, and add up to 1 for
/// each part of H: symmetric, of order 2. `times` says of which part each slot is the time, a character each:
/// characters of letters of one's own, and A, B, R or S. Parameters are named by the part and a number; the
/// last of each part, nearest to the middle of the word, follow from the sums. The start is made of equal
/// steps of order 2; of drifts and kicks with a fast and a slow part it is r-RESPA. Throws
/// std::invalid_argument if the word does not read the same from both ends, has a processor, or two equal
/// neighbours, or unless there is one character for each slot.
family symmetric_word(std::string name, const word& letters, const std::string& times);

namespace detail {

/// Pairs of letters of a processor: more gain little, and cost evaluations each time that a run is observed.
inline constexpr int most_processor_pairs = 8;

}  // namespace detail

/// The member of a family at theta, usable at any step. Throws std::invalid_argument unless there is a value
/// for each parameter, in its range.
method member(const family& family, const std::vector<double>& theta);

namespace detail {

/// Throws std::invalid_argument, naming the parameter, unless every theta lies in its range.
void require_in_range(const family& family, const Eigen::VectorXd& theta);

}  // namespace detail

}  // namespace nysalt
