// SPDX-License-Identifier: BSL-1.0
// Learning for the chain in its bath (section 5.3): against the step, and from more and more data.
#include <algorithm>
#include <cmath>

#include "estimator_convergence.hpp"
#include "linear_steps.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

/// b1 and beta1 of the damped oscillator with O at the end, in the energy norm and units of omega.
two_parameters linear_optimum_at(double gap) {
  const double z = gap * gap_step * omega;
  const double g = 0.01 / omega;
  const auto loss = [=](const two_parameters& at) {
    const Eigen::Matrix2d damping = Eigen::Vector2d(1.0, std::exp(-g * z)).asDiagonal();
    return (damping * one_step(at, z, 1.0) - exact_step(z, 1.0, g)).squaredNorm();
  };
  return minimum_near({0.5, 0.4}, loss);
}

struct against_gap {
  std::string name;
  std::string start;
  std::string coordinates;
  std::vector<std::vector<std::vector<double>>> theta{};  // [parameter][gap][repetition]
};

void learn_all(const setting& setup, against_gap& one, const std::vector<double>& gaps,
               std::uint64_t repetitions) {
  const prepared_problem& system = setup.in_bath(one.start);
  one.theta.assign(2, std::vector<std::vector<double>>(gaps.size()));
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    // Small gaps have many pairs: they take long, and scatter little.
    for (std::uint64_t r = 0; r < (gaps[i] < 50.0 ? std::min<std::uint64_t>(repetitions, 3) : repetitions);
         ++r) {
      const auto learned = learn_at(setup, system, gaps[i] * gap_step,
                                    {.trajectories = setup.pick<std::int64_t>(512, 16),
                                     .horizon = 1.0,
                                     .coordinates = one.coordinates,
                                     .where = placement::end,
                                     .fine_step = gap_step,
                                     .repetition = r});
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
        one.theta[k][i].push_back(learned.fit.parameters[k].value);
    }
  }
}

/// Mean and standard deviation over the repetitions: what the paper draws as a bar.
estimate with_scatter(const std::vector<double>& samples) {
  const estimate e = mean_and_error(samples);
  return {e.mean, e.standard_error * std::sqrt(static_cast<double>(samples.size()))};
}

double farthest(const against_gap& one, const std::vector<double>& gaps) {
  double worst = 0.0;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const auto linear = linear_optimum_at(gaps[i]);
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      worst = std::max(worst, std::abs(mean_and_error(one.theta[k][i]).mean - linear[k]));
    }
  }
  return worst;
}

double largest_scatter(const against_gap& one) {
  double worst = 0.0;
  for (const auto& of_parameter : one.theta) {
    for (const auto& samples : of_parameter) worst = std::max(worst, with_scatter(samples).standard_error);
  }
  return worst;
}

figure picture_of(const std::vector<against_gap>& all, const std::vector<double>& gaps) {
  std::vector<panel> panels{{"b1", "gap", "b1", true, {}, "[*:*]", true},
                            {"beta1", "gap", "beta1", true, {}, "[*:*]", true}};
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    for (const auto& one : all) {
      curve learned{one.name, gaps, {}, {}, one.start == "trajectory"};
      for (const auto& samples : one.theta[k]) {
        learned.y.push_back(with_scatter(samples).mean);
        learned.error.push_back(with_scatter(samples).standard_error);
      }
      panels[k].curves.push_back(learned);
    }
    curve linear{"linear system", gaps, {}};
    for (const double gap : gaps) linear.y.push_back(linear_optimum_at(gap)[k]);
    panels[k].curves.push_back(linear);
  }
  return {"parameters_against_gap", panels, 1200, 480};
}

}  // namespace

exhibit parameters_against_gap(const setting& setup) {
  const std::vector<double> gaps =
      setup.pick<std::vector<double>>({10, 30, 50, 70, 100, 150, 190, 250, 330, 390, 450}, {190});
  const std::uint64_t repetitions = setup.pick<std::uint64_t>(10, 2);
  std::vector<against_gap> all{{"(q, p), one long trajectory", "trajectory", "qp"},
                               {"(q, p), Gibbs starts", "gibbs", "qp"},
                               {"modes, Gibbs starts", "gibbs", "modes"}};
  for (auto& one : all) learn_all(setup, one, gaps, repetitions);
  std::vector<std::string> columns{"gap", "linear b1, beta1"};
  for (const auto& one : all) {
    columns.push_back("b1, " + one.name);
    columns.push_back("beta1, " + one.name);
  }
  table rows(columns, 0);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    std::vector<std::string> cells{
        fmt::format("{:g}", gaps[i]),
        fmt::format("{:.4f}, {:.4f}", linear_optimum_at(gaps[i])[0], linear_optimum_at(gaps[i])[1])};
    for (const auto& one : all) {
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
        cells.push_back(with_error(with_scatter(one.theta[k][i])));
    }
    rows.add(cells);
  }
  constexpr double close = 0.01;
  std::vector<reading> near;
  std::vector<reading> narrow;
  std::string distances;
  std::string scatters;
  for (const auto& one : all) {
    near.push_back({one.name, farthest(one, gaps) <= close});
    narrow.push_back({one.name, largest_scatter(one) <= close});
    distances += fmt::format("{}{:.4f} ({})", distances.empty() ? "" : ", ", farthest(one, gaps), one.name);
    scatters += fmt::format("{}{:.4f} ({})", scatters.empty() ? "" : ", ", largest_scatter(one), one.name);
  }
  const std::string command = fmt::format(
      "nysalt learn --system fpu {} --start trajectory --placement end --trajectories 512 --horizon 1 --step "
      "0.02",
      bath_options);
  return {"Optimal parameters against the gap, in a bath",
          "Figure 5 (right), section 5.3",
          {{"the mean of both estimators is close to the optimum of the linear Langevin system",
            "largest distance of the mean of b1 and beta1 from it over all gaps", distances,
            verdict_of("the coordinates of the loss and the starts", near),
            summary_of(near) + "; close: to a hundredth", command},
           {"the error bar is barely noticeable", "largest standard deviation over repetitions", scatters,
            verdict_of("the coordinates of the loss and the starts", narrow),
            summary_of(narrow) + "; at most a hundredth", command}},
          {fmt::format("M = {} trajectories over Ttr = 1 by BAOAB with h = 1e-4, {} repetitions (3 below gap "
                       "50); O at the end.",
                       setup.pick(512, 16), repetitions)},
          {{"Mean and standard deviation over the repetitions:", rows}},
          {{picture_of(all, gaps),
            "Learned parameters in the bath against the gap; bars are the standard deviation over "
            "repetitions."}}};
}

exhibit convergence_in_noisy_trajectories(const setting& setup) {
  const prepared_problem& system = setup.in_bath("trajectory");
  const estimator_study study{.system = system,
                              .step = 0.02,
                              .how = {.horizon = 1.0, .where = placement::end, .fine_step = gap_step},
                              .least = 2,
                              .most = setup.pick(9, 4),
                              .repetitions = setup.pick(10, 2)};
  const estimator_errors found = errors_of_estimators(setup, study);
  exhibit result = exhibit_of(found, "-0.44", -0.44, "langevin");
  result.title = "Convergence of the estimators in a bath";
  result.place = "Figure 5 (left), section 5.3";
  const estimate at_most = found.from_others.back();
  result.claims.push_back({"with M = 512 the errors are below 1e-2", "mean error at the largest M",
                           with_error(at_most),
                           verdict_of(at_most.mean - 2.0 * at_most.standard_error < 1e-2),
                           "below 1e-2 within two standard errors", ""});
  for (auto& one : result.claims) {
    one.command = fmt::format(
        "nysalt learn --system fpu {} --start trajectory --placement end --trajectories 512 --horizon 1 "
        "--step 0.02",
        bath_options);
  }
  return result;
}

}  // namespace nysalt::program::paper
