// SPDX-License-Identifier: BSL-1.0
#include "power_spectrum.hpp"

#include <algorithm>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <utility>

namespace nysalt::sampling_benchmark {

void power_spectrum(const Eigen::VectorXd& q, Eigen::Index side, Eigen::VectorXd& spectrum) {
  thread_local Eigen::FFT<double> transform;  // it keeps its tables
  Eigen::MatrixXcd all(side, side);           // column k: that mode of each row
  Eigen::VectorXcd modes(side);
  Eigen::VectorXcd line(side);
  for (Eigen::Index r = 0; r < side; ++r) {
    line = q.segment(r * side, side).cast<std::complex<double>>();
    transform.fwd(modes, line);
    all.row(r) = modes.transpose();
  }
  spectrum.resize(q.size());
  for (Eigen::Index k = 0; k < side; ++k) {
    line = all.col(k);
    transform.fwd(modes, line);
    for (Eigen::Index r = 0; r < side; ++r)
      spectrum[r * side + k] = std::norm(modes[r]) / static_cast<double>(side * side);
  }
}

Eigen::VectorXd over_symmetries(const Eigen::VectorXd& of_modes, Eigen::Index side) {
  const auto representative = [&](Eigen::Index r, Eigen::Index c) {
    const auto [low, high] = std::minmax({std::min(r, (side - r) % side), std::min(c, (side - c) % side)});
    return low * side + high;
  };
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(of_modes.size());
  Eigen::VectorXd counts = sums;
  for (Eigen::Index r = 0; r < side; ++r) {
    for (Eigen::Index c = 0; c < side; ++c) {
      sums[representative(r, c)] += of_modes[r * side + c];
      counts[representative(r, c)] += 1.0;
    }
  }
  Eigen::VectorXd result(of_modes.size());
  for (Eigen::Index r = 0; r < side; ++r) {
    for (Eigen::Index c = 0; c < side; ++c) {
      const Eigen::Index at = representative(r, c);
      result[r * side + c] = sums[at] / counts[at];
    }
  }
  return result;
}

}  // namespace nysalt::sampling_benchmark
