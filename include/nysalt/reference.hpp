// SPDX-License-Identifier: BSL-1.0
// The exact flow, as nearly as it is to be had, with its error known.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <string>

#include "nysalt/system.hpp"

namespace nysalt {

/// advance(system, x, t)  x becomes the state a time t later
/// finer()                the same with a much smaller error: the difference measures the error of this one
/// description()          what it is, with its step or tolerance
template <class R, class S>
concept ReferenceFlow = SeparableSystem<S> &&
    requires(const R& reference, const S& system, phase_point<double, S::dimension>& x) {
  reference.advance(system, x, 1.0);
  { reference.finer() } -> std::same_as<R>;
  { reference.description() } -> std::convertible_to<std::string>;
};

/// Largest coordinate of the difference between a reference and its finer self after a time t from x.
template <SeparableSystem S, ReferenceFlow<S> R>
double reference_error(const S& system, const R& reference, const phase_point<double, S::dimension>& x,
                       double t) {
  auto a = x;
  auto b = x;
  reference.advance(system, a, t);
  reference.finer().advance(system, b, t);
  return std::max((a.q - b.q).cwiseAbs().maxCoeff(), (a.p - b.p).cwiseAbs().maxCoeff());
}

}  // namespace nysalt
