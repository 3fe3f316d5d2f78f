// SPDX-License-Identifier: BSL-1.0
// One function a bundled system; each is compiled in its own file below systems/.
#pragma once

#include <cstdint>
#include <memory>

#include "bundled_system.hpp"

namespace nysalt::program {

/// What a system is in, and where its trajectories start.
enum class start { law, gibbs, trajectory };
struct surroundings {
  nysalt::bath bath;
  program::start start;
  double spread = 1.0;  // of the law of starts: its deviations are multiplied by it
};

std::unique_ptr<bundled_system> make_fpu(std::int64_t pairs, double omega, const surroundings& conditions);
/// Of three pairs, whose soft springs hold omega^2 at the start.
std::unique_ptr<bundled_system> make_soft_dominated_fpu(double omega);
std::unique_ptr<bundled_system> make_oscillator(double omega, const surroundings& conditions);
std::unique_ptr<bundled_system> make_linear_chain(std::int64_t masses, double spring,
                                                  const surroundings& conditions);
std::unique_ptr<bundled_system> make_pendulum(const surroundings& conditions);
std::unique_ptr<bundled_system> make_henon_heiles(const surroundings& conditions);
std::unique_ptr<bundled_system> make_kepler(double eccentricity, const surroundings& conditions);
std::unique_ptr<bundled_system> make_lennard_jones(std::int64_t space, std::int64_t atoms,
                                                   const surroundings& conditions);
std::unique_ptr<bundled_system> make_phi4(std::int64_t masses, const surroundings& conditions);

}  // namespace nysalt::program
