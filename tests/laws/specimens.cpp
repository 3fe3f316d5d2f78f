// SPDX-License-Identifier: BSL-1.0
// A new system is one line here: the system, and in which range around which state its motion stays bounded.
#include <algorithm>
#include <stdexcept>

#include "compiled_specimens.hpp"
#include "laws.hpp"
#include "models.hpp"

namespace nysalt::test {

namespace {

/// Coordinates in -reach..reach.
specimen within(double reach, const model& system) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  return {system, {zero, zero, reach}};
}

/// Atoms at rest.
specimen atoms(Eigen::Index space, Eigen::Index count) {
  const lennard_jones<> system(space, count);
  return {system, {detail::cluster_at_rest(system), Eigen::VectorXd::Zero(system.size()), 0.05}};
}

/// Four rows of three predictors.
logistic_regression a_posterior_of_rows() {
  const Eigen::MatrixXd rows{{1.0, 0.5, -2.0}, {1.0, -1.5, 0.3}, {1.0, 2.0, 1.0}, {1.0, 0.1, -0.7}};
  return {rows, Eigen::Vector4d(1.0, 0.0, 1.0, 0.0), 4.0};
}

/// Small swings split off.
auto split_pendulum() { return with_quadratic_part(pendulum(), Eigen::MatrixXd::Identity(1, 1)); }

}  // namespace

const std::vector<specimen>& specimens() {
  static const std::vector<specimen> all{
      within(1.0, harmonic_oscillator(1.7)),
      within(1.0, linear_chain::between_walls(4, 3.0)),
      within(1.0, free_chain()),  // with masses
      within(0.5, fpu_chain<3>(10.0)),
      within(0.5, fpu_chain<>(2, 7.0)),
      within(1.0, pendulum()),
      within(0.25, henon_heiles()),
      {kepler(), {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0), 0.2}},  // a circle
      atoms(2, 3),
      atoms(3, 5),
      within(1.0, phi4_chain<>(5)),
      within(0.5, phi4_lattice(3, -1.0, 2.0)),
      within(1.0, gaussian(Eigen::Vector3d(0.3, 1.0, 2.5))),
      within(1.0, a_posterior_of_rows()),
      within(1.0, dynamic_potential()),
      within(1.0, black_box()),
      within(1.0, black_box_with_derivative()),
      within(1.0, two_masses()),
      within(1.0, split_pendulum()),
      within(1.0, split_masses()),
      within(1.0, split_ring()),
      within(1.0, relativistic()),
      within(1.0, relativistic_with_velocity()),
  };
  return all;
}

const std::vector<specimen>& specimens_in_baths() {
  static const std::vector<specimen> all = [] {
    std::vector<specimen> result;
    const auto add = [&](const model& system, const bath& heat_bath) {
      auto one = specimen_of(describe(system));
      one.system = one.system.in(heat_bath);
      result.push_back(one);
    };
    add(fpu_chain<3>(10.0), bath::of_temperature(0.3, 0.02));
    add(free_chain(), bath::of_sigma(0.4, 0.3));  // with masses
    add(split_masses(), bath::of_temperature(1.0, 0.1));
    add(phi4_chain<>(5), bath::of_sigma(0.0, 0.2));  // noise without friction
    add(pendulum(), bath::of_sigma(0.5, 0.0));       // friction without noise
    add(black_box(), bath::of_temperature(0.5, 0.1));
    return result;
  }();
  return all;
}

std::vector<specimen> specimens_with(const std::function<bool(const model&)>& condition) {
  std::vector<specimen> result;
  for (const auto& one : specimens()) {
    if (condition(one.system)) result.push_back(one);
  }
  return result;
}

const specimen& specimen_of(const std::string& description) {
  for (const auto& one : specimens()) {
    if (describe(one.system).starts_with(description)) return one;
  }
  throw std::invalid_argument("no specimen is a " + description);
}

}  // namespace nysalt::test
