// SPDX-License-Identifier: BSL-1.0
// Functions over double and over packs, without their types.
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "nysalt/detail/kernels.hpp"

namespace nysalt::detail {

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
