// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 42 s at -O0, 1.3 s at -O1.
// A method that was learned at one size is tried at another of its kind, and refused where it fails.
#include "nysalt/learning/at_other_size.hpp"

#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/learning/stability_guard.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

const fpu_chain<3> small(50.0);
const member<nystrom> verlet_twice({0.5, 0.5});  // two steps of Verlet: stable up to z = 4 a step
tuned_method<nystrom> learned_at(double step) {
  return {verlet_twice, step, describe(small), {}, kind_of(small)};
}

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

BOOST_AUTO_TEST_CASE(a_kind_is_the_description_without_the_size) {
  BOOST_TEST(kind_of(small) == "fpu_chain(omega=50)");
  BOOST_TEST(kind_of(fpu_chain<>(64, 50.0)) == kind_of(small));
  BOOST_TEST(kind_of(fpu_chain<>(3, 51.0)) != kind_of(small));
  BOOST_TEST(kind_of(phi4_chain<>(16)) == kind_of(phi4_chain<8>()));
  BOOST_TEST(kind_of(phi4_lattice(4, -4.0, 4.0)) == kind_of(phi4_lattice(8, -4.0, 4.0)));
  BOOST_TEST(kind_of(lennard_jones<>(2, 7)) == kind_of(lennard_jones<>(2, 9)));
  BOOST_TEST(kind_of(lennard_jones<>(2, 7)) != kind_of(lennard_jones<>(3, 7)));
  BOOST_TEST(kind_of(counted(small)) == kind_of(small));

  // A bath is part of it, and so is a quadratic part.
  const auto warm = [](Eigen::Index pairs, double friction) {
    return in_bath(fpu_chain<>(pairs, 50.0), bath::of_temperature(friction, 1.0));
  };
  BOOST_TEST(kind_of(warm(3, 0.1)) == kind_of(warm(5, 0.1)));
  BOOST_TEST(kind_of(warm(3, 0.1)) != kind_of(warm(3, 0.2)));
  BOOST_TEST(model(warm(3, 0.1)).kind() == kind_of(warm(3, 0.1)));
  BOOST_TEST(model(warm(3, 0.1)).base().kind() == kind_of(small));
  BOOST_TEST(model(small).in(bath::of_temperature(0.1, 1.0)).kind() == kind_of(warm(3, 0.1)));
  const with_quadratic_part parted(phi4_chain<>(4), Eigen::MatrixXd::Identity(4, 4));
  BOOST_TEST(kind_of(parted) == describe(parted));
}

BOOST_AUTO_TEST_CASE(what_passes_at_another_size_runs_there_and_nowhere_else) {
  const fpu_chain<> large(16, 50.0);
  const fpu_law<Eigen::Dynamic> starts(large);
  const auto learned = learned_at(0.02);  // z = 1 of the 4 that are stable
  BOOST_CHECK_THROW(make_stepper(large, learned, 0.02), wrong);
  const auto at_size = at_size_of(large, learned, starts, {.steps = 2000});
  BOOST_TEST(at_size.system() == describe(large));
  BOOST_TEST((at_size.parameters() == learned.parameters()));
  BOOST_CHECK_NO_THROW(make_stepper(large, at_size, 0.02));
  BOOST_CHECK_THROW(make_stepper(small, at_size, 0.02), wrong);
  BOOST_CHECK_THROW(make_stepper(large, at_size, 0.01), wrong);
  // Where it was learned nothing is tried.
  BOOST_TEST(at_size_of(small, learned, fpu_law<3>(small)).system() == describe(small));
}

BOOST_AUTO_TEST_CASE(another_kind_and_an_unknown_one_are_refused) {
  const fpu_chain<> other(16, 51.0);
  const fpu_law<Eigen::Dynamic> starts(other);
  BOOST_TEST(
      refuses<wrong>([&] { at_size_of(other, learned_at(0.02), starts); },
                     {"fpu_chain(pairs=3, omega=50)", "fpu_chain(pairs=16, omega=51)", "not of one kind"}));
  const fpu_chain<> large(16, 50.0);
  const tuned_method<nystrom> of_no_kind(verlet_twice, 0.02, describe(small));
  BOOST_TEST(refuses<wrong>([&] { at_size_of(large, of_no_kind, starts); }, {"not of one kind"}));
}

BOOST_AUTO_TEST_CASE(a_step_beyond_the_window_is_refused) {
  const fpu_chain<> large(16, 50.0);
  const auto beyond = learned_at(0.082);  // z = 4.1 at the stiff frequency, beyond 4
  BOOST_TEST(refuses<wrong>([&] { at_size_of(large, beyond, fpu_law<Eigen::Dynamic>(large)); },
                            {"pairs=16", "unstable"}));
}

// The guard sees no stiffness where trajectories start, and admits the method at both sizes.
BOOST_AUTO_TEST_CASE(what_only_a_trial_sees_is_refused) {
  const double step = 0.3;
  const tabulated method(verlet_twice);
  for (const Eigen::Index wells : {1, 12}) {
    const stiffening_wells system{wells};
    const initial_states starts = from_the_bottom(system);
    const auto states = typical_and_energetic_starts(model(system), starts, 1, 0, 64);
    BOOST_TEST(stability_guard(model(system), states, false)
                   .objection(method.letters(), method.coefficients(), step, met::often)
                   .empty());
    const judgement found =
        judge(model(system), starts_to_judge(model(system), starts), method, step, {.steps = 2000});
    // Of the energy p^2/2 = 1/2 the stiffness 3 k q^2 is at most 3 sqrt(2 k): z = .3 sqrt(3 sqrt(2)) = .6 of
    // 4 with one well, and .3 sqrt(3 sqrt(2 12^4)) = 7.4 with twelve.
    BOOST_TEST(found.holds() == (wells == 1), found.in_words());
  }
  const stiffening_wells one;
  const stiffening_wells twelve{12};
  const tuned_method<nystrom> learned(verlet_twice, step, describe(one), {}, kind_of(one));
  BOOST_TEST(refuses<wrong>([&] { at_size_of(twelve, learned, from_the_bottom(twelve), {.steps = 2000}); },
                            {"stiffening_wells(wells=1)", "wells=12", "trajectories are lost"}));
}

BOOST_AUTO_TEST_CASE(a_trial_takes_fewer_trajectories_of_a_larger_system) {
  const auto judged = [](Eigen::Index pairs) {
    const fpu_chain<> chain(pairs, 50.0);
    const fpu_law<Eigen::Dynamic> law(chain);
    return judge(chain, starts_to_judge(chain, law), tabulated(verlet_twice), 0.02,
                 {.steps = 600, .work = 4'000'000});
  };
  // Two evaluations a step of 16 and of 4000 coordinates: 208 trajectories of 600 steps, and one of 500.
  BOOST_TEST(judged(8).trajectories == 208);
  BOOST_TEST(judged(2000).trajectories == 1);
  BOOST_TEST(judged(2000).steps == 500);
}
