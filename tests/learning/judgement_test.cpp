// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 42 s at -O0, 1.3 s at -O1.
// A judgement finds what linear criteria do not: trajectories that are lost, and energies that err by much.
// By it a method that was learned at one size is tried at another of its kind, and refused where it fails.
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/learning/reach.hpp"
#include "nysalt/learning/stability_guard.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

phase_points starts_of(const auto& law, std::uint64_t count) {
  phase_points result;
  for (std::uint64_t n = 0; n < count; ++n) result.push_back(law(7, n));
  return result;
}

const model chain = phi4_chain<>(16);
Eigen::VectorXd numbers(double x) { return Eigen::VectorXd::Constant(16, x); }
const auto chain_starts =
    starts_of(normal_around<Eigen::Dynamic>({numbers(0.0), numbers(0.0)}, 0.5, 1.0), 32);
phase_point<double, 2> at(double q, double p) { return {{0.0, q}, {0.0, p}}; }
phase_points one_start(double q, double p) {
  return std::vector{phase_point<double, Eigen::Dynamic>{numbers(q).head(1), numbers(p).head(1)}};
}
const auto in_well = around_rest<1>(1.5, 1.5);
const method rotations("rotations", word("RSR"), {0.5, 1.0, 0.5}, {2, true, true});

const fpu_chain<3> small(50.0);
const fpu_chain<> large(16, 50.0);
const method verlet_twice = member(nystrom(), {0.5, 0.5});  // two steps of Verlet: stable up to z = 4 a step
method learned_on(const std::string& system, const std::string& kind, double step) {
  return {"nystrom", verlet_twice.letters(), verlet_twice.coefficients(), verlet_twice,
          method_validity{step, system, kind}};
}
method learned_at(double step) { return learned_on(describe(small), detail::kind_of(small), step); }

/// Quartic wells that are the stiffer the more there are: where they rest nothing is stiff.
struct stiffening_wells {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::Index wells = 1;

  Eigen::Index size() const { return wells; }
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    const double k = static_cast<double>(wells * wells * wells * wells);
    T sum(0.0);
    for (Eigen::Index i = 0; i < wells; ++i) sum += q[i] * q[i] * q[i] * q[i] * (0.25 * k);
    return sum;
  }
  std::string description() const { return sentence("stiffening_wells(wells={})", wells); }
  std::string kind() const { return "stiffening_wells()"; }
};

/// At the bottom of the wells, with momenta.
auto from_the_bottom(const stiffening_wells& system) {
  return around_rest<Eigen::Dynamic>(0.0, 1.0, system.size());
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_far_below_the_limit_is_good_and_one_above_it_loses_trajectories) {
  const auto sound = judge(chain, chain_starts, method(mclachlan2{}), 0.2, {.steps = 5000});
  BOOST_TEST_CONTEXT(sound.in_words() << "\n" << sound.report()) {
    BOOST_TEST((sound.verdict == step_verdict::good));
    BOOST_TEST(sound.reason.empty());
    BOOST_TEST(sound.trajectories == 32);
    BOOST_TEST(sound.steps == 5000);
    BOOST_TEST(sound.energy_was_watched);
    BOOST_TEST(sound.energy_error.median <= sound.energy_error.most);
    BOOST_TEST(sound.energy_error.most <= sound.energy_error.largest);
    // None of 32: a share of 1 - .05^(1/32) is still likely [clopper_pearson_1934].
    BOOST_TEST(sound.most_lost() == 1.0 - std::pow(0.05, 1.0 / 32.0), boost::test_tools::tolerance(1e-9));
    BOOST_REQUIRE(sound.margin.has_value());
    BOOST_TEST(*sound.margin > 0.2);
  }
  // z = 2.4 at the frequency that a mass has at rest among others: linearly stable, limit 2.553.
  const auto lost = judge(chain, chain_starts, method(mclachlan2{}), 0.65, {.steps = 5000});
  BOOST_TEST_CONTEXT(lost.in_words()) {
    BOOST_TEST(!lost.holds());
    BOOST_REQUIRE(lost.first_lost.has_value());
    BOOST_TEST(lost.lost > 5);
    BOOST_TEST(lost.first_lost->step < 5000);
    BOOST_TEST(lost.reason.find("are lost") != std::string::npos);
  }
}

// At each pericentre the energy errs by more than there is kinetic energy, from the first on: it does not
// grow, and nothing diverges.
BOOST_AUTO_TEST_CASE(an_energy_error_that_is_large_from_the_first_steps_on_is_no_good_step) {
  const kepler system;
  const auto starts = starts_of(kepler_law(0.6), 64);
  const auto large = judge(system, starts, method(chin4a{}), 0.3);
  BOOST_TEST_CONTEXT(large.in_words()) {
    BOOST_TEST((large.verdict == step_verdict::unstable));
    BOOST_TEST(large.diverged == 0);
    BOOST_TEST(large.growth < 2.0);
    BOOST_TEST(large.energy_error.median > 1.0);
  }
  BOOST_TEST((judge(system, starts, method(chin4a{}), 0.1).verdict == step_verdict::good));
}

// Between a small step and one at which the energy diffuses (the standard map: beyond h = sqrt(.9716) no
// invariant circle is left [greene_1979]) the error is bounded and large: the verdict says how large.
BOOST_AUTO_TEST_CASE(a_large_error_that_does_not_grow_is_an_edge) {
  const auto at_step = [&](double step) {
    return judge(pendulum{}, starts_of(in_well, 64), method(verlet{}), step);
  };
  BOOST_TEST((at_step(0.15).verdict == step_verdict::good));
  BOOST_TEST(!at_step(1.3).holds());
  const auto found = at_step(0.5);
  BOOST_TEST(found.holds());
  BOOST_TEST((found.verdict == step_verdict::near_an_edge), found.in_words());
  BOOST_TEST(found.diverged == 0);
  BOOST_TEST(found.exceeding > 0);
  BOOST_TEST(found.growth < 1.1);
  BOOST_TEST(found.reason.find("of 64 trajectories") != std::string::npos, found.reason);
}

// Of 300 the energies of one or two err by more than the kinetic energy at times: 1 in 200 are still few, as
// four times as many are 2 % in a run four times as long. Verlet's error is up to h^2/(4 - h^2) of H.
BOOST_AUTO_TEST_CASE(what_one_trajectory_in_three_hundred_does_is_no_edge) {
  const auto with_energetic = [](std::size_t count) {
    phase_points starts;
    for (std::size_t k = 0; k < 300; ++k)
      starts.push_back(
          phase_point<double, 1>{vector<double, 1>(k < count ? 5.0 : 1.0), vector<double, 1>(0.0)});
    return judge(harmonic_oscillator(1.0), starts, method(verlet{}), 0.5, {.steps = 500});
  };
  const auto one = with_energetic(1);
  BOOST_TEST((one.verdict == step_verdict::good), one.in_words());
  BOOST_TEST(one.exceeding == 1);
  BOOST_TEST(one.energy_error.largest > 1.0);
  BOOST_TEST(one.energy_error.nearly_all < 0.25);
  const auto two = with_energetic(2);
  BOOST_TEST((two.verdict == step_verdict::near_an_edge), two.in_words());
  BOOST_TEST(two.reason.find("2 of 300") != std::string::npos, two.reason);
  BOOST_TEST(two.diverged == 0);
}

// Scaled units: all numbers but energies and times stay, and so does the verdict.
BOOST_AUTO_TEST_CASE(a_verdict_has_no_units) {
  constexpr double small = 1e-18;
  const auto of = [](double scale, double step) {
    const auto scaled = [&](double q, double p) {
      return phase_point<double, Eigen::Dynamic>{numbers(q).head(1), scale * numbers(p).head(1)};
    };
    // H = p^2/2m + k q^2/2 with mass and stiffness in proportion: the frequency stays.
    const linear_chain one(Eigen::MatrixXd::Constant(1, 1, 4.0 * scale), Eigen::VectorXd::Constant(1, scale));
    return judge(one, phase_points(std::vector{scaled(1.0, 0.3), scaled(0.2, -1.0)}), method(verlet{}), step,
                 {.steps = 2000});
  };
  for (const double step : {0.1, 0.8, 1.01}) {
    const auto large = of(1.0, step);
    const auto tiny = of(small, step);
    BOOST_TEST((large.verdict == tiny.verdict), large.in_words() << " and " << tiny.in_words());
    BOOST_TEST(large.lost == tiny.lost);
    BOOST_TEST(large.diverged == tiny.diverged);
    if (large.diverged == 0) {
      BOOST_TEST(large.energy_error.largest == tiny.energy_error.largest, boost::test_tools::tolerance(1e-6));
    }
  }
}

// Where a method is exact there is rounding alone, which grows with the steps and is no drift.
BOOST_AUTO_TEST_CASE(rounding_is_no_drift) {
  const linear_chain one(Eigen::MatrixXd::Constant(1, 1, 4.0));
  const auto exact = judge(one, one_start(1.0, 0.3), rotations, 0.7);
  BOOST_TEST((exact.verdict == step_verdict::good), exact.in_words());
  BOOST_TEST(exact.energy_error.largest < 1e-9);
}

// Above H = 1/6 the motion of Henon and Heiles may leave through a gap of the potential: no method is to
// blame.
BOOST_AUTO_TEST_CASE(motion_that_is_not_confined_is_left_out) {
  const phase_points starts(std::vector{at(0.0, 0.3), at(0.0, 0.8)});
  const auto left = judge(henon_heiles{}, starts, method(verlet{}), 0.05, {.steps = 5000});
  BOOST_TEST(left.unconfined == 1);
  BOOST_TEST(left.holds(), left.in_words());
  // At a step beyond the window the confined one is lost as well, and that counts.
  const auto lost = judge(henon_heiles{}, starts, method(verlet{}), 2.1, {.steps = 5000});
  BOOST_TEST(lost.diverged == 1);
  BOOST_TEST(!lost.holds());
  // Where nothing is left nothing was tried.
  const phase_points outside(std::vector{at(3.0, 0.0), at(3.0, 0.0)});
  const auto none = judge(henon_heiles{}, outside, method(verlet{}), 0.1, {.steps = 5000});
  BOOST_TEST(none.unconfined == 2);
  BOOST_TEST((none.verdict == step_verdict::not_tried));
  BOOST_TEST(!none.holds());
  BOOST_TEST(none.report().find("not confined") != std::string::npos, none.report());
}

// An accurate method in parts of such a step is unstable itself: that tells nothing of the motion.
BOOST_AUTO_TEST_CASE(what_an_accurate_method_cannot_follow_is_not_left_out) {
  const auto law = around_rest<1>(1.0, 1.0);
  for (const double omega : {300.0, 1e5}) {  // in 30 parts, and in too many
    const auto found =
        judge(harmonic_oscillator(omega), starts_of(law, 8), method(verlet{}), 0.1, {.steps = 400});
    BOOST_TEST((found.verdict == step_verdict::unstable), found.in_words());
    BOOST_TEST(found.unconfined == 0);
    BOOST_TEST(found.diverged == 8);
  }
}

// Nearly radial orbits begin almost at rest, with H = -1 and a median kinetic energy below 1. No part of
// these steps follows them past the first pericentre, at some 10^-4: what is flung out there says nothing of
// the scale.
BOOST_AUTO_TEST_CASE(the_scale_of_energies_is_that_of_the_motion_however_long_the_step) {
  const normal_around<2> law({{1.0, 0.0}, {0.0, 0.0}}, 0.0, 0.01);
  for (const double step : {0.02, 0.5, 8.0}) {
    const auto found = judge(kepler{}, starts_of(law, 16), method(mclachlan2{}), step, {.steps = 2000});
    BOOST_TEST(found.kinetic_energy < 1.0);
    BOOST_TEST(!found.holds(), found.in_words());
  }
}

// At rest there is no scale: what does not diverge was not tried.
BOOST_AUTO_TEST_CASE(a_step_that_no_accurate_motion_can_follow_from_rest_is_not_good) {
  const linear_chain stiff(Eigen::MatrixXd::Constant(1, 1, 1e12));
  const auto verdict_of = [&](const method& method) {
    return judge(stiff, one_start(1.0, 0.0), method, 0.1, {.steps = 500});
  };
  const auto found = verdict_of(rotations);
  BOOST_TEST((found.verdict == step_verdict::not_tried), found.in_words());
  BOOST_TEST(found.reason.find("far too long") != std::string::npos, found.reason);
  BOOST_TEST((verdict_of(nysalt::method(verlet{})).verdict == step_verdict::unstable));
}

// Starts are run 64 at a time: the first of the second block is the only one that moves too fast for the
// step, one of 65.
BOOST_AUTO_TEST_CASE(starts_beyond_the_first_block_are_tried) {
  const auto point = [](double q) { return phase_point<double, Eigen::Dynamic>{numbers(q), numbers(0.1)}; };
  std::vector<phase_point<double, Eigen::Dynamic>> starts(64, point(0.1));
  BOOST_TEST(judge(chain, starts, method(mclachlan2{}), 0.2, {.steps = 500}).lost == 0);
  starts.push_back(point(20.0));  // sqrt(3) 20 h = 7, far beyond 2.553
  const auto found = judge(chain, starts, method(mclachlan2{}), 0.2, {.steps = 500});
  BOOST_TEST(found.trajectories == 65);
  BOOST_TEST(found.diverged == 1);
  BOOST_TEST(found.unconfined == 0);
  BOOST_REQUIRE(found.first_lost.has_value());
  BOOST_TEST(found.first_lost->trajectory == 64);
  BOOST_TEST((found.verdict == step_verdict::near_an_edge), found.in_words());  // less than one in fifty
}

// So it does where energies are not watched, as for proposals of Hybrid Monte Carlo.
BOOST_AUTO_TEST_CASE(in_a_bath_only_divergence_counts) {
  const in_bath warm(harmonic_oscillator(1.0), bath::of_temperature(0.1, 1.0));
  const phase_points starts = one_start(1.0, 0.0);
  const auto sound = judge(warm, starts, method(baoab{}), 0.5, {.steps = 5000});
  BOOST_TEST(sound.holds(), sound.in_words());
  BOOST_TEST(!sound.energy_was_watched);
  BOOST_TEST(!judge(warm, starts, method(baoab{}), 2.2, {.steps = 5000}).holds());
  const auto unwatched = judge(kepler{}, starts_of(kepler_law(0.6), 64), method(chin4a{}), 0.3,
                               {.steps = 2000, .watches_energy = false});
  BOOST_TEST((unwatched.holds() && !unwatched.energy_was_watched), unwatched.in_words());
}

BOOST_AUTO_TEST_CASE(a_judge_gives_equal_judgements_of_equal_coefficients) {
  const step_judge judge_of(chain, chain_starts, 0.3, {.steps = 500});
  const method by_name(verlet{});
  const method by_letters("word", word("BAB"), by_name.coefficients(), {2, true, false});
  const auto one = judge_of.of(by_name);
  const auto other = judge(chain, chain_starts, by_letters, 0.3, {.steps = 500});
  BOOST_TEST(one.in_words() == other.in_words());
  BOOST_TEST(one.report() == other.report());
  BOOST_TEST(one.energy_error.largest == other.energy_error.largest);
  BOOST_TEST(one.highest_frequency == other.highest_frequency);
}

// A start that never varies is judged once; in a bath each run has noise of its own.
BOOST_AUTO_TEST_CASE(equal_starts_are_one) {
  const auto count = [](double deviation, const model& system) {
    const normal_around<1> law({vector<double, 1>(0.5), vector<double, 1>(0.0)}, deviation, deviation);
    return starts_to_judge(system, initial_states(law)).size();
  };
  BOOST_TEST(count(0.0, pendulum{}) == 1U);
  BOOST_TEST(count(1e-9, pendulum{}) == 512U);
  BOOST_TEST(count(0.0, in_bath(pendulum{}, bath::of_temperature(0.1, 1.0))) == 192U);
}

// A pendulum by its potential alone is differentiated, and two pendula cost four times as much.
template <int N>
struct derived_pendula {
  static constexpr int dimension = N;
  template <class T>
  T potential(const vector<T, N>& q) const {
    using std::cos;
    T sum(0.0);
    for (Eigen::Index i = 0; i < N; ++i) sum += 1.0 - cos(q[i]);
    return sum;
  }
};
struct priced_pendulum : pendulum {
  double force_cost() const { return 1000.0; }
};
BOOST_AUTO_TEST_CASE(a_trial_is_as_long_as_its_force_allows) {
  BOOST_TEST(force_cost(pendulum{}) == 1.0);
  BOOST_TEST(force_cost(derived_pendula<1>{}) == 4.0);
  BOOST_TEST(force_cost(derived_pendula<2>{}) == 16.0);
  BOOST_TEST(force_cost(in_bath(priced_pendulum{}, bath::of_temperature(0.1, 1.0))) == 1000.0);
  const auto starts = starts_of(in_well, 64);
  const auto steps = [&](const model& system) {
    return judge(system, starts, method(verlet{}), 0.15, {.work = 640'000}).steps;
  };
  BOOST_TEST(steps(pendulum{}) == 10'000);      // 64 trajectories of one evaluation a step
  BOOST_TEST(steps(priced_pendulum{}) == 640);  // one trajectory
}

BOOST_AUTO_TEST_CASE(starts_of_an_ensemble_are_the_first_ones_whatever_a_command_seeds) {
  const initial_states law(in_well);
  const auto starts = starts_to_judge(pendulum{}, law);
  BOOST_REQUIRE(starts.size() == 512);
  for (const std::size_t k : {std::size_t{0}, std::size_t{511}}) {
    BOOST_TEST(starts[k].q[0] == in_well(1, k).q[0]);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_judged_is_refused) {
  const auto with = [](const phase_points& starts, double step, const judging_options& options) {
    return [=] { judge(chain, starts, method(verlet{}), step, options); };
  };
  BOOST_TEST(refuses(with(chain_starts, 0.1, {.steps = -1}), {"judge", "-1"}));
  BOOST_TEST(refuses(with(chain_starts, 0.0, {}), {"judge", "step 0"}));
  BOOST_TEST(refuses(with({}, 0.1, {}), {"judge", "0 starts"}));
}

BOOST_AUTO_TEST_CASE(a_kind_is_the_description_without_the_size) {
  BOOST_TEST(detail::kind_of(small) == "fpu_chain(omega=50)");
  BOOST_TEST(detail::kind_of(fpu_chain<>(64, 50.0)) == detail::kind_of(small));
  BOOST_TEST(detail::kind_of(fpu_chain<>(3, 51.0)) != detail::kind_of(small));
  BOOST_TEST(detail::kind_of(phi4_chain<>(16)) == detail::kind_of(phi4_chain<8>()));
  BOOST_TEST(detail::kind_of(phi4_lattice(4, -4.0, 4.0)) == detail::kind_of(phi4_lattice(8, -4.0, 4.0)));
  BOOST_TEST(detail::kind_of(lennard_jones<>(2, 7)) == detail::kind_of(lennard_jones<>(2, 9)));
  BOOST_TEST(detail::kind_of(lennard_jones<>(2, 7)) != detail::kind_of(lennard_jones<>(3, 7)));
  BOOST_TEST(detail::kind_of(counted(small)) == detail::kind_of(small));

  // A bath is part of it, and so is a quadratic part.
  const auto warm = [](Eigen::Index pairs, double friction) {
    return in_bath(fpu_chain<>(pairs, 50.0), bath::of_temperature(friction, 1.0));
  };
  BOOST_TEST(detail::kind_of(warm(3, 0.1)) == detail::kind_of(warm(5, 0.1)));
  BOOST_TEST(detail::kind_of(warm(3, 0.1)) != detail::kind_of(warm(3, 0.2)));
  BOOST_TEST(model(warm(3, 0.1)).kind() == detail::kind_of(warm(3, 0.1)));
  BOOST_TEST(model(warm(3, 0.1)).base().kind() == detail::kind_of(small));
  BOOST_TEST(model(small).in(bath::of_temperature(0.1, 1.0)).kind() == detail::kind_of(warm(3, 0.1)));
  const with_quadratic_part parted(phi4_chain<>(4), Eigen::MatrixXd::Identity(4, 4));
  BOOST_TEST(detail::kind_of(parted) == describe(parted));
}

BOOST_AUTO_TEST_CASE(what_passes_at_another_size_runs_there_and_nowhere_else) {
  const fpu_law<Eigen::Dynamic> starts(large);
  const auto learned = learned_at(0.02);  // z = 1 of the 4 that are stable
  BOOST_CHECK_THROW(make_stepper(large, learned, 0.02), std::invalid_argument);
  const auto at_size = at_size_of(large, learned, starts, {.steps = 2000});
  BOOST_TEST(at_size.validity()->system == describe(large));
  BOOST_TEST((at_size.coefficients() == learned.coefficients()));
  BOOST_CHECK_NO_THROW(make_stepper(large, at_size, 0.02));
  BOOST_CHECK_THROW(make_stepper(small, at_size, 0.02), std::invalid_argument);
  BOOST_CHECK_THROW(make_stepper(large, at_size, 0.01), std::invalid_argument);
  // Where it was learned nothing is tried.
  BOOST_TEST(at_size_of(small, learned, fpu_law<3>(small)).validity()->system == describe(small));
}

BOOST_AUTO_TEST_CASE(another_kind_an_unknown_one_and_an_unstable_step_are_refused) {
  const fpu_chain<> other(16, 51.0);
  const fpu_law<Eigen::Dynamic> starts(other);
  BOOST_TEST(refuses([&] { at_size_of(other, learned_at(0.02), starts); },
                     {"fpu_chain(pairs=3, omega=50)", "fpu_chain(pairs=16, omega=51)", "not of one kind"}));
  const method of_no_kind = learned_on(describe(small), "", 0.02);
  BOOST_TEST(refuses([&] { at_size_of(large, of_no_kind, starts); }, {"not of one kind"}));
  // So is a step beyond the window.
  const auto beyond = learned_at(0.082);  // z = 4.1 at the stiff frequency, beyond 4
  BOOST_TEST(
      refuses([&] { at_size_of(large, beyond, fpu_law<Eigen::Dynamic>(large)); }, {"pairs=16", "unstable"}));
}

// The guard sees no stiffness where trajectories start, and admits the method at both sizes.
BOOST_AUTO_TEST_CASE(what_only_a_trial_sees_is_refused) {
  const double step = 0.3;
  const method& method = verlet_twice;
  for (const Eigen::Index wells : {1, 12}) {
    const stiffening_wells system{wells};
    const initial_states starts = from_the_bottom(system);
    const auto states = detail::typical_and_energetic_starts(model(system), starts, 1, 0, 64);
    BOOST_TEST(detail::stability_guard(model(system), states, false)
                   .objection(method.letters(), method.coefficients(), step, detail::met::often)
                   .empty());
    const judgement found =
        judge(model(system), starts_to_judge(model(system), starts), method, step, {.steps = 2000});
    // Of the energy p^2/2 = 1/2 the stiffness 3 k q^2 is at most 3 sqrt(2 k): z = .3 sqrt(3 sqrt(2)) = .6 of
    // 4 with one well, and .3 sqrt(3 sqrt(2 12^4)) = 7.4 with twelve.
    BOOST_TEST(found.holds() == (wells == 1), found.in_words());
  }
  const stiffening_wells one;
  const stiffening_wells twelve{12};
  const nysalt::method learned = learned_on(describe(one), detail::kind_of(one), step);
  BOOST_TEST(refuses([&] { at_size_of(twelve, learned, from_the_bottom(twelve), {.steps = 2000}); },
                     {"stiffening_wells(wells=1)", "wells=12", "trajectories are lost"}));
}

BOOST_AUTO_TEST_CASE(a_trial_takes_fewer_trajectories_of_a_larger_system) {
  const auto judged = [](Eigen::Index pairs) {
    const fpu_chain<> chain(pairs, 50.0);
    const fpu_law<Eigen::Dynamic> law(chain);
    return judge(chain, starts_to_judge(chain, law), verlet_twice, 0.02, {.steps = 600, .work = 4'000'000});
  };
  // Two evaluations a step of 16 and of 4000 coordinates: 208 trajectories of 600 steps, and one of 500.
  BOOST_TEST(judged(8).trajectories == 208);
  BOOST_TEST(judged(2000).trajectories == 1);
  BOOST_TEST(judged(2000).steps == 500);
}
