// SPDX-License-Identifier: BSL-1.0
// The program's numbers are those that are known: in closed form, or measured beforehand by other programs.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../support/program.hpp"
#include "../support/rounding.hpp"

using namespace nysalt::test;
using boost::test_tools::tolerance;
using json = nlohmann::ordered_json;

namespace {

const std::string in_the_bath = " --friction 0.01 --sigma 0.05 ";  // the paper's

/// Of the row of a method.
const json& row_of(const json& all, const std::string& method) {
  for (const auto& row : all["rows"]) {
    if (row["method"] == method) return row;
  }
  throw std::invalid_argument("there is no row of " + method);
}

/// Both have noise, the printed value of an ensemble that is no smaller: five standard errors of two runs,
/// and half the last digit of what is known.
bool is_near(double found, double standard_error, double known, double last_digit) {
  return std::abs(found - known) < 5.0 * std::sqrt(2.0) * standard_error + 0.5 * last_digit;
}

bool has_error(const json& row, double known, double last_digit) {
  return is_near(row["error"], row["standard_error"], known, last_digit);
}

}  // namespace

// trace/2 = 1 - z^2/2 + K z^4 with K = b1 b2 s (1 - s)/2 and s = c2 - c1. At (1/2, 2/5) s is 3/5 and K is
// 3/100: -1 is met at z^2 = 20/3 and 10, and 1 at 50/3. Both follow from coefficients by few operations.
BOOST_AUTO_TEST_CASE(windows_are_the_known_ones) {
  const auto all = document("stability --family nystrom --parameters 0.5,0.4");
  BOOST_REQUIRE(all["windows"].size() == 2U);
  const auto near = tolerance(100 * eps);
  BOOST_TEST(all["limit"].get<double>() == std::sqrt(20.0 / 3.0), near);
  BOOST_TEST(all["windows"][0][0] == 0.0);
  BOOST_TEST(all["windows"][0][1] == all["limit"]);
  BOOST_TEST(all["windows"][1][0].get<double>() == std::sqrt(10.0), near);
  BOOST_TEST(all["windows"][1][1].get<double>() == std::sqrt(50.0 / 3.0), near);
  // z^2 = 8/(1 + sqrt(1 - 32 K)) with McLachlan's a, and s = 1 - 2 a.
  const double s = 1.0 - 2.0 * 0.19318332750378357396;  // [mclachlan_1995]
  const double limit = std::sqrt(8.0 / (1.0 + std::sqrt(1.0 - 4.0 * s * (1.0 - s))));
  const double found = document("stability --method mclachlan2")["limit"];
  BOOST_TEST(found == limit, near);
  BOOST_TEST(std::abs(found - 2.5531452) < 5e-8);  // as printed
}

// On a linear oscillator the optimum in the energy norm depends on z alone, if all phases are seen alike.
// They are where a trajectory of N steps takes N z = 355 or 710, and 355/113 is pi to 1e-7: what is left of
// sum exp(2 i n z) is 2 |N z - k pi| = 1e-4 of one term, in some 1000.
BOOST_AUTO_TEST_CASE(linear_optima_are_the_known_ones) {
  struct optimum {
    const char* z;
    double beta1;
  };
  for (const auto& [z, beta1] : {optimum{"0.5", 0.402727}, {"1", 0.400582}, {"2", 0.390164}}) {
    const auto fit = document(
        std::string("learn --loss state:1 --random-starts 0 --family nystrom --system oscillator --omega "
                    "1 --horizon 710 --trajectories "
                    "4 --coordinates energy --step ") +
        z);
    // Six digits are known, and the data leave an error of the size that is said above.
    BOOST_TEST(std::abs(fit["parameters"]["beta1"].get<double>() - beta1) < 1e-6, "z = " << z);
    BOOST_TEST(std::abs(fit["parameters"]["b1"].get<double>() - 0.5) < 1e-6, "z = " << z);
  }
}

// Measured beforehand by other programs, with other random numbers, and rounded to two digits.
BOOST_AUTO_TEST_CASE(path_errors_are_the_known_ones) {
  const auto all = document(
      "compare --methods verlet,verlet_2x,learned:nystrom --steps 0.01 --trajectories 400 "
      "--metric relative --learn-loss state:1");
  const std::vector<double> known{2.2e-2, 5.4e-3, 3.9e-4};
  const std::vector<double> last_digit{1e-3, 1e-4, 1e-5};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& row = all["rows"][k];
    // Two runs, each with its standard error.
    const double allowed = 0.5 * last_digit[k] + 5.0 * std::sqrt(2.0) * row["standard_error"].get<double>();
    BOOST_TEST(std::abs(row["error"].get<double>() - known[k]) < allowed, row);
    BOOST_TEST(row["reference_error"].get<double>() < 1e-6 * known[k]);
  }
}

// Measured beforehand by other programs on 512 trajectories of length 1. Those here are a tenth of that, and
// tell their own standard error.
BOOST_AUTO_TEST_CASE(learned_parameters_are_the_known_ones) {
  struct known {
    const char* step;
    double b1;
    double beta1;
  };
  for (const auto& [step, b1, beta1] : {known{"0.019", .5248, .4155}, {"0.033", .5265, .4079}}) {
    const auto fit = document(std::string("learn --family nystrom --loss state:1 --placement end --step ") +
                              step + in_the_bath);
    const auto must_be = [&, step = step](const char* name, double value) {
      BOOST_TEST(is_near(fit["parameters"][name], fit["standard_errors"][name], value, 1e-4),
                 name << " at " << step << ": " << fit["parameters"][name]);
    };
    BOOST_TEST(fit["placement"] == "end");
    must_be("b1", b1);
    must_be("beta1", beta1);
    // Without a bath b1 is .512 there: some eight standard errors away.
    BOOST_TEST(!is_near(.512, fit["standard_errors"]["b1"], b1, 1e-4));
  }
}

// BAOAB errs along a noisy path to first order: its step must be small beside that of the method, not beside
// the frequencies alone, which say little of a system that is not stiff.
BOOST_AUTO_TEST_CASE(the_reference_is_fine_enough_where_nothing_is_stiff) {
  for (const auto& [system, kt] : {std::pair{"pendulum", "0.001"}, {"henon_heiles", "0"}}) {
    const std::string line =
        std::string("learn --family nystrom --step 0.1 --horizon 1 --friction 0.1 --system ") + system;
    const auto fit = document(line + " --temperature " + kt);
    BOOST_TEST(fit["usable"] == true, system << " at kT = " << kt);
    const auto coarse = run(line + " --fine-step 0.005 --temperature " + kt);
    BOOST_TEST(coarse.err.find("the reference's own error") != std::string::npos, coarse.err);
  }
}

// Measured beforehand by other programs on 2000 trajectories.
BOOST_AUTO_TEST_CASE(path_errors_in_a_bath_are_the_known_ones) {
  const auto all = document(
      "compare --steps 0.019 --horizon 1 --trajectories 300 --metric relative --learn-loss state:1 "
      "--methods baoab,baoab_2x,learned:nystrom@end,learned:nystrom@symmetric" +
      in_the_bath);
  const auto& baoab = row_of(all, "baoab");
  const auto& end = row_of(all, "learned:nystrom@end");
  const auto& symmetric = row_of(all, "learned:nystrom@symmetric");
  BOOST_TEST(has_error(baoab, .102, 1e-3), baoab);
  BOOST_TEST(has_error(end, 4.1e-2, 1e-3), end);
  BOOST_TEST(has_error(symmetric, 2.1e-2, 1e-3), symmetric);
  // Errors of one set of paths, apart by a factor of two and more: far more than their standard errors.
  BOOST_TEST(symmetric["error"] < end["error"]);
  BOOST_TEST(row_of(all, "baoab_2x")["error"] < end["error"]);
  BOOST_TEST(end["error"] < baoab["error"]);
  BOOST_TEST(!has_error(end, 2.1e-2, 1e-3), "the tolerance tells placements apart");
}

BOOST_AUTO_TEST_CASE(laws_and_autocovariances_are_the_known_ones) {
  const std::string how = in_the_bath + "--steps 0.033 --methods baoab,learned:nystrom --trajectories ";
  // What is learned differs from the reference by sampling alone, and the floor is that on average.
  const auto laws = document("compare --metric distribution --bins 15 --horizon 5" + how + "500");
  const auto over_the_floor = [&](const std::string& method) {
    const auto& row = row_of(laws, method);
    return row["error"].get<double>() / row["floor"].get<double>();
  };
  BOOST_TEST(over_the_floor("learned:nystrom") < 2.0);
  BOOST_TEST(over_the_floor("baoab") > 2.0);

  const auto correlations = document("compare --metric acf --horizon 4 --longest-lag 1" + how + "300");
  BOOST_TEST(has_error(row_of(correlations, "baoab"), .27, 1e-2));  // measured by other programs
  const auto& learned = row_of(correlations, "learned:nystrom");
  BOOST_TEST(has_error(learned, 0.0, 0.0), learned);
  BOOST_TEST(!has_error(row_of(correlations, "baoab"), 0.0, 0.0));
}

// BAOAB has the Gibbs law of q on the oscillator at every step, and p^2 = kT (1 - z^2/4); OBABO has that of
// p, and q^2 = kT/(omega^2 (1 - z^2/4)) [leimkuhler_matthews_2013].
BOOST_AUTO_TEST_CASE(laws_on_the_oscillator_are_the_exact_ones) {
  const auto mean_is = [](const json& row, double exact) {
    return std::abs(row["mean"].get<double>() - exact) < 5.0 * row["mean_standard_error"].get<double>();
  };
  const std::string line =
      "compare --system oscillator --omega 1 --friction 1 --temperature 0.5 --steps 1 --horizon 200 "
      "--trajectories 200 --methods baoab,obabo --metric distribution --observable ";
  const auto potential = document(line + "potential_energy");
  BOOST_TEST(mean_is(row_of(potential, "baoab"), .25));
  BOOST_TEST(!mean_is(row_of(potential, "obabo"), .25));
  const auto kinetic = document(line + "kinetic_temperature");
  BOOST_TEST(mean_is(row_of(kinetic, "baoab"), .5 * .75));
  BOOST_TEST(!mean_is(row_of(kinetic, "baoab"), .5));
  BOOST_TEST(row_of(kinetic, "baoab")["kinetic_temperature"] == row_of(kinetic, "baoab")["mean"]);
}

// q'' = -q - gamma q' has q = exp(-gamma t/2) (q0 cos nu t + (p0 + gamma q0/2)/nu sin nu t).
BOOST_AUTO_TEST_CASE(at_temperature_zero_the_oscillator_is_damped) {
  const double gamma = 1.0;
  const double nu = std::sqrt(1.0 - gamma * gamma / 4.0);
  const auto error = [&](const std::string& method, const std::string& step) {
    const auto all = document(
        "run --system oscillator --omega 1 --friction 1 --temperature 0 --horizon 3.2 "
        "--observables q1,p1 --method " +
        method + " --step " + step);
    const auto& first = all["rows"].front();
    const auto& last = all["rows"].back();
    const double q0 = first[3];
    const double p0 = first[4];
    const double t = last[2];
    const double exact = std::exp(-gamma * t / 2.0) *
                         (q0 * std::cos(nu * t) + (p0 + gamma * q0 / 2.0) / nu * std::sin(nu * t));
    return last[3].get<double>() - exact;
  };
  const auto order = [&](const std::string& method) {
    return std::log2(std::abs(error(method, "0.02") / error(method, "0.01")));
  };
  // The next term of the error is smaller by a few h, and by h^2 for symmetric words.
  for (const char* method : {"baoab", "obabo", "aboba", "verlet@symmetric", "verlet@middle"})
    BOOST_TEST(std::abs(order(method) - 2.0) < .01, method << ": " << order(method));
  BOOST_TEST(std::abs(order("verlet@end") - 1.0) < .1, order("verlet@end"));
}

// BAOAB without its O is BAAB: two halves of a drift are rounded twice. On the oscillator with omega = 1 a
// state stays of the size R of its start, to a factor 1 + h^2/8 each way, and a step rounds some five times.
BOOST_AUTO_TEST_CASE(baoab_without_a_bath_is_verlet_to_rounding) {
  const int steps = 100;
  const auto end = [&](const std::string& method) {
    const auto done =
        run("run --system oscillator --omega 1 --step 0.1 --horizon 10 --json "
            "--observables q1,p1 --method " +
            method);
    const auto all = json_of(done);
    BOOST_REQUIRE(all["rows"].size() == steps + 1U);
    return std::vector<double>{all["rows"].back()[3], all["rows"].back()[4], all["rows"][0][3],
                               all["rows"][0][4]};
  };
  const auto verlet = end("verlet");
  const double allowed = 10.0 * steps * eps * std::hypot(verlet[2], verlet[3]);
  const auto apart = [&](const std::vector<double>& x) {
    return std::max(std::abs(x[0] - verlet[0]), std::abs(x[1] - verlet[1]));
  };
  BOOST_TEST(apart(end("baoab")) < allowed);
  BOOST_TEST(apart(end("baoab_2x")) > 1e3 * allowed);  // half the step
}
