// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/word_on_parts.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/stepping/served_letters.hpp"

namespace nysalt {

namespace {

using slopes = detail::slopes;

/// A letter about a state, with one of its coefficients and the step 1.
struct linear_letter {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd kick;  // by which it changes p
};

linear_letter linearise(const model& system, const nysalt::word& single, std::size_t slot, double by,
                        double step, const phase_point<double, Eigen::Dynamic>& state) {
  std::vector<slopes> coefficients(single.slots, slopes(0.0));
  coefficients[slot] = slopes(by);
  const stepper<model, slopes> steps(system, single, coefficients, step);
  const Eigen::Index n = state.q.size();
  linear_letter result{Eigen::MatrixXd(2 * n, 2 * n), Eigen::VectorXd(n)};
  constexpr Eigen::Index at_once = detail::directions_at_a_time;
  for (Eigen::Index column = 0; column < 2 * n; column += at_once) {
    auto x = state.cast<slopes>();
    const Eigen::Index count = std::min(at_once, 2 * n - column);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index j = column + k;
      (j < n ? x.q[j] : x.p[j - n]).derivative[static_cast<std::size_t>(k)] = 1.0;
    }
    steps.step(x);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < count; ++k) {
        result.jacobian(i, column + k) = x.q[i].derivative[static_cast<std::size_t>(k)];
        result.jacobian(n + i, column + k) = x.p[i].derivative[static_cast<std::size_t>(k)];
      }
      result.kick[i] = x.p[i].value - state.p[i];
    }
  }
  return result;
}

bool is_near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  constexpr double rounding = 1e-9;
  const double scale = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  return (a - b).cwiseAbs().maxCoeff() <= rounding * scale;
}

bool is_identity(const Eigen::MatrixXd& a) {
  return is_near(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

/// Number of states whose products of matrices take some milliseconds together.
std::size_t most_states(Eigen::Index n) {
  constexpr double operations = 1e6;
  const auto size = static_cast<double>(2 * n);
  return static_cast<std::size_t>(std::max(operations / (size * size * size), 1.0));
}

/// A Hessian in coordinates in which K'' = root root^T is the identity.
Eigen::MatrixXd weighted(const Eigen::MatrixXd& root, const Eigen::MatrixXd& hessian) {
  const Eigen::MatrixXd product = root.transpose() * hessian * root;
  return 0.5 * (product + product.transpose());
}

using state = phase_point<double, Eigen::Dynamic>;

}  // namespace

/// The linearised motion about a state, in coordinates in which K'' is the identity.
struct detail::word_on_parts::motion {
  Eigen::MatrixXd whole;                // V''
  Eigen::VectorXd force;                // -V'
  std::vector<Eigen::MatrixXd> parts;   // V'' of each slot of a kick
  std::vector<Eigen::VectorXd> forces;  // by which each slot of a kick changes p

  static motion mean(const std::vector<motion>& all) {
    motion sum = all.front();
    const auto count = static_cast<double>(all.size());
    for (std::size_t k = 1; k < all.size(); ++k) {
      sum.whole += all[k].whole;
      sum.force += all[k].force;
      for (std::size_t i = 0; i < sum.parts.size(); ++i) {
        sum.parts[i] += all[k].parts[i];
        sum.forces[i] += all[k].forces[i];
      }
    }
    sum.whole /= count;
    sum.force /= count;
    for (auto& part : sum.parts) part /= count;
    for (auto& force : sum.forces) force /= count;
    return sum;
  }
};

detail::word_on_parts::word_on_parts(const model& system, const phase_points& states,
                                     const nysalt::word& word)
    : word_(word.letters()), slots_(word.slots) {
  if (states.size() == 0) {
    why_not_ = "there are no states";
  } else if (word.is_processed()) {
    why_not_ = "it has a processor";
  } else if (nysalt::size(system) > detail::most_for_all_frequencies) {
    why_not_ = sentence("of more than {} degrees of freedom", detail::most_for_all_frequencies);
  } else {
    try {
      examine(system.base(), states, kinds_of(system.base(), word));
    } catch (const std::invalid_argument& missing) {
      why_not_ = missing.what();
    }
  }
}

std::vector<nysalt::word> detail::word_on_parts::kinds_of(const model& system, const nysalt::word& word) {
  std::string names;
  std::vector<nysalt::word> kinds;
  for (std::size_t i = 0; i < word.length; ++i) {
    const char name = word.letters()[i];
    if (name == ornstein_uhlenbeck::letter) continue;
    letters_.push_back({std::min(names.find(name), names.size()), word.first_slot(i), word.slots_of(i)});
    if (letters_.back().kind < names.size()) continue;
    names += name;
    kinds.push_back(word.with_letters(std::string(1, name)));
    require_served<model, slopes>(kinds.back(), system);
  }
  kinds_.resize(kinds.size());
  return kinds;
}

void detail::word_on_parts::add_letter(const model& system, const nysalt::word& single, kind& of,
                                       const state& at, const Eigen::MatrixXd& root, motion& to) {
  const Eigen::Index n = at.q.size();
  for (std::size_t slot = 0; slot < single.slots; ++slot) {
    const auto one = linearise(system, single, slot, 1.0, 1.0, at);
    const auto less = linearise(system, single, slot, 0.5, 0.5, at);
    const Eigen::MatrixXd to_q = one.jacobian.topRightCorner(n, n);
    const Eigen::MatrixXd to_p = one.jacobian.bottomLeftCorner(n, n);
    const bool keeps = one.jacobian.allFinite() && is_identity(one.jacobian.topLeftCorner(n, n)) &&
                       is_identity(one.jacobian.bottomRightCorner(n, n));
    const bool is_drift = keeps && single.slots == 1 && to_p.isZero(0.0) &&
                          is_near(to_q, root * root.transpose()) &&
                          is_near(less.jacobian.topRightCorner(n, n), 0.25 * to_q);
    const bool is_kick = keeps && to_q.isZero(0.0) && is_near(to_p, to_p.transpose()) &&
                         is_near(less.jacobian.bottomLeftCorner(n, n), 0.25 * to_p);
    if (!is_kick && !is_drift) {
      throw std::invalid_argument(sentence("the letter {} is neither a drift nor a kick", single.letters()));
    }
    of.drifts = is_drift && !is_kick;
    if (slot == 0) of.first_kick = to.parts.size();
    if (!is_kick) continue;
    to.parts.push_back(weighted(root, -to_p));
    to.forces.push_back(root.transpose() * one.kick);
  }
}

void detail::word_on_parts::examine(const model& system, const phase_points& states,
                                    const std::vector<nysalt::word>& kinds) {
  constexpr std::size_t enough = 8;  // for a mean, and to say how far they lie apart
  const std::size_t some = std::min(states.size(), enough);
  detail::force_jacobian jacobian(system, states);
  std::vector<motion> motions(some);
  double momenta = 0.0;
  for (std::size_t k = 0; k < some; ++k) {
    const state at = states[k * states.size() / some];
    const Eigen::MatrixXd root = detail::kinetic_factor(system, at.p);
    if (root.size() == 0) throw std::invalid_argument("K''(p) is not positive semidefinite");
    for (std::size_t s = 0; s < kinds.size(); ++s)
      add_letter(system, kinds[s], kinds_[s], at, root, motions[k]);
    motions[k].whole = weighted(root, jacobian.potential_hessian(at.q));
    Eigen::VectorXd f(at.q.size());
    system.force(at.q, f);
    motions[k].force = root.transpose() * f;
    momenta += (root.transpose() * at.p).squaredNorm();
  }
  const motion mean = motion::mean(motions);
  mean_ = diagonal(mean);
  double farthest = 0.0;
  for (const auto& one : motions)
    farthest = std::max(farthest, (one.whole - mean.whole).cwiseAbs().rowwise().sum().maxCoeff());
  has_mean_ = farthest < 0.5 * mean_.squares[mean_.squares.size() - 1];
  amplitude_ = std::sqrt(2.0 * momenta / static_cast<double>(some));
  const std::size_t half = (some + 1) / 2;  // near the mean fewer are enough
  const std::size_t examined = std::min(has_mean_ ? half : some, most_states(mean_.squares.size()));
  for (std::size_t k = 0; k < examined; ++k) at_.push_back(diagonal(motions[k * some / examined]));
}

/// Forces about the equilibrium, where the whole force is zero.
detail::word_on_parts::linearised detail::word_on_parts::diagonal(const motion& about) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(about.whole);
  const Eigen::MatrixXd& basis = solver.eigenvectors();
  linearised result{.squares = solver.eigenvalues(), .stiffness = {}, .force = {}};
  Eigen::VectorXd rest = basis.transpose() * about.force;
  for (Eigen::Index i = 0; i < rest.size(); ++i)
    rest[i] = result.squares[i] > 0.0 ? rest[i] / result.squares[i] : 0.0;
  for (std::size_t k = 0; k < about.parts.size(); ++k) {
    result.stiffness.push_back(basis.transpose() * about.parts[k] * basis);
    result.force.push_back(basis.transpose() * about.forces[k] - result.stiffness[k] * rest);
  }
  return result;
}

void detail::word_on_parts::apply(const linearised& at, const std::vector<double>& coefficients, double step,
                                  Eigen::Ref<Eigen::MatrixXd> x, Eigen::VectorXd* affine) const {
  const Eigen::Index m = x.rows() / 2;
  const Eigen::VectorXd root = at.squares.tail(m).cwiseSqrt();
  const Eigen::VectorXd inverse = root.cwiseInverse();
  for (const auto& one : letters_) {
    const kind& of = kinds_[one.kind];
    if (of.drifts) {
      const double by = step * coefficients[one.first_slot];
      x.topRows(m) += by * (root.asDiagonal() * x.bottomRows(m));
      if (affine != nullptr) affine->head(m) += by * root.cwiseProduct(affine->tail(m));
      continue;
    }
    for (std::size_t k = 0; k < one.slots; ++k) {
      const double by = step * coefficients[one.first_slot + k];
      const Eigen::MatrixXd kick =
          at.stiffness[of.first_kick + k].bottomRightCorner(m, m) * inverse.asDiagonal();
      x.bottomRows(m) -= by * (kick * x.topRows(m));
      if (affine == nullptr) continue;
      affine->tail(m) += by * (at.force[of.first_kick + k].tail(m) - kick * affine->head(m));
    }
  }
}

namespace {
Eigen::Index modes_that_turn(const Eigen::VectorXd& squares, double step) {
  Eigen::Index count = 0;
  for (const double square : squares)
    count += square > 0.0 && std::abs(step) * std::sqrt(square) > detail::word_on_parts::least_turn ? 1 : 0;
  return count;
}
}  // namespace

Eigen::MatrixXd detail::word_on_parts::step(const std::vector<double>& coefficients, double step,
                                            std::size_t state) const {
  if (coefficients.size() != slots_) {
    throw std::invalid_argument(
        sentence("word_on_parts: coefficients must be {}, got {}", slots_, coefficients.size()));
  }
  const linearised& at = of_state(state);
  const Eigen::Index m = modes_that_turn(at.squares, step);
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(2 * m, 2 * m);
  apply(at, coefficients, step, result, nullptr);
  return result;
}

detail::growth_of_energy detail::word_on_parts::growth(const std::vector<double>& coefficients, double by,
                                                       std::int64_t steps) const {
  const auto excess = [](double norm) { return norm * norm - 1.0; };
  const auto at = [&](std::size_t state) {
    const Eigen::MatrixXd m = step(coefficients, by, state);
    detail::growth_of_energy result{.early = 0.0, .late = 0.0, .state = state};
    if (m.size() == 0) return result;
    result.late = excess(detail::largest_power(m, steps));
    // What is little as a whole has not grown.
    result.early =
        result.late <= detail::growth_of_energy::smallest
            ? result.late
            : excess(detail::largest_power(m, std::min(steps, detail::growth_of_energy::early_steps)));
    return result;
  };
  detail::growth_of_energy over_states;
  double largest = -1.0;
  const auto average = [&] {
    for (std::size_t k = 0; k < states(); ++k) {
      const auto one = at(k);
      over_states.early += one.early / static_cast<double>(states());
      over_states.late += one.late / static_cast<double>(states());
      if (one.late <= largest) continue;
      largest = one.late;
      over_states.state = k;
    }
  };
  if (!has_mean_) {
    average();
    return over_states;
  }
  const detail::growth_of_energy of_mean = at(states());
  if (of_mean.is_refused()) return of_mean;
  average();
  return over_states.is_worse_than(of_mean) ? over_states : of_mean;
}

double detail::word_on_parts::displacement(const std::vector<double>& coefficients, double step) const {
  if (!has_mean_ || !(amplitude_ > 0.0)) return 0.0;
  const Eigen::Index m = modes_that_turn(mean_.squares, step);
  if (m == 0) return 0.0;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(2 * m, 2 * m);
  Eigen::VectorXd affine = Eigen::VectorXd::Zero(2 * m);
  apply(mean_, coefficients, step, matrix, &affine);
  const Eigen::MatrixXd away = Eigen::MatrixXd::Identity(2 * m, 2 * m) - matrix;
  const double moved = away.fullPivLu().solve(affine).norm() / amplitude_;
  return std::isfinite(moved) ? moved : std::numeric_limits<double>::infinity();
}

}  // namespace nysalt
