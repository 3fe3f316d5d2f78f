// SPDX-License-Identifier: BSL-1.0
// The program's numbers in a bath: those of the library, bit for bit, and those that are known.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "../../src/comparison/seeds.hpp"
#include "../support/document.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/kinetic_temperature.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;
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

std::string csv(const std::string& arguments) {
  const auto done = nysalt::test::run("run " + arguments);
  BOOST_TEST(done.code == 0, arguments << ": " << done.err);
  return done.out;
}

}  // namespace

BOOST_AUTO_TEST_CASE(run_gives_the_samples_of_the_library) {
  using state = phase_point<double, 6>;
  const fpu_chain<3> alone(50.0);
  const in_bath system(alone, bath::of_sigma(0.01, 0.05));
  const gibbs<6> starts(system, fpu_law<3>(alone));
  const std::uint64_t seed = program::seed_for(program::role::test, 5);
  const auto all = document(
      "run --seed 5 --method srkn6b@symmetric --step 0.03 --horizon 0.6 --sample-every 4 "
      "--trajectories 3 --observables stiff_energy,kinetic_temperature,q1,p6" +
      in_the_bath);
  BOOST_TEST(all["starts"] == starts.description());
  const auto stepper =
      make_stepper(system, thermostat<placement::symmetric>(srkn6b()), .03, counter_noise(seed));
  std::size_t at = 0;
  for (int m = 0; m < 3; ++m) {
    const auto watch = [&](std::int64_t n, double t, const state& x) {
      const json expected{m,      n,     t, alone.stiff_energy(x), kinetic_temperature<double>(alone, x),
                          x.q[0], x.p[5]};
      BOOST_REQUIRE(at < all["rows"].size());
      BOOST_TEST(all["rows"][at++] == expected);
    };
    const auto number = static_cast<std::uint64_t>(m);
    integrate(stepper, starts(seed, number), 20, watch, 4, number);
  }
  BOOST_TEST(at == all["rows"].size());
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
  for (const char* system : {"pendulum", "henon_heiles"}) {
    for (const char* kt : {"0.001", "0"}) {
      const std::string line =
          std::string("learn --family nystrom --step 0.1 --horizon 1 --friction 0.1 --system ") + system;
      const auto fit = document(line + " --temperature " + kt);
      BOOST_TEST(fit["usable"] == true, system << " at kT = " << kt);
      const auto coarse = nysalt::test::run(line + " --fine-step 0.005 --temperature " + kt);
      BOOST_TEST(coarse.err.find("the reference's own error") != std::string::npos, coarse.err);
    }
  }
}

// Measured beforehand by other programs on 2000 trajectories.
BOOST_AUTO_TEST_CASE(path_errors_are_the_known_ones) {
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

BOOST_AUTO_TEST_CASE(a_bath_that_does_nothing_changes_no_byte) {
  const std::string how = "--step 0.02 --horizon 0.4 --trajectories 17 --observables energy,q1,p6 --method ";
  for (const char* idle : {" --friction 0 --temperature 1", " --friction 0 --sigma 0"}) {
    for (const char* method : {"verlet", "srkn6b --placement end"})
      BOOST_TEST((csv(how + method + idle) == csv(how + method)), method << idle);
  }
  // Without its O, OBABO is Verlet, letter by letter.
  BOOST_TEST((csv(how + "obabo") == csv(how + "verlet")));
  BOOST_TEST((csv(how + "verlet --friction 0 --sigma 0.01") != csv(how + "verlet")));
  BOOST_TEST((csv(how + "verlet --friction 0.01 --temperature 0") != csv(how + "verlet")));
}

// BAOAB without its O is BAAB: two halves of a drift are rounded twice. On the oscillator with omega = 1 a
// state stays of the size R of its start, to a factor 1 + h^2/8 each way, and a step rounds some five times.
BOOST_AUTO_TEST_CASE(baoab_without_a_bath_is_verlet_to_rounding) {
  const int steps = 100;
  const auto end = [&](const std::string& method) {
    const auto done = nysalt::test::run(
        "run --system oscillator --omega 1 --step 0.1 --horizon 10 --json "
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

BOOST_AUTO_TEST_CASE(a_scheme_keeps_its_bath_and_its_placement) {
  const scratch folder("langevin_scheme");
  const auto in_folder = [&](const std::string& arguments) { return nysalt::test::run(folder, arguments); };
  const std::string bath = " --start law" + in_the_bath;  // no burn-in: any start will do
  const std::string how = bath + "--trajectories 20 --horizon 0.5 --step 0.02 --output ";
  BOOST_REQUIRE(in_folder("learn --family nystrom --placement end" + how + "end.json").code == 0);
  BOOST_REQUIRE(in_folder("learn --family nystrom" + how + "symmetric.json").code == 0);
  const auto scheme = json::parse(contents(folder / "end.json"));
  BOOST_TEST(scheme["version"] == 2);
  BOOST_TEST(scheme["placement"] == "end");
  BOOST_TEST(scheme["system"]["friction"] == .01);
  BOOST_TEST(scheme["system"]["sigma"] == .05);

  // Beside learning in place, with the same options: the same errors.
  const auto all = document(
      "compare --steps 0.02 --trajectories 3 --learn-trajectories 20 --methods "
      "end.json,symmetric.json,learned:nystrom@end,learned:nystrom" +
          bath,
      folder);
  BOOST_TEST(row_of(all, "end.json")["error"] == row_of(all, "learned:nystrom@end")["error"]);
  BOOST_TEST(row_of(all, "symmetric.json")["error"] == row_of(all, "learned:nystrom")["error"]);
  BOOST_TEST(row_of(all, "end.json")["error"] != row_of(all, "symmetric.json")["error"]);

  const auto stability = document("stability --method end.json --step 0.02" + in_the_bath, folder);
  BOOST_TEST(stability["letters"] == "ABABAO");
  BOOST_TEST(stability["warnings"].empty());
  BOOST_TEST(in_folder("stability --method end.json --step 0.02").code == 2);

  for (const std::string& elsewhere : {std::string(), std::string(" --friction 0.02 --sigma 0.05"),
                                       std::string(" --friction 0.01 --sigma 0.06")}) {
    const std::string line =
        "run --start law --method end.json --step 0.02 --horizon 0.04 --json" + elsewhere;
    const auto refused = in_folder(line);
    BOOST_TEST(refused.code == 2, line);
    BOOST_TEST(refused.err.find("for which it was learned") != std::string::npos, refused.err);
    const auto forced = in_folder(line + " --force");
    BOOST_TEST(forced.code == 0, line);
    BOOST_TEST(!json_of(forced)["warnings"].empty());
  }
}

// A table may hold O: that of BAOAB is BAOAB.
BOOST_AUTO_TEST_CASE(a_table_may_hold_letters_of_the_bath) {
  const scratch folder("langevin_table");
  std::ofstream(folder / "table.json") << R"({"format": "nysalt table", "version": 1, "letters": "BAOAB",)"
                                       << R"( "coefficients": [0.5, 0.5, 1, 0.5, 0.5]})";
  const auto rows = [&](const std::string& method) {
    return document(
        "run --start law --step 0.02 --horizon 0.4 --trajectories 5 --method " + method + in_the_bath,
        folder)["rows"];
  };
  BOOST_TEST((rows("table.json") == rows("baoab")));
  BOOST_TEST((rows("table.json") != rows("aboba")));
}
