// SPDX-License-Identifier: BSL-1.0
// A Hamiltonian that is defined by functions of numbers: for the commands a system like any other.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "../src/comparison/prepared_problem.hpp"

namespace nysalt::python {

/// H = sum p_i^2 / (2 m_i) + V(q), known over double only: derivatives of the force are differences.
struct own_functions {
  std::string name;
  std::int64_t dimension = 0;
  std::vector<double> inverse_masses;
  std::function<double(std::span<const double> q)> potential;
  std::function<void(std::span<const double> q, std::span<double> f)> force;
  /// The same of `count` states at a time, one after the other; empty of a system that takes one at a time.
  std::function<void(std::span<const double> q, std::int64_t count, std::span<double> v)> potentials = {};
  std::function<void(std::span<const double> q, std::int64_t count, std::span<double> f)> forces = {};
  /// The start of trajectory n: a function of both numbers only.
  std::function<void(std::uint64_t seed, std::uint64_t n, std::span<double> q, std::span<double> p)> start;
  std::string kind = {};   // the name without the size; empty: the name
  double frequency = 0.0;  // the highest of the motion; 0: not known yet
};

/// Checks for a force that is not -grad V at four starts, and where the frequency is not known for that of 64
/// starts. Throws refusal for what is found. Cost: some hundred forces for each degree of freedom.
void examine(own_functions& functions);

/// `count` copies in a bath as one system, whose force is one call. The functions must take many states.
model side_by_side(const std::shared_ptr<const own_functions>& functions, std::int64_t count,
                   const bath& heat_bath);

/// One trajectory at a time. The functions are called by the thread that computes.
std::unique_ptr<program::prepared_problem> make_own(std::shared_ptr<const own_functions> functions,
                                                    const program::surroundings& in);

}  // namespace nysalt::python
