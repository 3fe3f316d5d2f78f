// SPDX-License-Identifier: BSL-1.0
// The properties that tests try on every system and every method, as functions of values, compiled once. A
// function ..._broken or ..._defect returns how far a property is violated, in units of what rounding may do:
// above 1 it is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../support/draws.hpp"
#include "../support/noises.hpp"
#include "../support/rounding.hpp"
#include "nysalt/family.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt::test {

using any_state = phase_point<double, Eigen::Dynamic>;

/// A system, and where random states of it are drawn. What it declares, model::facts() says.
struct specimen {
  model system;
  around reach;
  any_state at_random(draws& random) const { return random.state(system, reach); }
};

/// All systems that properties are tried on. A new one is one line in specimens.cpp.
const std::vector<specimen>& specimens();
/// Some of them in baths.
const std::vector<specimen>& specimens_in_baths();
/// The specimens that satisfy a condition.
std::vector<specimen> specimens_with(const std::function<bool(const model&)>& condition);
/// The specimen whose description begins so.
const specimen& specimen_of(const std::string& description);

/// Derivatives of the force are exact, not differences.
bool has_exact_derivatives(const model& system);
/// The system serves the letters of the method and, where `over_slopes`, with derivatives; its kinetic energy
/// gives the method its order; and the method has letters O where the system is in a bath that acts.
bool suits(const model& system, const nysalt::method& method, bool over_slopes = true);

/// Methods for systems without a bath: rows of the classical table, members of the families drawn at random,
/// adaptive ones at a random z; baoab, too, whose letter O is then deleted.
std::vector<nysalt::method> methods_as_data(draws& random);
/// All families. A new one is one name in a list of models.hpp.
const std::vector<nysalt::family>& families_as_data();
/// A theta well inside the ranges and near the start, where coefficients are of moderate size.
Eigen::VectorXd random_theta(const nysalt::family& family, draws& random);
/// Methods with letters O in the middle, at either end, at both, several, and next to each other.
std::vector<nysalt::method> methods_for_baths(draws& random);

using trial = std::function<void(const model&, const nysalt::method&, double step, const any_state&)>;
/// Calls f for each specimen and each method that suits it, at a random state and at a quarter of a radian of
/// the fastest motion there.
void try_all(const std::vector<specimen>& on, const std::vector<nysalt::method>& methods, const trial& f);
/// The same for methods_as_data(), repeated with new members of the families and new states.
void try_all_methods(const std::vector<specimen>& on, int times, const trial& f);

shears shears_at(const model& system, const any_state& x);

// What one step of a method keeps.

/// J^T Omega J = Omega; in a bath e^{-gamma h} Omega.
double symplecticity_broken(const model& system, const nysalt::method& method, double step,
                            const any_state& x);
/// The same of the explicit Euler method, which is not symplectic.
double symplecticity_broken_by_euler(const model& system, double step, const any_state& x);
double volume_broken(const model& system, const nysalt::method& method, double step, const any_state& x);
double reversibility_broken(const model& system, const nysalt::method& method, double step,
                            const any_state& x);

// Runs.

/// None, fresh noise, or the noise of a path, that is, with numbers of its own for each letter.
using any_noise = std::variant<no_noise, fresh_noise, noise_of_a_path>;

struct run_of {
  const model& system;
  const nysalt::method& method;
  double step;
  any_noise noise{};
  std::uint64_t trajectory = 0;

  /// Where a run from x is, as one go.
  any_state finish(const any_state& x, std::int64_t steps) const;
  /// The same, looked at by integrate().
  any_state observed(const any_state& x, std::int64_t steps, std::int64_t every) const;
  /// The same, by an advance that shows states on the way, each of which must be the synchronous state there.
  any_state watched(const any_state& x, std::int64_t steps, std::int64_t every) const;
  /// The same, cut in two, where the open run is all that is kept.
  any_state cut(const any_state& x, std::int64_t steps, std::int64_t first) const;
  /// A run that is closed and opened anew at every step: what observing must not do.
  any_state reopened(const any_state& x, std::int64_t steps) const;
  /// Plain steps, the first with the noise of step `begin`.
  any_state plain(const any_state& x, std::int64_t steps, std::int64_t begin = 0) const;
  /// Whether trajectories side by side have the bits of each alone, whose number begins there.
  bool lanes_are_alone(const specimen& from, draws& random, std::int64_t steps = 31,
                       std::uint64_t first = 40) const;
  /// How far the merged run is from plain steps.
  double merging_broken(const any_state& x, std::int64_t steps) const;
};

// The order of a method.

/// Starts, and where they are a time later by a reference that shares nothing with our steps.
struct solved {
  solved(const model& of, std::vector<any_state> starts, double after);
  model system;
  std::vector<any_state> start;
  std::vector<any_state> finish;
  double time;
};
/// A word and its coefficients, wherever their order holds.
struct table {
  nysalt::word word;
  std::vector<double> coefficients;
  table(const nysalt::word& letters, const std::vector<double>& c) : word(letters), coefficients(c) {}
  table(const nysalt::method& method) : table(method.letters(), method.coefficients()) {}
};
/// Slope of log error against log step, to 0.15 if the first steps are below 1/4 of the fastest motion's time
/// scale. `at(h)` is the method at the step h.
double measured_order(const solved& problem, const std::function<table(double)>& at, std::int64_t steps);
double measured_order(const solved& problem, const table& method, std::int64_t steps);

// Systems.

/// force = -grad V.
double gradient_defect(const model& system, const Eigen::VectorXd& q);
/// M^{-1/2} V''(0) M^{-1/2} = U diag(w^2) U^T with orthonormal U.
double modes_defect(const model& system, const normal_modes& modes);
/// The force is that of the quadratic part and `factor` times the soft force.
double soft_force_defect(const model& system, const Eigen::VectorXd& q, double factor = 1.0);
/// How far the frequencies of the linearised motion at q are outside the bands, relative to the highest.
double band_defect(const model& system, const std::vector<frequency_band>& bands, const Eigen::VectorXd& q);
/// Where Boost.Odeint leads in that time, and the evaluations of the force that this takes.
std::pair<any_state, std::int64_t> by_odeint(const model& system, any_state x, double time, double tolerance);
/// Change of the energy from x to y by a reference that made that many evaluations, each with at most `error`
/// in a coordinate.
double energy_defect(const model& system, const any_state& x, const any_state& y, std::int64_t evaluations,
                     double error);

}  // namespace nysalt::test
