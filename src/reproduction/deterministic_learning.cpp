// SPDX-License-Identifier: BSL-1.0
// What is learned for the chain without a bath (section 5.2): against its stiffness, and from more and more
// data.
#include <cmath>

#include "estimator_convergence.hpp"
#include "linear_steps.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

/// beta1 of the undamped oscillator at delta omega = 1, in the energy norm; b1 is 1/2.
double linear_beta1() {
  const auto loss = [](const two_parameters& at) {
    return (one_step(at, 1.0, 1.0) - exact_step(1.0, 1.0, 0.0)).squaredNorm();
  };
  return minimum_near({0.5, 0.4}, loss)[1];
}

struct against_omega {
  std::string coordinates;
  std::vector<std::vector<estimate>> theta;  // by omega
};

/// The largest distance of b1 and beta1 from the linear optimum for omega >= 30.
double farthest(const against_omega& estimates, const std::vector<double>& omegas) {
  double worst = 0.0;
  for (std::size_t i = 0; i < omegas.size(); ++i) {
    if (omegas[i] < 30.0) continue;
    worst = std::max({worst, std::abs(estimates.theta[i][0].mean - 0.5),
                      std::abs(estimates.theta[i][1].mean - linear_beta1())});
  }
  return worst;
}

figure picture_of(const std::vector<against_omega>& all, const std::vector<double>& omegas) {
  panel b1{"b1", "omega", "b1", true, {}, "[*:*]", true};
  panel beta1{"beta1", "omega", "beta1", true, {}, "[*:*]", true};
  const std::size_t n = omegas.size();
  for (const auto& one : all) {
    curve of_b1{"loss in " + one.coordinates, omegas, {}, {}, one.coordinates == "qp"};
    curve of_beta1 = of_b1;
    for (const auto& theta : one.theta) {
      of_b1.y.push_back(theta[0].mean);
      of_b1.error.push_back(theta[0].standard_error);
      of_beta1.y.push_back(theta[1].mean);
      of_beta1.error.push_back(theta[1].standard_error);
    }
    b1.curves.push_back(of_b1);
    beta1.curves.push_back(of_beta1);
  }
  b1.curves.push_back({"linear system", omegas, std::vector<double>(n, 0.5)});
  beta1.curves.push_back({"linear system", omegas, std::vector<double>(n, linear_beta1())});
  return {"parameters_against_omega", {b1, beta1}, 1100, 460};
}

}  // namespace

exhibit parameters_against_omega(const setting& setup) {
  const std::vector<double> omegas =
      setup.pick<std::vector<double>>({2, 4, 8, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100}, {2, 50});
  std::vector<against_omega> all{{"qp", {}}, {"modes", {}}};
  for (const double one : omegas) {
    const auto system = chain(one);
    for (auto& column : all) {
      const learning_setup how{.trajectories = setup.pick<std::int64_t>(100, 10),
                               .coordinates = column.coordinates};
      column.theta.push_back(theta_with_errors(learn_at(setup, *system, 1.0 / one, how)));
    }
  }
  table rows({"omega", "b1, (q, p)", "beta1, (q, p)", "b1, modes", "beta1, modes"}, 0);
  for (std::size_t i = 0; i < omegas.size(); ++i) {
    rows.add({fmt::format("{:g}", omegas[i]), with_error(all[0].theta[i][0]), with_error(all[0].theta[i][1]),
              with_error(all[1].theta[i][0]), with_error(all[1].theta[i][1])});
  }
  constexpr double close = 0.01;
  const std::vector<reading> readings{{"a loss in (q, p)", farthest(all[0], omegas) <= close},
                                      {"a loss in the modes", farthest(all[1], omegas) <= close}};
  return {
      "Optimal parameters against the stiffness",
      "Figure 2 (left), section 5.2",
      {{"for omega >= 30 the parameters are close to those of the linear system",
        "largest distance of b1 and beta1 from (0.5, " + fmt::format("{:.4f})", linear_beta1()),
        fmt::format("{:.4f} in (q, p), {:.4f} in the modes", farthest(all[0], omegas),
                    farthest(all[1], omegas)),
        verdict_of("the coordinates of the loss", readings), summary_of(readings) + "; close: to a hundredth",
        "nysalt learn --system fpu --loss state:1 --omega 50 --step 0.02 --coordinates modes"}},
      {"M = 100 trajectories over Ttr = 1/2, delta = 1/omega."},
      {{"Learned parameters with the errors of the fit:", rows}},
      {{picture_of(all, omegas),
        "Learned parameters against omega at delta = 1/omega, and those of the linear system (energy "
        "norm)."}}};
}

exhibit convergence_in_trajectories(const setting& setup) {
  const auto system = chain();
  const estimator_study study{.system = *system,
                              .step = 1.0 / omega,
                              .how = {},
                              .least = 1,
                              .most = setup.pick(8, 3),
                              .repetitions = setup.pick(30, 2)};
  const estimator_errors found = errors_of_estimators(setup, study);
  exhibit result = exhibit_of(found, "-0.45", -0.45, "deterministic");
  result.title = "Convergence of the estimators in the number of trajectories";
  result.place = "Figure 2 (right), section 5.2";
  result.claims.push_back({"with M = 2 the error is below 1e-3", "mean error of (b1 + beta1)/2 at M = 2",
                           with_error(found.at_least),
                           verdict_of(found.at_least.mean - 2.0 * found.at_least.standard_error < 1e-3),
                           "below 1e-3 within two standard errors",
                           "nysalt learn --system fpu --loss state:1 --step 0.02 --trajectories 2"});
  for (auto& one : result.claims) {
    if (one.command.empty())
      one.command = "nysalt learn --system fpu --loss state:1 --step 0.02 --trajectories 256";
  }
  return result;
}

}  // namespace nysalt::program::paper
