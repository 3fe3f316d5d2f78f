// SPDX-License-Identifier: BSL-1.0
// Whatever is typed wrong: one line that says what, where and what to do; nothing printed, nothing written.
#include <boost/test/unit_test.hpp>

#include <vector>

#include "../support/bad_input.hpp"

using namespace nysalt::test;

namespace {

void all_refused(const std::vector<bad>& cases) { all_refused(scratch("bad_input"), cases); }

// Sound beginnings: what follows makes them bad.
const std::string learn = "learn --trajectories 3 --output scheme.json --step 0.02";
const std::string run_it = "run --method verlet --output out.csv --step 0.01";
const std::string compare = "compare --trajectories 3 --fine-step 0.001 --output folder --methods verlet";

}  // namespace

// Else every case below could be refused for its beginning.
BOOST_AUTO_TEST_CASE(the_beginnings_are_sound) {
  BOOST_TEST(run(learn + " --horizon 0.1 --fine-step 0.001 --force").code != 2);
  BOOST_TEST(run(run_it + " --horizon 0.1").code == 0);
  BOOST_TEST(run(compare + " --steps 0.01 --horizon 0.1").code == 0);
  BOOST_TEST(run("stability --method verlet").code == 0);
}

// A name with a mistake is answered by the name that was meant; a word that is near nothing by a list, if
// that is short, or by where the names are.
BOOST_AUTO_TEST_CASE(mistyped_names_are_answered_by_what_was_meant) {
  all_refused(scratch("mistyped"),
              {{"learm --system fpu", {"command 'learm'", "did you mean learn?"}},
               {"recomend --system fpu --budget 3", {"command 'recomend'", "did you mean recommend?"}},
               {"--seed 3 learn", {"'--seed'", "must follow the command", "nysalt learn --seed"}},
               {learn + " --famly fg4", {"option '--famly'", "did you mean --family?"}},
               {"run --method verlet --stp 0.1 --horizon 1", {"'--stp'", "did you mean --step?"}},
               {"learn --system fpuu", {"system 'fpuu'", "did you mean fpu?"}},
               {"run --system fpuu", {"system 'fpuu'", "did you mean fpu?"}},
               {"compare --system Henon_Heils", {"did you mean henon_heiles?"}},
               {"recommend --system lenard_jones", {"did you mean lennard_jones?"}},
               {learn + " --family nystroem", {"family 'nystroem'", "did you mean nystrom?"}},
               {"run --method pefrll --step 1 --horizon 1", {"method 'pefrll'", "did you mean pefrl?"}},
               {"run --method learned:fgchin --step 1 --horizon 1", {"'fgchin'", "did you mean fg_chin?"}},
               {"run --method VERLETT --step 1 --horizon 1", {"did you mean verlet?"}},
               {run_it + " --horizon 1 --observables stif_energy", {"did you mean stiff_energy?"}},
               {"compare --methods verlet --steps 0.1 --metric paths", {"'paths'", "did you mean path?"}}});
}

BOOST_AUTO_TEST_CASE(a_command_that_moved_says_where_to) {
  all_refused(scratch("moved"), {{"reproduce", {"nysalt_paper", "./dev reproduce"}},
                                 {"reproduce linear --quick", {"nysalt_paper", "./dev reproduce"}}});
}

// 0.6 is 0.6000000000000001 as three times 0.2.
BOOST_AUTO_TEST_CASE(numbers_in_messages_have_the_digits_that_people_type) {
  const auto done =
      run("compare --methods learned:aba3_free --steps 0.2 --equal-cost --learn-horizon 0.5 --horizon 5");
  BOOST_TEST(done.code == 2);
  BOOST_TEST(done.err.find("one step of 0.6, got 0.5") != std::string::npos, done.err);
}

BOOST_AUTO_TEST_CASE(unknown_names_list_the_known_ones) {
  all_refused({
      {"nosuch", {"'nosuch'", "list, learn, run, compare, recommend, stability"}},
      {"--nosuch", {"'--nosuch'", "list, learn, run, compare, recommend, stability"}},
      {"'' list", {"''"}},
      {"list learn", {"'learn'", "nysalt list"}},
      {"list --nosuch 3", {"'--nosuch'", "--seed"}},
      {learn + " --nosuch=3", {"'--nosuch=3'", "nysalt learn --help"}},
      {run_it + " --horizon 1 out.csv", {"'out.csv'", "options only"}},
      {learn + " --system nosuch", {"nosuch", "fpu, oscillator, linear_chain, pendulum, henon_heiles"}},
      {learn + " --family nosuch", {"family 'nosuch'", "nysalt list"}},
      {learn + " --coordinates nosuch", {"coordinates 'nosuch'", "qp, modes, energy"}},
      {learn + " --family nystrom --fix c9=1", {"--fix", "'c9'", "b1, beta1"}},
      {"compare --methods 'a\nb.json' --steps 0.1", {"line break", "rename"}},
      {"compare --methods verlet --steps 0.1 --metric nosuch:q1", {"metric 'nosuch'", "distribution"}},
      {"compare --methods verlet --steps 0.1 --metric state:q1",
       {"state:q1", "to have an observable", "path"}},
      {"compare --methods verlet --steps 0.1 --metric path:", {"path:", "observable after the colon"}},
      {"compare --methods verlet --steps 0.1 --metric path:nosuch", {"nosuch", "stiff_energy"}},
      {"compare --methods verlet --steps 0.1 --metric path,path:stiff_energy",
       {"path:stiff_energy", "twice"}},
      {"compare --methods verlet --steps 0.1 --metric path:q1 --observable p1",
       {"--observable", "must come with"}},
      {"compare --methods verlet --steps 0.1 --levels 0", {"--levels", "positive"}},
      {"run --method nosuch --step 1 --horizon 1", {"method 'nosuch'", "nysalt list", ".json"}},
      {"run --method '' --step 1 --horizon 1", {"--method", "empty"}},
      {"run --method verlet,bcss2 --step 1 --horizon 1", {"'verlet,bcss2'"}},
      {"run --method learned:nosuch --step 1 --horizon 1", {"family 'nosuch'", "nysalt list"}},
      {"run --method learned:nystrom --step 1 --horizon 1", {"must be learned first", "nysalt learn"}},
      {run_it + " --horizon 1 --observables nosuch", {"'nosuch'", "stiff_energy", "q1..q6"}},
      {run_it + " --horizon 1 --observables q7", {"'q7'", "q1..q6"}},
      {run_it + " --horizon 1 --observables q0", {"'q0'", "q1..q6"}},
      {run_it + " --horizon 1 --observables q-1", {"'q-1'"}},
      {run_it + " --horizon 1 --observables stiff_energy_4", {"stiff_energy_1..stiff_energy_3"}},
      {compare + " --steps 0.01 --metric nosuch", {"'nosuch'", "path, relative, state, exchange, energy"}},
      {compare + " --steps 0.01 --observable nosuch", {"'nosuch'", "stiff_energy"}},
      {compare + ",nosuch --steps 0.01", {"'nosuch'", "nysalt list"}},
      {compare + ",learned: --steps 0.01", {"family ''", "nysalt list"}},
      {"stability --method nosuch", {"'nosuch'", "nysalt list"}},
      {"stability --family nosuch --parameters 1", {"'nosuch'", "nysalt list"}},
  });
}

BOOST_AUTO_TEST_CASE(numbers_that_are_none_or_not_in_place) {
  all_refused(after("learn --trajectories 3 --output scheme.json --step",
                    {{"", {"--step"}},
                     {"''", {"--step", "empty"}},
                     {"0", {"--step", "positive"}},
                     {"-0.0", {"--step", "positive"}},
                     {"-0.02", {"--step", "positive", "-0.02"}},
                     {"nan", {"--step", "finite", "nan"}},
                     {"inf", {"--step", "finite", "inf"}},
                     {"1e999", {"--step", "finite", "1e999"}},
                     {"abc", {"--step", "abc"}},
                     {"0,02", {"--step", "0,02"}},
                     {"0.02x", {"--step", "0.02x"}},
                     {"'0.02 0.03'", {"--step", "0.02 0.03"}},
                     {"0.02 --step 0.03", {"--step"}},
                     {"0.02 --omega 0", {"omega", "positive"}},
                     {"0.02 --omega -50", {"omega", "positive", "-50"}},
                     {"0.02 --omega nan", {"--omega", "finite"}},
                     {"0.02 --omega 1e999", {"--omega", "finite"}},
                     {"0.02 --omega ''", {"--omega"}},
                     {"0.02 --omega=", {"--omega"}}}));
  all_refused(after(learn, {{"--trajectories 4", {"--trajectories"}},
                            {"--seed -1", {"--seed", "-1"}},
                            {"--seed 2251799813685248", {"--seed", "2^51"}},
                            {"--seed 99999999999999999999999", {"--seed", "99999999999999999999999"}},
                            {"--seed 1.5", {"--seed", "1.5", "whole"}},
                            {"--seed 1e5", {"--seed", "1e5", "whole"}},
                            {"--seed 0x10", {"--seed", "0x10", "whole"}},
                            {"--seed ''", {"--seed", "empty"}},
                            {"--threads 0", {"--threads", "at least 1"}},
                            {"--threads -2", {"--threads", "at least 1", "-2"}},
                            {"--threads 1000000000", {"--threads", "at most"}},
                            {"--threads 99999999999", {"--threads", "99999999999"}},
                            {"--threads all", {"--threads", "all"}},
                            {"--pairs 0", {"pairs", "0"}},
                            {"--pairs -3", {"pairs", "-3"}},
                            {"--pairs 2.5", {"--pairs", "whole"}}}));
  all_refused(after("run --method verlet --output out.csv --step 0.01 --horizon 1",
                    {{"--trajectories 0", {"--trajectories", "at least 1"}},
                     {"--trajectories -3", {"--trajectories", "at least 1", "-3"}},
                     {"--sample-every 0", {"--sample-every", "at least 1"}},
                     {"--sample-every -1", {"--sample-every", "at least 1"}},
                     {"--sample-every 0.5", {"--sample-every", "whole"}},
                     {"--system linear_chain --masses 0", {"mass", "0"}},
                     {"--system linear_chain --masses -1", {"mass", "-1"}},
                     {"--system linear_chain --spring 0", {"spring", "positive"}},
                     {"--system linear_chain --spring nan", {"--spring", "finite"}},
                     {"--system oscillator --omega 0", {"omega", "positive"}}}));
}

BOOST_AUTO_TEST_CASE(a_fine_step_must_divide) {
  all_refused(after(learn, {{"--fine-step 0.003", {"--fine-step must divide the step 0.02", "0.003"}},
                            {"--fine-step 0.04", {"must divide the step 0.02", "0.04"}},
                            {"--fine-step 0", {"--fine-step", "positive"}},
                            {"--fine-step -0.01", {"--fine-step", "positive"}},
                            {"--fine-step nan", {"--fine-step", "finite"}},
                            {"--fine-step ''", {"--fine-step"}}}));
  all_refused({{compare + " --steps 0.0105", {"must divide the step 0.0105", "0.001"}},
               {compare + " --steps 0.01,0.0105", {"must divide the step 0.0105", "0.001"}},
               {compare + " --steps 0.0105 --system oscillator", {"must divide the step 0.0105", "0.001"}}});
}

BOOST_AUTO_TEST_CASE(horizons_hold_a_step_and_not_too_many) {
  all_refused({
      {learn + " --horizon 0.01", {"--horizon", "0.01", "at least one step of 0.02"}},
      {learn + " --horizon 0", {"--horizon", "positive"}},
      {learn + " --horizon nan", {"--horizon", "finite"}},
      {learn + " --horizon 1e300", {"--horizon", "1e+300"}},
      {run_it, {"--horizon"}},
      {run_it + " --horizon 0.0099", {"--horizon", "at least one step"}},
      {run_it + " --horizon -1", {"--horizon", "positive"}},
      {run_it + " --horizon 1e300", {"--horizon", "1e+300"}},
      {run_it + " --horizon inf", {"--horizon", "finite"}},
      {"run --method verlet --output out.csv --step 1e-300 --horizon 1", {"1e-300", "--horizon"}},
      {compare + " --steps 0.6 --horizon 0.5", {"--horizon", "at least one step of 0.6"}},
      {compare + " --steps 0.06 --horizon 0.5",
       {"--horizon must hold at least 10 steps", "got 0.5, which holds 8.33", "at least 0.6"}},
      // Six evaluations a step: 0.6 again.
      {"compare --methods srkn6b --equal-cost --steps 0.1 --horizon 0.5 --output folder",
       {"--horizon", "at least one step of 0.6"}},
      {compare + ",learned:nystrom --steps 0.01 --learn-horizon 0.005",
       {"--learn-horizon", "at least one step"}},
      {compare + " --steps 1e-300", {"--horizon", "1e-300"}},
  });
}

BOOST_AUTO_TEST_CASE(lists_have_no_holes) {
  all_refused({
      {compare + " --steps 1,,2", {"--steps", "empty", "1,,2"}},
      {compare + " --steps ,1", {"--steps", "empty"}},
      {compare + " --steps 1,", {"--steps", "empty"}},
      {compare + " --steps ''", {"--steps", "empty"}},
      {compare + " --steps 0.01,x", {"--steps", "'x'"}},
      {compare + " --steps 0.01,nan", {"--steps", "'nan'"}},
      {compare + " --steps 0.01,1e999", {"--steps", "'1e999'"}},
      {compare + " --steps 0.01,0", {"--steps", "positive"}},
      {compare + " --steps -0.01", {"--steps", "positive", "-0.01"}},
      {compare + ",, --steps 0.01", {"--methods", "empty"}},
      {compare + ",verlet --steps 0.01", {"--methods", "verlet", "twice"}},
      {run_it + " --horizon 1 --observables energy,,q1", {"--observables", "empty"}},
      {"stability --family nystrom --parameters 0.5,", {"--parameters", "empty"}},
  });
}

// The next word would be taken for the value: a file named --json, or a seed that is not asked for.
BOOST_AUTO_TEST_CASE(an_option_with_an_equals_sign_has_a_value) {
  for (const std::string command :
       {"run", "learn", "compare", "sample", "recommend", "stability", "export"}) {
    const scratch folder("equals");
    const auto done = shell(folder, "for o in $(\"$nysalt\" " + command +
                                        " --help | grep -o '^ *--[a-z-]*' | sort -u); do " +
                                        "for next in '' --json --seed=3 x; do echo \"$o\"; \"$nysalt\" " +
                                        command + " $o= $next 2>&1; echo $?; done; done");
    const auto lines = std::ranges::count(done.out, '\n');
    std::ptrdiff_t refused = 0;
    for (auto at = done.out.find(": the value must not be empty; "); at != std::string::npos;
         at = done.out.find(": the value must not be empty; ", at + 1)) {
      ++refused;
    }
    BOOST_TEST(lines > 20);
    BOOST_TEST(3 * refused == lines, done.out);  // each is the option, the line and the exit code
    BOOST_TEST(folder.files().empty());
  }
}

// Of fewer digits than others, so that steps and ratios of them are anything.
BOOST_AUTO_TEST_CASE(subnormal_numbers_are_refused) {
  for (const std::string value : {"5e-324", "1e-310", "2.2e-308"}) {
    const std::vector<std::string> lines{
        "run --method verlet --horizon 1 --step " + value,
        "run --method verlet --step 0.1 --horizon " + value,
        "run --method verlet --step 0.1 --horizon 1 --omega " + value,
        "run --system oscillator --method verlet --step 0.1 --horizon 1 --omega " + value,
        "run --system linear_chain --method verlet --step 0.1 --horizon 1 --spring " + value,
        learn + " --enough " + value,
        "compare --methods verlet --steps 0.1 --horizon " + value,
        "sample --system pendulum --length " + value,
        "sample --system pendulum --length 1 --hmc-temperature " + value,
        "recommend --for sampling --system pendulum --length " + value,
        "recommend --for sampling --system pendulum --length 1 --hmc-temperature " + value,
        "recommend --budget 8 --horizon " + value,
        "recommend --budget " + value,
        "stability --method verlet --system oscillator --omega " + value};
    for (const auto& line : lines) {
      const scratch folder("subnormal");
      const finished done = shell(folder, "\"$nysalt\" " + line, 20);
      BOOST_TEST(done.code == 2, line << ": " << done.code << done.err);
      BOOST_TEST(is_one_line(done.err), line << ": " << done.err);
    }
  }
}

// Squares of frequencies decide about stability.
BOOST_AUTO_TEST_CASE(frequencies_without_a_square_are_refused) {
  all_refused(after("stability --method verlet --step 0.1 --system",
                    {{"oscillator --omega 1e308", {"harmonic_oscillator", "highest frequency", "1e+308"}},
                     {"oscillator --omega 1e160", {"harmonic_oscillator", "highest frequency", "1e+160"}},
                     {"oscillator --omega 1e-300", {"highest frequency", "1e-300"}},
                     {"phi4_lattice --mass_squared=1e308", {"highest frequency", "inf"}},
                     {"linear_chain --spring 1e308 --masses 3", {"linear_chain"}},
                     {"fpu --omega 1e200", {"highest frequency"}}}));
}

// What is named was typed, and not what is computed from it.
BOOST_AUTO_TEST_CASE(numbers_whose_product_overflows_are_refused_by_their_names) {
  all_refused(after("run --system pendulum --method baoab --step 0.1 --horizon 1",
                    {{"--friction 1e308 --temperature 1", {"--friction", "--temperature", "1e+308"}},
                     {"--friction 1e200 --temperature 1e200", {"--friction", "--temperature", "1e+200"}},
                     {"--friction 1 --sigma 1e308", {"--friction", "--sigma", "1e+308"}},
                     {"--friction 1e-300 --sigma 1e10", {"--friction", "--sigma", "1e-300"}}}));
  all_refused(after("recommend --system henon_heiles --horizon 10",
                    {{"--budget 1e-300", {"--budget", "at least", "0.1", "1e-300"}},
                     {"--budget 0.09", {"--budget", "at least", "0.1", "0.09"}}}));
}

BOOST_AUTO_TEST_CASE(parameters_of_a_family) {
  all_refused(after("stability --family nystrom", {{"", {"2 parameters", "b1, beta1", "0"}},
                                                   {"--parameters 0.5", {"2 parameters", "1"}},
                                                   {"--parameters 0.5,0.4,0.3", {"2 parameters", "3"}},
                                                   {"--parameters 0.5,x", {"--parameters", "'x'"}},
                                                   {"--parameters 0.5,nan", {"--parameters", "'nan'"}},
                                                   {"--parameters 0,0.4", {"b1", "(0, 1)", "0"}},
                                                   {"--parameters 0.5,-0.1", {"beta1", "[0, 0.5]"}},
                                                   {"--parameters 0.5,1e308", {"beta1", "[0, 0.5]"}},
                                                   {"--parameters ''", {"--parameters", "empty"}}}));
  all_refused(after(learn + " --family nystrom", {{"--fix b1", {"--fix", "b1=0.5", "'b1'"}},
                                                  {"--fix b1=", {"--fix", "'b1='"}},
                                                  {"--fix =0.5", {"--fix", "''"}},
                                                  {"--fix ''", {"--fix"}},
                                                  {"--fix b1=x", {"--fix", "'b1=x'"}},
                                                  {"--fix b1=nan", {"--fix", "'b1=nan'"}},
                                                  {"--fix b1=0.5,beta1=0.4", {"--fix", "name=number"}},
                                                  {"--fix b1=0.5 --fix b1=0.6", {"--fix", "b1", "twice"}},
                                                  {"--fix b1=1e308", {"b1", "(0, 1)"}},
                                                  {"--fix b1=-0.5", {"b1", "(0, 1)"}}}));
}

BOOST_AUTO_TEST_CASE(options_that_contradict_each_other_or_are_missing) {
  all_refused({
      {"learn --step 0.02 --steps 0.01,0.02", {"--step", "--steps", "not both"}},
      {"learn --steps 0.01,0.01", {"--steps", "0.01", "twice"}},
      {"learn --steps 0.01,-0.02", {"--steps", "positive"}},
      {"learn --step 0.02 --loss states", {"unknown loss", "state:K"}},
      {"learn --step 0.02 --loss state:0", {"unknown loss", "state:0"}},
      {"learn --step 0.2 --horizon 0.5 --loss state:3", {"3 steps", "longer horizon"}},
      {"learn --step 0.02 --loss covariance", {"covariance", "--friction"}},
      {"learn --step 0.02 --random-starts -1", {"--random-starts", "-1"}},
      {"learn --step 0.02 --system pendulum --family r_aba4", {"R, S, H", "quadratic part"}},
      {"run --method impulse --step 0.02 --horizon 1 --system kepler", {"R, S, H", "quadratic part"}},
      {"stability --method impulse --output out.csv", {"--output must come without rotations"}},
      {"stability --method impulse --system pendulum --step 0.1", {"R, S, H", "quadratic part"}},
      {"stability --family r_aba2 --parameters 0.25 --system kepler --step 0.1", {"quadratic part"}},
      {"stability --method verlet --plot", {"--plot", "--output"}},
      {"stability --method verlet --output out.svg --plot", {".svg", ".csv"}},
      {"stability --method verlet --output no/out.csv", {"no/out.csv", "folder"}},
      {"stability --method verlet --system fpu --step 0.1 --eccentricity 0.5", {"fpu", "--eccentricity"}},
      {"learn", {"--step", "--steps", "not both"}},
      {"learn --step", {"--step"}},
      {"run --step 0.1 --horizon 1", {"--method must be given"}},
      {"compare --methods verlet", {"--steps must be given"}},
      {"compare --steps 0.01", {"--methods must be given"}},
      {"stability", {"--method", "--family"}},
      {"stability --family nystrom --parameters 0.5,0.4 --method verlet", {"--family", "--method"}},
      {"stability --method verlet --parameters 0.5,0.4", {"--parameters", "--family"}},
      {"stability", {"--family"}},
      {"stability --method verlet --system fpu", {"--system", "--step"}},
      {"stability --method verlet --system pendulum", {"--system", "--step"}},
      {"stability --method verlet --omega 20", {"--system", "--step"}},
      {"stability --method verlet --system nosuch --step 1", {"'nosuch'", "fpu"}},
      {"stability --method verlet --system fpu --step 0", {"--step", "positive"}},
      {"stability --method s_aia2", {"s_aia2", "--system", "--step"}},
      {"stability --method s_aia2 --system fpu --step 1", {"s_aia2", "step"}},
      {"stability --method phase_fitted_pefrl", {"phase_fitted_pefrl", "--system", "--step"}},
      {"stability --method phase_fitted_pefrl --system fpu --step 0.11",
       {"phase_fitted_pefrl", "at most 5.3"}},
      {"stability --method learned:nystrom", {"learned first"}},
      {learn + " --masses 3", {"fpu", "--masses", "--pairs, --omega"}},
      {learn + " --system pendulum --omega 3", {"pendulum", "--omega", "it takes --spread"}},
      {learn + " --system linear_chain --pairs 3", {"linear_chain", "--pairs", "--masses, --spring"}},
      {learn + " --system kepler --spread 2", {"kepler", "--spread", "it takes --eccentricity"}},
      {learn + " --atoms 3", {"fpu", "--atoms"}},
      {learn + " --spread 0", {"--spread", "positive"}},
      {learn + " --spread inf", {"--spread", "inf"}},
      {learn + " --system kepler --eccentricity 1", {"--eccentricity", "below 1"}},
      {learn + " --system kepler --eccentricity -0.1", {"--eccentricity", "at least 0"}},
      {learn + " --system kepler --coordinates modes", {"kepler", "modes", "qp"}},
      {learn + " --system lennard_jones --space 4", {"--space must be", "at least 2", "at most 3", "got 4"}},
      {learn + " --system lennard_jones --atoms 1", {"--atoms", "at least 2"}},
      {learn + " --system phi4 --masses 0", {"--masses must be", "at least 1", "got 0"}},
      {"run --method s_aia2 --system kepler --step 0.1 --horizon 1", {"s_aia2", "kepler", "declares none"}},
      {"run --method phase_fitted_chin4a --system lennard_jones --step 0.01 --horizon 1",
       {"phase_fitted_chin4a", "lennard_jones", "declares none"}},
      {"run --method verlet --step 0.1 --horizon 1 --plot", {"--plot", "--output"}},
      {"run --method s_aia2 --step 1 --horizon 1", {"s_aia2", "step"}},
      {compare + " --steps 0.01 --metric state --observable energy", {"--observable", "path", "state"}},
      {compare + " --steps 0.01 --metric exchange --system pendulum", {"exchange", "pendulum"}},
      {compare + " --steps 0.01 --trajectories 0", {"--trajectories"}},
      {compare + " --steps 0.01 --learn-trajectories 0", {"--learn-trajectories", "at least 1"}},
      {compare + " --steps 0.01 --learn-horizon 0", {"--learn-horizon", "positive"}},
      {compare + " --steps 0.01 --coordinates nosuch", {"coordinates 'nosuch'"}},
  });
}

BOOST_AUTO_TEST_CASE(requests_that_no_machine_can_hold) {
  all_refused({
      {learn + " --pairs 1000000000000", {"--pairs", "at most"}},
      {learn + " --pairs 9223372036854775807", {"--pairs", "at most"}},
      {learn + " --pairs 4611686018427387904", {"--pairs", "at most"}},
      {learn + " --pairs 9223372036854775808", {"--pairs", "9223372036854775808"}},
      {"learn --trajectories 1000000000000 --step 0.02 --output scheme.json", {"memory", "trajectories"}},
      {learn + " --horizon 1e14", {"memory", "horizon"}},
      {learn + " --omega 1e12", {"fine steps", "smaller step"}},
      {learn + " --fine-step 1e-300", {"fine steps", "--fine-step"}},
      {"compare --methods verlet --steps 0.02 --trajectories 3 --fine-step 1e-12",
       {"fine steps", "--fine-step"}},
      {run_it + " --horizon 1 --system linear_chain --masses 1000000000000", {"--masses", "at most"}},
      {run_it + " --horizon 1 --system linear_chain --masses 50000", {"--masses", "at most"}},
      {run_it + " --horizon 1 --system lennard_jones --atoms 1000", {"--atoms", "at most"}},
      {run_it + " --horizon 1 --system phi4 --masses 1000000000000", {"--masses", "at most"}},
      {run_it + " --horizon 1 --observables q1,p1,q1", {"--observables", "q1", "twice"}},
      {run_it + " --horizon 1e13", {"memory", "--sample-every"}},
      {"run --method verlet --step 0.01 --horizon 1 --trajectories 1000000000000 --json",
       {"memory", "--output"}},
      {"compare --methods verlet --steps 0.01 --trajectories 1000000000000", {"memory", "trajectories"}},
  });
  all_refused({{"compare --methods verlet --steps 0.02 --fix garbage", {"--fix", "learned", "verlet"}}});
  const std::string sampled = "sample --system pendulum --length 1";
  all_refused(after(sampled, {{"--burn-in 9223372036854775807", {"--burn-in", "2^48", "9223372036854775807"}},
                              {"--burn-in 281474976710656", {"--burn-in", "2^48"}},
                              {"--burn-in 71000000000000 --chains 4", {"--burn-in", "2^48"}},
                              {"--chains 9223372036854775807", {"--chains", "9223372036854775807"}},
                              {"--draws 9223372036854775807", {"--draws", "9223372036854775807"}},
                              {"--chains 4611686018427387904 --draws 2", {"--chains", "4611686018427387904"}},
                              {"--chains 4294967296 --draws 4294967296", {"--chains", "2^48"}}}));
  all_refused(
      after("compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods baoab "
            "--steps 0.2 --horizon 60 --trajectories 8 --metric distribution",
            {{"--range=-1e308,1e308", {"--range", "finite width"}},
             {"--range=-1e308,9e307", {"--range", "finite width"}},
             {"--range=1,0", {"--range", "LOW below HIGH"}},
             {"--range=1,1", {"--range", "LOW below HIGH"}}}));
}

BOOST_AUTO_TEST_CASE(files_of_options) {
  const scratch folder("bad_config");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  write("unknown.toml", "step = 0.02\nnosuch = 3\n");
  write("section.toml", "[nosuch]\nstep = 0.02\n");
  write("deep.toml", "[learn.nosuch]\nstep = 0.02\n");
  write("other.toml", "[run]\nstep = 0.02\n");
  write("broken.toml", "step = = 0.02 [[[\n");
  write("text.toml", "step = \"abc\"\n");
  write("negative.toml", "step = -0.02\n");
  write("list.toml", "step = [0.02, 0.03]\n");
  write("nothing.toml", "step =\n");
  write("twice.toml", "step = 0.02\nstep = 0.03\n");
  write("flag.toml", "step = 0.02\njson = maybe\n");
  write("itself.toml", "step = 0.02\nconfig = \"itself.toml\"\n");
  write("empty.toml", "");
  write("binary.toml", std::string("\x7f\x45\x4c\x46\0\x1b[31m\r\xff\xfe = 3\n\0\0", 18));
  all_refused(folder, {
                          {"learn --config missing.toml", {"cannot read missing.toml", "readable"}},
                          {"learn --config . --step 0.02", {"."}},
                          {"learn --config '' --step 0.02", {"--config", "empty"}},
                          {"learn --config unknown.toml", {"'nosuch'", "nysalt learn --help"}},
                          {"learn --config section.toml", {"unknown section 'nosuch'", "list, learn"}},
                          {"learn --config deep.toml", {"unknown section 'nosuch'"}},
                          {"learn --config other.toml", {"--step", "not both"}},
                          {"learn --config broken.toml", {"step"}},
                          {"learn --config text.toml", {"--step", "'abc'"}},
                          {"learn --config negative.toml", {"--step", "positive"}},
                          {"learn --config list.toml", {"--step"}},
                          {"learn --config nothing.toml", {"line 1", "must have a value"}},
                          {"learn --config twice.toml", {"line 2", "twice"}},
                          {"learn --config flag.toml", {"--json", "maybe"}},
                          {"learn --config itself.toml", {"'config'"}},
                          {"learn --config empty.toml", {"--step", "not both"}},
                          {"learn --config binary.toml", {"--config"}},
                      });
}

// One line, though there is something to warn of, and no run is begun that will not be.
BOOST_AUTO_TEST_CASE(a_refusal_comes_before_warnings_and_files) {
  const scratch folder("no_run");
  const std::string unstable = "--system oscillator --omega 50 --method verlet --step 1 --horizon 8";
  const std::string kept = " --output out.csv --checkpoint its.last --every 2 ";
  all_refused(folder,
              after("run", {{unstable + " --observables energ", {"energ", "did you mean energy?"}},
                            {unstable + kept + "--observables energ", {"energ", "did you mean energy?"}}}));
}

// Nothing is known of the frequencies there; that is no reason not to run, and what comes of it is told.
BOOST_AUTO_TEST_CASE(energies_that_are_no_numbers_are_told_of_as_diverged) {
  const auto done =
      run("run --system henon_heiles --spread 1e160 --method verlet --step 0.01 --horizon 1 --json");
  BOOST_TEST(done.code == 3, done.err);
  BOOST_TEST(json_of(done)["diverged"][0]["step"] == 1);
}

BOOST_AUTO_TEST_CASE(outputs_that_cannot_be_written) {
  const scratch folder("bad_output");
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_directories(folder / "there" / "manifest.json");
  std::filesystem::create_directory(folder / "foreign");
  std::ofstream(folder / "foreign" / "manifest.json") << "{\"name\": \"a web page\"}";
  std::ofstream(folder / "file") << "kept";
  const std::string fast = " --step 0.02 --horizon 0.1 ";
  const std::string few = "learn --trajectories 3 --fine-step 0.001" + fast;
  const std::string rows = "run --method verlet" + fast;
  const std::string errors = "compare --methods verlet --trajectories 3 --horizon 0.2 --steps 0.02 ";
  // sysfs refuses new files, of the superuser too; in a chroot without sysfs, /sys is a folder like others.
  if (std::filesystem::exists("/sys/kernel"))
    all_refused(folder, {{few + "--output /sys/scheme.json", {"/sys"}}});
  all_refused(folder, {
                          {few + "--output there", {"there", "folder"}},
                          {few + "--output nowhere/scheme.json", {"nowhere", "make it"}},
                          {few + "--output file/scheme.json", {"file"}},
                          {few + "--output ''", {"--output", "empty"}},
                          {few + "--output there/", {"there"}},
                          {rows + "--output there", {"there", "folder"}},
                          {rows + "--output there/out.csv", {"there/manifest.json", "folder"}},
                          {rows + "--output manifest.json", {"manifest.json", "take another"}},
                          {rows + "--output foreign/out.csv", {"foreign/manifest.json is no manifest"}},
                          {few + "--output foreign/scheme.json", {"foreign/manifest.json is no manifest"}},
                          {errors + "--output foreign", {"foreign/manifest.json is no manifest"}},
                          {rows + "--output out.svg --plot", {"--plot", ".svg", ".csv"}},
                          {rows + "--output out.dat --plot", {"--plot", ".dat", ".csv"}},
                          {rows + "--output nowhere/out.csv", {"nowhere", "make it"}},
                          {rows + "--output /proc/out.csv", {"/proc/out.csv"}},
                          {rows + "--output " + std::string(300, 'x'), {"cannot write"}},
                          {errors + "--output file", {"file", "not a folder"}},
                          {errors + "--output file/deeper", {"file", "not a folder"}},
                          {errors + "--output ''", {"--output", "empty"}},
                          {errors + "--output /proc/folder", {"/proc/folder"}},
                      });
  BOOST_TEST(contents(folder / "file") == "kept");
  BOOST_TEST(contents(folder / "foreign" / "manifest.json") == "{\"name\": \"a web page\"}");
}

// What is made there could not be read by the command that goes on, or draws it.
BOOST_AUTO_TEST_CASE(outputs_that_could_not_be_read_again_are_refused) {
  for (const char* mask : {"777", "600", "400", "200"}) {
    for (const std::string line :
         {"run --method verlet --step 0.02 --horizon 0.1 --output out.csv --plot",
          "learn --trajectories 3 --step 0.02 --horizon 0.1 --output s.json",
          "sample --system pendulum --length 1 --draws 10 --checkpoint c --every 10",
          "compare --methods verlet --steps 0.02 --trajectories 3 --horizon 0.2 --output folder"}) {
      const scratch folder("masked");
      const finished done = shell(folder, "umask " + std::string(mask) + "; \"$nysalt\" " + line);
      BOOST_TEST(done.code == 2, line << ": " << done.err);
      BOOST_TEST(done.err.find("type umask 022") != std::string::npos, line << ": " << done.err);
      BOOST_TEST(folder.files().empty());
    }
  }
}

// One trajectory has no error bar, and that is all that it lacks.
BOOST_AUTO_TEST_CASE(one_trajectory_is_enough) {
  const finished done = run("compare --methods verlet --steps 0.01 --horizon 0.1 --trajectories 1 --json");
  BOOST_TEST(done.code == 0);
  const auto document = json_of(done);
  BOOST_REQUIRE(!document.is_discarded());
  const auto& row = document["rows"][0];
  BOOST_TEST(row["error"].is_number());
  BOOST_TEST(row["standard_error"].is_null());
  BOOST_TEST(row["diverged"] == 0);
}

// Numbers that are strange, but are numbers.
BOOST_AUTO_TEST_CASE(what_is_only_unusual_works) {
  for (const char* arguments :
       {"run --method verlet --step 1e-300 --horizon 1e-299", "run --method verlet --step 1e-2 --horizon +1",
        "run --method verlet --step=.01 --horizon=1. --sample-every 9223372036854775807",
        "run --method verlet --step 0.01 --horizon 0.1 --seed 2251799813685247 --threads 1024",
        "stability --method verlet --system fpu --step 1e300",
        "stability --method verlet --omega 20 --step .1"}) {
    BOOST_TEST_CONTEXT(arguments) { BOOST_TEST(run(arguments).code == 0); }
  }
  // Decimal, as people count: not of base eight.
  const std::string steps = "run --method verlet --step 0.01 --horizon 0.1 --seed ";
  BOOST_TEST(run(steps + "010").out == run(steps + "10").out);
  BOOST_TEST(run(steps + "010").out != run(steps + "8").out);
}

// Everything diverges: an answer, but none to use.
BOOST_AUTO_TEST_CASE(an_unstable_step_is_no_bad_input) {
  const finished done = run("run --method verlet --step 1e300 --horizon 1e301");
  BOOST_TEST(done.code == 3);
  BOOST_TEST(done.err.find("not linearly stable") != std::string::npos);
  BOOST_TEST(done.err.find("diverged") != std::string::npos);
}
