// SPDX-License-Identifier: BSL-1.0
#include "user_system_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/ensemble.hpp"
#include "observables.hpp"
#include "progress.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

/// Refuses observables with the name of another.
void require_observables(const initial_value_problem& made, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& own : made.observables) {
    if (!is_plain_name(own.name)) {
      refuse(
          "{}: the name of an observable must be lower-case letters, digits and _, a letter first, got '{}'",
          name, own.name);
    }
    if (std::ranges::count(names, own.name) > 0 || is_built_in_observable(made, own.name)) {
      refuse("{}: observables must have different names, got '{}' twice; choose another name", name,
             own.name);
    }
    names.push_back(own.name);
  }
}

/// Refuses energies and forces that are not finite, and a force other than -grad V, at four starts.
void require_force(const initial_value_problem& made, const std::string& name) {
  // A force from a potential costs a potential for each coordinate. The force of a local system is the user's
  // own, and costs as much as a step.
  const Eigen::Index most = made.system.sites() != nullptr ? 1'000'000 : 2000;
  std::vector<Eigen::VectorXd> points;
  std::vector<Eigen::VectorXd> momenta;
  for (std::uint64_t n = 0; n < 4; ++n) {
    const auto start = sound_start(made.system, made.starts, 1, static_cast<std::int64_t>(n));
    points.push_back(start.q);
    momenta.push_back(start.p);
    auto f = detail::make_vector<double>(made.system);
    force<double>(made.system, start.q, f);
    if (!f.allFinite())
      refuse("{}: the force must be finite, got another value at start {}; check the force", name, n);
    if (has_energy(made.system) && !std::isfinite(energy<double>(made.system, start))) {
      refuse("{}: the energy must be finite, got another value at start {}; check the potential", name, n);
    }
  }
  if (size(made.system) > most) return;
  const force_check found = check_force(made.system, points, momenta);
  if (!found.passed()) refuse("cannot take {}: {}", name, found.report());
}

/// Of a system that declares no frequency: the highest frequency, or rate at which motions part, along some
/// starts; 0 where the force is the same at all of them, and where they do not show it.
double frequency_of(const initial_value_problem& made) {
  constexpr Eigen::Index most = 1000;  // coordinates
  if (size(made.system) > most) return 0.0;
  // A large system has many parts in each start, and its force may be one of pairs.
  constexpr Eigen::Index pairs = Eigen::Index{64} * 64 * 64;
  const std::int64_t count = std::clamp<Eigen::Index>(pairs / (size(made.system) * size(made.system)), 4, 64);
  std::vector<phase_point<double, Eigen::Dynamic>> starts;
  for (std::int64_t n = 0; n < count; ++n) starts.push_back(sound_start(made.system, made.starts, 1, n));
  double found = 0.0;
  if (has_quadratic_kinetic(made.system)) {
    const auto stiffness = hessian_spectrum(made.system, starts);
    found = std::sqrt(std::max({stiffness.highest, -stiffness.lowest, 0.0}));
  } else {
    found = detail::frequencies_of_states(made.system, starts).highest().frequency;
  }
  return std::isfinite(found) ? found : 0.0;
}

}  // namespace

bool is_plain_name(std::string_view name) {
  const auto is_allowed = [](char c) { return ('a' <= c && c <= 'z') || ('0' <= c && c <= '9') || c == '_'; };
  return !name.empty() && std::ranges::all_of(name, is_allowed) && name.front() >= 'a';
}

void examine(initial_value_problem& made, const std::string& name, examination how) {
  require_observables(made, name);
  if (!(made.frequency >= 0.0) || !std::isfinite(made.frequency)) {
    refuse("{}: frequency(...) must be positive and finite, got {}", name, made.frequency);
  }
  if (how == examination::none) return;
  progress shown;
  if (how == examination::whole) {
    shown.part("checking the force of " + name);
    require_force(made, name);
  }
  if (made.frequency != 0.0) return;
  shown.part("sampling frequencies of " + name);
  made.frequency = frequency_of(made);
}

}  // namespace nysalt::program
