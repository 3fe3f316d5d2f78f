// SPDX-License-Identifier: BSL-1.0
// What the library calls of a system whose type it does not know.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/flow.hpp"
#include "nysalt/kernels/site_kernels.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/stepping/step_program.hpp"
#include "nysalt/stepping/system_letters.hpp"

namespace nysalt {

namespace detail {

/// Parameters whose derivatives are carried at a time; more take further passes.
inline constexpr int directions_at_a_time = 2;

}  // namespace detail

}  // namespace nysalt

namespace nysalt::detail {

/// Trajectories side by side, as many as suit the processor.
using lanes = scalar_of_lanes<default_lanes>;
/// One trajectory with its derivatives by two parameters, and trajectories side by side with theirs.
using slopes = dual<double, directions_at_a_time>;
using lanes_with_slopes = dual<lanes, directions_at_a_time>;

/// The scalars over which kernels are compiled.
template <class T>
concept Served = std::same_as<T, double> || std::same_as<T, lanes> || std::same_as<T, slopes> ||
                 std::same_as<T, lanes_with_slopes>;

/// The scalar of coefficients of steps over T: derivatives by theta are in both.
template <class T>
using coefficient_of = std::conditional_t<is_dual<T>, T, double>;

/// A system's functions over T. What a system does not serve throws std::logic_error: the facts of a model
/// say so beforehand.
template <class T>
class kernels {
 public:
  using column = vector<T, Eigen::Dynamic>;
  using program = step_program<coefficient_of<T>>;

  virtual ~kernels() = default;
  /// Advances an open run by `steps` steps, which at most `threads` threads share where the system allows
  /// it. Cost: one virtual call, and the cost of the letters and observations.
  virtual void advance(column& q, column& p, column& f, flow_room<T, Eigen::Dynamic>& room,
                       const program& letters, std::int64_t steps, int threads, const callback& other,
                       const watch<T>& watched) const = 0;
  virtual void force(field of, const column& q, column& f) const = 0;
  /// g = f'(q) v, of a black box from a difference along reach v.
  virtual void force_along(field of, const column& q, const column& v, column& g,
                           lifted_room<T, Eigen::Dynamic>& room, double reach) const = 0;
  /// q += c grad K(p)
  virtual void drift(column& q, const column& p, const coefficient_of<T>& c) const = 0;
  virtual void velocity(const column& p, column& v) const = 0;
  virtual T kinetic_energy(const column& p) const = 0;
  virtual T potential(const column& q) const = 0;
  virtual T energy(const column& q, const column& p) const = 0;
  /// The letter of that name among those that the system declares, with coefficients and step folded in.
  virtual applied_letter<T> letter(char name, const coefficient_of<T>* c, double h) const = 0;
};

/// A system without its type.
class any_system {
 public:
  virtual ~any_system() = default;
  any_system(const any_system&) = delete;  // kernels belong to one object
  any_system& operator=(const any_system&) = delete;

  /// The system's functions over T.
  template <Served T>
  const kernels<T>& over() const {
    return *std::get<const kernels<T>*>(kernels_);
  }
  virtual std::unique_ptr<any_system> clone() const = 0;
  /// Force evaluations of this copy so far, of a black box: how many a derivative takes is known afterwards.
  virtual std::int64_t calls() const = 0;
  /// g = f'(q) v as directional_derivative() has it, of a black box.
  virtual void directional_derivative(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                      const Eigen::VectorXd& f, Eigen::VectorXd& g) const = 0;
  virtual normal_modes modes() const = 0;
  /// Of the system in a bath, or in none.
  virtual std::vector<frequency_band> frequency_bands(const bath* in) const = 0;
  /// Of a local system, else null.
  virtual const site_kernels* sites() const { return nullptr; }
  /// The system, as the letters that it declares find it.
  virtual const void* held() const = 0;
  /// p += c force(q) by the system's own kick.
  virtual void own_kick(const Eigen::VectorXd& q, Eigen::VectorXd& p, double c) const = 0;

 protected:
  /// Refers to the kernels, which a derived class holds.
  any_system(const kernels<double>& of_one, const kernels<lanes>& of_lanes, const kernels<slopes>& of_slopes,
             const kernels<lanes_with_slopes>& of_lanes_with_slopes)
      : kernels_(&of_one, &of_lanes, &of_slopes, &of_lanes_with_slopes) {}

 private:
  std::tuple<const kernels<double>*, const kernels<lanes>*, const kernels<slopes>*,
             const kernels<lanes_with_slopes>*>
      kernels_;
};

/// What is known of a system at run time; concepts say the same of the type.
struct model_facts : system_facts {
  Eigen::Index size = 0;
  double force_cost = 0.0;
  std::string description{};
  std::string base_description{};  ///< without its bath
  bath in = bath::of_sigma(0.0, 0.0);
  std::vector<double> inverse_masses{};       ///< empty: all are 1
  std::vector<double> inverse_root_masses{};  ///< 1/sqrt(inverse mass); empty: all are 1
  bool in_lanes = false;                      ///< over packs too
  bool in_lanes_with_slopes = false;
  bool has_potential = false;
  bool has_energy_over_slopes = false;  ///< over what carries derivatives by theta, in lanes or not
  bool has_differentiable_velocity = false;
  bool has_modes = false;
  bool has_quadratic_part = false;
  bool has_bands = false;
  bool has_own_kick = false;
  bool has_own_derivative = false;
  bool has_own_velocity = false;
  bool has_own_kinetic_energy = false;
  bool has_potential_over_slopes = false;
  bool has_kinetic_energy_over_slopes = false;
  bool has_velocity_over_slopes = false;
  bool may_be_wrong = false;                ///< force_may_be_wrong
  std::vector<letter_facts> own_letters{};  ///< that the system declares
  int derivative_calls = 1;
  const char* derivative_source = "";
  /// The letters that the system serves, over each scalar.
  std::string letters_over_double{};
  std::string letters_over_lanes{};
  std::string letters_over_slopes{};
  std::string letters_over_lanes_with_slopes{};

  template <Served T>
  bool serves(char letter) const {
    const std::string& letters = std::same_as<T, double>   ? letters_over_double
                                 : std::same_as<T, lanes>  ? letters_over_lanes
                                 : std::same_as<T, slopes> ? letters_over_slopes
                                                           : letters_over_lanes_with_slopes;
    return letters.find(letter) != std::string::npos;
  }
};

// Functions over double and over packs, without their types.

/// A state whose dimension is known at run time, as one of N coordinates.
template <int N, class T>
decltype(auto) of_dimension(const phase_point<T, Eigen::Dynamic>& x) {
  if constexpr (N == Eigen::Dynamic) {
    return x;
  } else {
    return phase_point<T, N>{x.q, x.p};
  }
}

/// Signature<double> and Signature<lanes> of one function; as std::function, perhaps empty.
template <template <class> class Signature>
class over_scalars : std::function<Signature<double>>, std::function<Signature<lanes>> {
  using of_one = std::function<Signature<double>>;
  using of_lanes = std::function<Signature<lanes>>;

 public:
  over_scalars() = default;
  /// A function that takes both, such as a lambda of `auto`.
  template <class F>
    requires(!std::derived_from<F, over_scalars> && std::constructible_from<of_one, F> &&
             std::constructible_from<of_lanes, F>)
  over_scalars(F f)  // NOLINT(google-explicit-constructor)
      : over_scalars(std::make_shared<const F>(std::move(f))) {}

  using of_lanes::operator();
  using of_one::operator();
  explicit operator bool() const { return static_cast<bool>(static_cast<const of_one&>(*this)); }

 private:
  /// One copy serves both.
  template <class F>
  explicit over_scalars(const std::shared_ptr<const F>& f)
      : of_one([f](const auto&... x) -> decltype(auto) { return (*f)(x...); }),
        of_lanes([f](const auto&... x) -> decltype(auto) { return (*f)(x...); }) {}
};

template <class T>
using reads_numbers = void(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result);
template <class T>
using of_state = T(const phase_point<T, Eigen::Dynamic>& x);
template <class T>
using of_sample = T(std::span<const T> numbers);
template <class T>
using of_two_samples = T(std::span<const T> seen, std::span<const T> reference);

}  // namespace nysalt::detail
