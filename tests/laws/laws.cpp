// SPDX-License-Identifier: BSL-1.0
#include "laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "../support/dense.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/systems/counted.hpp"

namespace nysalt::test {

namespace {

using slopes = detail::slopes;
using columns = vector<slopes, Eigen::Dynamic>;

columns lifted(const Eigen::VectorXd& x) {
  columns result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = slopes(x[i]);
  return result;
}

/// Derivative of a map of vectors, two columns at a time.
Eigen::MatrixXd derivative_of(const auto& map, const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  columns argument = lifted(x);
  columns result = argument;
  Eigen::MatrixXd all(n, n);
  for (Eigen::Index first = 0; first < n; first += 2) {
    const Eigen::Index count = std::min<Eigen::Index>(2, n - first);
    for (int k = 0; k < count; ++k) argument[first + k] = slopes::variable(x[first + k], k);
    map(argument, result);
    for (int k = 0; k < count; ++k) {
      argument[first + k] = slopes(x[first + k]);
      for (Eigen::Index i = 0; i < n; ++i)
        all(i, first + k) = result[i].derivative[static_cast<std::size_t>(k)];
    }
  }
  return all;
}

Eigen::MatrixXd hessian_of(const model& system, const Eigen::VectorXd& q) {
  return -derivative_of([&](const auto& x, auto& f) { system.kernels<slopes>().force(field::whole, x, f); },
                        q);
}

/// Jacobian of a map of phase space over slopes, in the order (q, p).
Eigen::MatrixXd jacobian_of(const auto& map, const any_state& x) {
  const Eigen::Index n = x.size();
  Eigen::VectorXd both(2 * n);
  both << x.q, x.p;
  return derivative_of(
      [&](const columns& from, columns& to) {
        phase_point<slopes, Eigen::Dynamic> y{from.head(n), from.tail(n)};
        map(y);
        to << y.q, y.p;
      },
      both);
}

/// f(stepper), of double or of slopes.
template <Scalar C, class Noise>
auto with_stepper(const model& system, const method& method, double step, const Noise& noise, const auto& f) {
  const auto c = method.coefficients();
  return f(stepper<model, C, Noise>(system, method.letters(), {c.begin(), c.end()}, step, noise));
}

/// J of a plain step; the noise of its bath, which J does not depend on, is fresh.
Eigen::MatrixXd jacobian_of_step(const model& system, const method& method, double step, const any_state& x) {
  return with_stepper<slopes>(system, method, step, fresh_noise(1), [&](const auto& fixed) {
    return jacobian_of([&](auto& y) { fixed.step(y); }, x);
  });
}

/// Rounding of a Jacobian: each of its letters rounds every entry, twice, and later ones magnify it; the
/// products with Omega and the transpose add 2 n terms of the square of that size.
double jacobian_rounding(Eigen::Index n, double letters, double magnified) {
  return 4.0 * static_cast<double>(n) * letters * eps * magnified * magnified;
}

double off_omega(const Eigen::MatrixXd& j, double factor) {
  const Eigen::Index n = j.rows() / 2;
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  omega.topRightCorner(n, n).setIdentity();
  omega.bottomLeftCorner(n, n).diagonal().setConstant(-1.0);
  return (j.transpose() * omega * j - factor * omega).cwiseAbs().maxCoeff();
}

Eigen::VectorXd root_inverse_masses(const model& system) {
  Eigen::VectorXd root(system.size());
  for (Eigen::Index i = 0; i < root.size(); ++i) root[i] = std::sqrt(system.inverse_mass(i));
  return root;
}

Eigen::MatrixXd weighted_hessian(const model& system, const Eigen::VectorXd& q) {
  const Eigen::VectorXd root = root_inverse_masses(system);
  return root.asDiagonal() * hessian_of(system, q) * root.asDiagonal();
}

Eigen::VectorXd force_at(const model& system, const Eigen::VectorXd& q) {
  Eigen::VectorXd f(q.size());
  system.force(q, f);
  return f;
}

}  // namespace

shears shears_at(const model& system, const any_state& x) {
  const auto& over = system.kernels<slopes>();
  const Eigen::MatrixXd whole = hessian_of(system, x.q);
  const auto rate = [&](const auto& p, auto& v) { over.velocity(p, v); };
  shears result{norm(whole), norm(derivative_of(rate, x.p)), 0.0};
  if (system.facts().has_quadratic_part) {
    const auto minus = [&](const auto& q, auto& f) { over.force(field::soft, q, f); };
    const Eigen::MatrixXd soft = -derivative_of(minus, x.q);
    result.potential = std::max({result.potential, norm(soft), norm(whole - soft)});
  }
  if (has_quadratic_kinetic(system) && !detail::is_black_box(system)) {
    detail::lifted_room<slopes, Eigen::Dynamic> room(x.size());
    const auto f_along_f = [&](const auto& q, auto& g) {
      columns f = q;
      columns v = q;
      over.force(field::whole, q, f);
      over.velocity(f, v);
      over.force_along(field::whole, q, v, g, room, detail::part_of_displacement);
    };
    result.gradient = norm(derivative_of(f_along_f, x.q));
  }
  return result;
}

// Trials.

bool has_exact_derivatives(const model& system) {
  return !detail::is_black_box(system) || system.facts().has_own_derivative;
}

bool suits(const model& system, const method& method, bool over_slopes) {
  const auto& facts = system.facts();
  if (method.requires_quadratic_kinetic && !facts.has_quadratic_kinetic) return false;
  if (facts.in.acts() && method.letters().stochastic_letters == 0) return false;
  for (const char letter : method.letters().letters()) {
    if (letter == nysalt::word::processor_mark) continue;
    if (!facts.serves<double>(letter)) return false;
    if (over_slopes && !facts.serves<slopes>(letter)) return false;
    // A black box serves gradient kicks, but their derivatives are differences.
    if (over_slopes && facts.is_black_box && (letter == 'G' || letter == 'H')) return false;
  }
  return true;
}

static void try_each(const std::vector<specimen>& on, int times, const auto& methods, const trial& f) {
  draws random;
  for (const auto& one : on) {
    for (int n = 0; n < times; ++n) {
      for (const auto& method : methods(random)) {
        if (!suits(one.system, method)) continue;
        const auto x = one.at_random(random);
        BOOST_TEST_CONTEXT(method.name() << " on " << describe(one.system) << ", draw " << n) {
          f(one.system, method, 0.25 / shears_at(one.system, x).frequency(), x);
        }
      }
    }
  }
}
void try_all(const std::vector<specimen>& on, const std::vector<method>& methods, const trial& f) {
  try_each(
      on, 1, [&](draws&) { return methods; }, f);
}
void try_all_methods(const std::vector<specimen>& on, int times, const trial& f) {
  try_each(on, times, methods_as_data, f);
}

// Steps.

double symplecticity_broken(const model& system, const method& method, double step, const any_state& x) {
  const auto& word = method.letters();
  const auto c = method.coefficients();
  double in_bath = 0.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (word.letters()[i] == 'O') in_bath += c[word.first_slot(i)];
  }
  const double factor = system.bath().acts() ? system.bath().decay(in_bath * step) : 1.0;
  const double magnified = transient_growth(method, step, shears_at(system, x));
  return off_omega(jacobian_of_step(system, method, step, x), factor) /
         jacobian_rounding(x.size(), roundings(method, x.size()), magnified);
}

double symplecticity_broken_by_euler(const model& system, double step, const any_state& x) {
  const auto& over = system.kernels<slopes>();
  const auto euler = [&](auto& y) {
    columns f = y.q;
    columns v = y.q;
    over.force(field::whole, y.q, f);
    over.velocity(y.p, v);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      y.q[i] += v[i] * step;
      y.p[i] += f[i] * step;
    }
  };
  const auto at = shears_at(system, x);
  const double magnified = (1.0 + 2.0 * step * at.kinetic) * (1.0 + 2.0 * step * at.potential);
  return off_omega(jacobian_of(euler, x), 1.0) / jacobian_rounding(x.size(), 3.0, magnified);
}

/// Where the entries of J err by d, det J errs by sum_ij |adj J|_ij d: 4 n^2 terms, adj J = J^-1 for det J =
/// 1, and J^-1 is the Jacobian of the step back.
double volume_broken(const model& system, const method& method, double step, const any_state& x) {
  const double magnified = transient_growth(method, step, shears_at(system, x));
  const double terms = 4.0 * static_cast<double>(x.size());
  return std::abs(determinant(jacobian_of_step(system, method, step, x)) - 1.0) /
         (terms * jacobian_rounding(x.size(), roundings(method, x.size()), magnified));
}

/// Two steps, whose letters each round every coordinate twice.
double reversibility_broken(const model& system, const method& method, double step, const any_state& x) {
  const double magnified = transient_growth(method, step, shears_at(system, x));
  const double rounding = 4.0 * roundings(method, x.size()) * eps * size_of(x) * magnified * magnified;
  return reversibility_defect(system, method, step, x) / rounding;
}

// Runs.

static auto with_run(const run_of& of, const auto& f) {
  return std::visit([&](const auto& noise) { return f(make_stepper(of.system, of.method, of.step, noise)); },
                    of.noise);
}

any_state run_of::finish(const any_state& x, std::int64_t steps) const { return cut(x, steps, steps); }

any_state run_of::observed(const any_state& x, std::int64_t steps, std::int64_t every) const {
  const auto observe = [](std::int64_t, double, const auto&) {};
  return with_run(*this, [&](const auto& fixed) {
    return integrate(fixed, x, steps, observe, every, trajectory).finish;
  });
}

any_state run_of::watched(const any_state& x, std::int64_t steps, std::int64_t every) const {
  return with_run(*this, [&](const auto& fixed) {
    auto run = fixed.open(x, trajectory);
    auto other = run;
    bool same = true;
    fixed.advance(run, steps, every, [&](std::int64_t n, const auto& seen) {
      fixed.advance(other, n - other.step);
      same = same && same_bits(seen, fixed.synchronous(other));
    });
    if (!same) throw std::logic_error("what is seen is not the synchronous state");
    return fixed.synchronous(run);
  });
}

any_state run_of::cut(const any_state& x, std::int64_t steps, std::int64_t first) const {
  auto kept = with_run(*this, [&](const auto& before) {
    auto run = before.open(x, trajectory);
    before.advance(run, first);
    return run;
  });
  return with_run(*this, [&](const auto& after) {
    after.advance(kept, steps - first);
    return after.synchronous(kept);
  });
}

any_state run_of::reopened(const any_state& x, std::int64_t steps) const {
  return with_run(*this, [&](const auto& fixed) {
    auto y = x;
    for (std::int64_t n = 0; n < steps; ++n) {
      auto run = fixed.open(y, trajectory);
      fixed.advance(run, 1);
      y = fixed.synchronous(run);
    }
    return y;
  });
}

any_state run_of::plain(const any_state& x, std::int64_t steps, std::int64_t begin) const {
  return with_run(*this, [&](const auto& fixed) {
    auto y = x;
    for (std::int64_t n = 0; n < steps; ++n) fixed.step(y, trajectory, n + begin);
    return y;
  });
}

bool run_of::lanes_are_alone(const specimen& from, draws& random, std::int64_t steps,
                             std::uint64_t first) const {
  constexpr int lanes = pack<double>::lanes;
  std::vector<any_state> alone;
  for (int k = 0; k < lanes; ++k) alone.push_back(from.at_random(random));
  const auto start = detail::gather<detail::lanes, Eigen::Dynamic>(
      lanes, [&](int k) { return alone[static_cast<std::size_t>(k)]; });
  return with_run(*this, [&](const auto& fixed) {
    auto run = fixed.open(start, 40);
    fixed.advance(run, 30);
    fixed.advance(run, 1);
    const auto after = fixed.synchronous(run);
    for (int k = 0; k < lanes; ++k) {
      auto single = fixed.open(alone[static_cast<std::size_t>(k)], first + static_cast<std::uint64_t>(k));
      fixed.advance(single, steps);
      if (!same_bits(lane(after, k), fixed.synchronous(single))) return false;
    }
    return true;
  });
}

/// Each letter of each step rounds every coordinate twice, in both; the flow magnifies it by at most |J|^2
/// with J the Jacobian of the flow so far, as the inverse of a symplectic matrix is as large as the matrix;
/// and where friction has shrunk it, by as much more.
double run_of::merging_broken(const any_state& x, std::int64_t steps) const {
  const double letters = roundings(method, x.size());
  return std::visit(
      [&](const auto& source) {
        const auto fixed = make_stepper(system, method, step, source);
        return with_stepper<slopes>(system, method, step, source, [&](const auto& over_slopes) {
          auto run = fixed.open(x, trajectory);
          auto y = x;
          Eigen::MatrixXd flow = Eigen::MatrixXd::Identity(2 * x.size(), 2 * x.size());
          double magnified = 1.0;
          double worst = 0.0;
          for (std::int64_t n = 1; n <= steps; ++n) {
            flow = jacobian_of([&](auto& z) { over_slopes.step(z, trajectory, n - 1); }, y) * flow;
            magnified = std::max(magnified, norm(flow));
            fixed.step(y, trajectory, n - 1);
            fixed.advance(run, 1);
            const bath& in = system.bath();
            const double shrunk = in.acts() ? in.decay(static_cast<double>(n) * step) : 1.0;
            const double rounding =
                4.0 * static_cast<double>(n) * letters * eps * size_of(y) * magnified * magnified / shrunk;
            worst = std::max(worst, distance(fixed.synchronous(run), y) / rounding);
          }
          return worst;
        });
      },
      noise);
}

// Orders.

solved::solved(const model& of, std::vector<any_state> starts, double after)
    : system(of), start(std::move(starts)), finish(start), time(after) {
  for (auto& x : finish) x = by_odeint(system, x, time, 1e-15).first;
}

/// Until rounding spoils it: the run's rounding errors add up like a random walk, sqrt(n letters) eps, and
/// the reference's like its some 8 steps of 5e-15 a unit of time. An error 50 times as large is known to 2 %,
/// which moves the slope by 0.03. What remains of higher orders moves it by about (w h)^2 for symmetric
/// methods and by w h otherwise. Hence the slope of the last halving is the order to +-0.15 if the last w h
/// is below 0.35, that is, from steps of 1/4 on.
double measured_order(const solved& problem, const std::function<table(double)>& at, std::int64_t steps) {
  const auto error_after = [&](std::int64_t n) {  // root mean square over the starts
    const double step = problem.time / static_cast<double>(n);
    const auto [word, coefficients] = at(step);
    const stepper<model> fixed(problem.system, word, coefficients, step);
    double sum = 0.0;
    for (std::size_t k = 0; k < problem.start.size(); ++k) {
      auto run = fixed.open(problem.start[k]);
      fixed.advance(run, n);
      const auto x = fixed.synchronous(run);
      sum += (x.q - problem.finish[k].q).squaredNorm() + (x.p - problem.finish[k].p).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(problem.start.size()));
  };
  double coarse = error_after(steps);
  for (double slope = 0.0;; steps *= 2) {
    const double fine = error_after(2 * steps);
    const double letters = roundings(at(problem.time).word.letters(), problem.system.size());
    const double rounding =
        std::sqrt(static_cast<double>(2 * steps) * letters) * eps + 5e-15 * std::sqrt(8.0 * problem.time);
    if (steps > 2000 || !(fine > 50.0 * rounding)) return slope;
    slope = std::log2(coarse / fine);
    coarse = fine;
  }
}
double measured_order(const solved& problem, const table& method, std::int64_t steps) {
  return measured_order(
      problem, [&](double) { return method; }, steps);
}

// Systems.

/// Each of some 8 operations per coordinate rounds a term of a size up to |V''| |q| + |f|.
double gradient_defect(const model& system, const Eigen::VectorXd& q) {
  const Eigen::VectorXd f = force_at(system, q);
  const auto& over = system.kernels<slopes>();
  columns x = lifted(q);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    x[i] = slopes::variable(q[i], 0);
    worst = std::max(worst, std::abs(f[i] + over.potential(x).derivative[0]));
    x[i] = slopes(q[i]);
  }
  const double term = norm(hessian_of(system, q)) * q.cwiseAbs().maxCoeff() + f.cwiseAbs().maxCoeff();
  return worst / (8.0 * static_cast<double>(q.size()) * eps * term);
}

/// An eigensolver errs by about n eps |V''|; the product of three matrices adds 3 n eps |V''|.
double modes_defect(const model& system, const normal_modes& modes) {
  const Eigen::Index n = system.size();
  const Eigen::MatrixXd weighted = weighted_hessian(system, Eigen::VectorXd::Zero(n));
  const Eigen::MatrixXd diagonal = modes.frequencies.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd& u = modes.basis;
  const double unit = 8.0 * static_cast<double>(n * n) * eps;
  return std::max(norm(u.transpose() * weighted * u - diagonal) / (unit * norm(weighted)),
                  norm(u.transpose() * u - identity) / unit);
}

/// The force of the quadratic part is -M^{1/2} U diag(w^2) U^T M^{1/2} q. Each of some 8 n operations rounds
/// a term up to |V''| |q| + |f|, in which masses may be up to their ratio larger.
double soft_force_defect(const model& system, const Eigen::VectorXd& q, double factor) {
  const Eigen::VectorXd whole = force_at(system, q);
  Eigen::VectorXd soft = whole;
  system.soft_force(q, soft);
  const auto modes = system.modes();
  const Eigen::VectorXd root = root_inverse_masses(system).cwiseInverse();
  const Eigen::VectorXd squares = modes.frequencies.cwiseAbs2();
  const Eigen::VectorXd weighted = root.cwiseProduct(q);
  const Eigen::VectorXd linear =
      -root.cwiseProduct(modes.basis * squares.asDiagonal() * modes.basis.transpose() * weighted);
  const double ratio = root.maxCoeff() / root.minCoeff();
  const double term =
      ratio * norm(hessian_of(system, q)) * q.cwiseAbs().maxCoeff() + whole.cwiseAbs().maxCoeff();
  return (whole - linear - soft * factor).cwiseAbs().maxCoeff() /
         (8.0 * static_cast<double>(q.size()) * eps * term);
}

/// An eigenvalue errs by n eps |V''|, and its root by the square root of that near zero.
double band_defect(const model& system, const std::vector<frequency_band>& bands, const Eigen::VectorXd& q) {
  const Eigen::MatrixXd weighted = weighted_hessian(system, q);
  double worst = 0.0;
  for (const double square : symmetric_eigen(weighted).values) {
    double outside = infinite;  // in squares; a negative one does not oscillate
    for (const auto& [low, high] : bands) {
      const double x = std::max(square, 0.0);
      outside = std::min(outside, std::max({low * low - x, x - high * high, 0.0}));
    }
    worst = std::max(worst, outside);
  }
  return worst / (8.0 * static_cast<double>(q.size()) * eps * std::max(1.0, norm(weighted)));
}

std::pair<any_state, std::int64_t> by_odeint(const model& system, any_state x, double time,
                                             double tolerance) {
  const counted watched(system);
  odeint_reference(tolerance).advance(watched, x, time);
  return {std::move(x), watched.evaluations};
}

/// The slope of H is taken at both ends, twice as large: it changes on the way.
double energy_defect(const model& system, const any_state& x, const any_state& y, std::int64_t evaluations,
                     double error) {
  const auto slope = [&](const any_state& at) {  // |dH| per unit of error in every coordinate
    Eigen::VectorXd v(at.size());
    velocity<double>(system, at.p, v);
    return force_at(system, at.q).cwiseAbs().sum() + v.cwiseAbs().sum();
  };
  const double allowed = 2.0 * static_cast<double>(evaluations) * error * (slope(x) + slope(y) + 1.0);
  return std::abs(energy<double>(system, y) - energy<double>(system, x)) / allowed;
}

}  // namespace nysalt::test
