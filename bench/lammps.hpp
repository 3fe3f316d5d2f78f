// SPDX-License-Identifier: BSL-1.0
// LAMMPS in this process, where the machine has its library (Debian: lammps).
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/phase_point.hpp"

namespace nysalt::bench {

/// A Lennard-Jones liquid in a periodic cube, stepped by velocity Verlet: pair_style lj/cut, shifted, and a
/// neighbour list that is made when an atom has moved half the skin.
class lammps_liquid {
 public:
  /// Whether there is a library.
  static bool is_there();

  /// Throws std::runtime_error where there is no library, or if it does not take the system.
  lammps_liquid(double side, double cutoff, double skin, double step,
                const phase_point<double, Eigen::Dynamic>& start);

  void take_steps(std::int64_t steps);
  Eigen::VectorXd momenta() const;

 private:
  void command(const std::string& line);

  std::unique_ptr<void, void (*)(void*)> handle_;
  Eigen::Index atoms_;
};

}  // namespace nysalt::bench
