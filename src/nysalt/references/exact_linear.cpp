// SPDX-License-Identifier: BSL-1.0
#include "nysalt/references/exact_linear.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "nysalt/force.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

class exact_flow_of_modes {
 public:
  explicit exact_flow_of_modes(const model& system) : system_(system.description()) {
    if (system.bath().acts()) {
      throw std::invalid_argument(
          fmt::format("exact_linear: the system must be in no bath, got {}", system_));
    }
    if (!has_modes(system) || !has_quadratic_kinetic(system)) {
      throw std::invalid_argument(fmt::format(
          "exact_linear: the system must declare modes() and have a quadratic kinetic energy, got {}; take "
          "fine_steps or odeint_reference",
          system_));
    }
    require_orthonormal(system.modes(), system.size());
    modes_ = detail::modal_coordinates::of(system);
    require_linear(system);
  }

  template <class T>
  std::int64_t advance(const model& system, phase_point<T, Eigen::Dynamic>& point, double t) const {
    if (system.description() != system_) {
      throw std::invalid_argument(fmt::format(
          "exact_linear: the system must be the one that the reference was made for, {}, got {}; make an "
          "exact_linear of this system",
          system_, system.description()));
    }
    vector<T, Eigen::Dynamic> x(modes_->size());
    vector<T, Eigen::Dynamic> y(modes_->size());
    modes_->to_modes(point.q, point.p, x, y);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double w = modes_->frequencies()[static_cast<std::size_t>(k)];
      const double c = std::cos(w * t);
      const double s = std::sin(w * t);
      const T x_new = x[k] * c + y[k] * (w == 0.0 ? t : s / w);
      y[k] = x[k] * (-w * s) + y[k] * c;
      x[k] = x_new;
    }
    modes_->from_modes(x, y, point.q, point.p);
    return 0;
  }

  exact_flow_of_modes finer() const { return *this; }
  std::string description() const { return "the exact linear flow"; }

 private:
  void require_orthonormal(const normal_modes& modes, Eigen::Index n) const {
    const bool fit = modes.basis.rows() == n && modes.basis.cols() == n && modes.frequencies.size() == n;
    // n products of numbers below 1, and as much again for how the basis was found.
    if (fit &&
        (modes.basis.transpose() * modes.basis - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() <=
            32.0 * static_cast<double>(n) * eps) {
      return;
    }
    throw std::invalid_argument(fmt::format(
        "exact_linear: modes() of {} must give {} orthonormal columns with a frequency each", system_, n));
  }

  /// Compares the force with -M^{1/2} U w^2 U^T M^{1/2} q at points in general position, of sizes so
  /// different that a term that is not linear cannot be small at all of them.
  void require_linear(const model& system) const {
    const Eigen::Index n = modes_->size();
    const Eigen::Map<const Eigen::VectorXd> omega(modes_->frequencies().data(), n);
    const Eigen::VectorXd squares = omega.cwiseAbs2();
    Eigen::VectorXd root_mass(n);
    for (Eigen::Index i = 0; i < n; ++i) root_mass[i] = 1.0 / std::sqrt(system.inverse_mass(i));
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd q(n);
    Eigen::VectorXd f(n);
    Eigen::VectorXd x(n);
    Eigen::VectorXd y(n);
    Eigen::VectorXd back(n);
    Eigen::VectorXd expected(n);
    for (const double length : {1e-2, 1.0, 1e2}) {
      for (int point = 0; point < 3; ++point) {
        for (Eigen::Index i = 0; i < n; ++i) {
          q[i] = length * std::sin(1.0 + 2.0 * point + 1.7 * static_cast<double>(i));
        }
        force<double>(system, q, f);
        modes_->to_modes(q, rest, x, y);
        y = -squares.cwiseProduct(x);
        modes_->from_modes(x, y, back, expected);
        // Both sides sum n terms, together below w^2 |M^{1/2} q|_1, and the modes err by some n eps.
        const double rounding =
            32.0 * static_cast<double>(n) * eps * squares.maxCoeff() * root_mass.cwiseProduct(q).lpNorm<1>();
        for (Eigen::Index i = 0; i < n; ++i) {
          if (std::abs(f[i] - expected[i]) <= rounding * root_mass[i]) continue;  // also refuses NaN
          throw std::invalid_argument(fmt::format(
              "exact_linear: the force of {} must be linear as modes() says, got coordinate {} off by "
              "{:.2e} of {:.2e} at a state of size {}; take fine_steps or odeint_reference",
              system_, i + 1, f[i] - expected[i], expected[i], length));
        }
      }
    }
  }

  std::string system_;
  std::shared_ptr<const detail::modal_coordinates> modes_;
};

}  // namespace

reference exact_linear(const model& system) { return exact_flow_of_modes(system); }

}  // namespace nysalt
