// SPDX-License-Identifier: BSL-1.0
// A model steps with the bits of its system, refuses in the same words, and tells what the system's type
// does.
#include "nysalt/model.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "laws/models.hpp"
#include "laws/noisy_models.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/phase_points.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/draws.hpp"
#include "support/in_lanes.hpp"
#include "support/noises.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using detail::lanes;
using detail::lanes_with_slopes;
using detail::slopes;

struct a_galaxy_one_by_one : within_a_quarter {
  static auto make() { return in_lanes<henon_heiles, 1>(henon_heiles()); }
};

/// Fixed and dynamic, with masses, over double alone, of another K, split, and of one lane.
using quiet_systems = std::tuple<an_fpu_chain, a_galaxy, a_dynamic_fpu, a_free_chain, two_weights,
                                 a_black_box, a_differentiable_box, a_fast_one, a_faster_one,
                                 two_split_weights, a_split_ring, a_galaxy_one_by_one>;
using all_systems = joined<quiet_systems, noisy_systems>;

const std::vector<tabulated> quiet_words{tabulated(verlet()),
                                         tabulated(verlet_aba()),
                                         tabulated(srkn11b()),
                                         tabulated(takahashi_imada()),
                                         tabulated(omelyan_fg4()),
                                         tabulated(impulse()),
                                         tabulated(member<r_fg4>(r_fg4::start()))};
const std::vector<tabulated> noisy_words{tabulated(baoab()), tabulated(obabo()), tabulated(aboba()),
                                         tabulated(shared_equally<O, kick, drift>()),
                                         tabulated(shared_equally<kick, drift, kick, O>())};

/// All numbers of a state, in order.
void add(std::vector<double>& all, double x) { all.push_back(x); }
template <int L>
void add(std::vector<double>& all, const pack<double, L>& x) {
  for (int k = 0; k < L; ++k) all.push_back(lane(x, k));
}
template <class T, int K>
void add(std::vector<double>& all, const dual<T, K>& x) {
  add(all, x.value);
  for (const T& slope : x.derivative) add(all, slope);
}
void add_vector(std::vector<double>& all, const auto& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) add(all, x[i]);
}
void add_state(std::vector<double>& all, const auto& x) {
  add_vector(all, x.q);
  add_vector(all, x.p);
}

/// As many states as there are lanes, around which trajectories run.
using start_states = std::vector<phase_point<double, Eigen::Dynamic>>;
template <class Model>
start_states starts_of(draws& random) {
  const auto system = Model::make();
  start_states result;
  for (int k = 0; k < default_lanes; ++k) {
    const auto x = random.state(system, Model::reach);
    result.push_back({x.q, x.p});
  }
  return result;
}
template <class R, int N>
phase_point<R, N> gathered(const start_states& starts) {
  return gather<R, N>(lanes_in<R>, [&](int k) -> phase_point<double, N> {
    const auto& x = starts[static_cast<std::size_t>(k)];
    return {x.q, x.p};
  });
}

template <class W, class S, Scalar T>
bool is_served(const W& word, const S& system) {
  return !refuses<std::invalid_argument>([&] { require_served<S, T>(word, system); }, {});
}

/// What a run over T shows: advanced at once, watched, cut, and one plain step.
template <Scalar T, NoiseSource Noise, class S>
std::vector<double> numbers_of_run(const S& system, const tabulated& method, double step,
                                   const start_states& starts, const Noise& noise) {
  const stepper<S, run_time_word, double, Noise> fixed(system, method.letters(), method.coefficients(), step,
                                                       noise);
  const auto x = gathered<T, S::dimension>(starts);
  constexpr std::uint64_t trajectory = 5;
  std::vector<double> all;
  for (const std::int64_t steps : {1, 7, 64}) {
    auto run = fixed.open(x, trajectory);
    fixed.advance(run, steps);
    add_state(all, fixed.synchronous(run));
  }
  for (const std::int64_t every : {1, 3, 64}) {
    auto run = fixed.open(x, trajectory);
    const auto observe = [&](std::int64_t n, const auto& seen) {
      all.push_back(static_cast<double>(n));
      add_state(all, seen);
    };
    fixed.advance(run, 7, every, observe);
    fixed.advance(run, 57, every, observe);
    fixed.advance(run, 0, every, observe);
    add_state(all, fixed.synchronous(run));
  }
  auto plain = x;
  fixed.step(plain, trajectory, 3);
  add_state(all, plain);
  return all;
}

/// A plain step over T = dual<R, 2>, with derivatives by two parameters.
template <class R, NoiseSource Noise, class S>
std::vector<double> numbers_of_step(const S& system, const tabulated& method, double step,
                                    const start_states& starts, const Noise& noise) {
  using T = dual<R, 2>;
  const auto plain = method.coefficients();
  std::vector<T> coefficients(plain.begin(), plain.end());
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    coefficients[i].derivative[0] = R(0.1 * static_cast<double>(i + 1));
    coefficients[i].derivative[1] = R(1.0 - 0.3 * static_cast<double>(i));
  }
  const stepper<S, run_time_word, T, Noise> fixed(system, method.letters(), coefficients, step, noise);
  auto x = gathered<R, S::dimension>(starts).template cast<T>();
  for (std::int64_t n = 0; n < 3; ++n) fixed.step(x, 5, n);
  std::vector<double> all;
  add_state(all, x);
  return all;
}

/// numbers(system, step, table) of the system and of its model are the same, and another step or table has
/// others.
template <class S>
void compare(const S& system, const tabulated& method, double step, const auto& numbers) {
  const auto expected = numbers(system, method, step);
  BOOST_TEST(expected.size() > 0U);
  for (const double x : expected) BOOST_REQUIRE(std::isfinite(x));
  BOOST_TEST((numbers(model(system), method, step) == expected));
  BOOST_TEST((numbers(model(system), method, step * (1.0 + 1e-12)) != expected));
  auto changed = method.coefficients();
  for (const std::size_t i : {std::size_t{0}, changed.size() / 2}) changed[i] += 1e-9;
  const tabulated another("another", method.letters(), changed, method);
  BOOST_TEST((numbers(model(system), another, step) != expected));
}

template <class Model, NoiseSource Noise, NoiseSource Lifted>
void compare_all(const std::vector<tabulated>& words, const Noise& noise, const Lifted& lifted,
                 int& compared) {
  const auto system = Model::make();
  using S = decltype(Model::make());
  draws random;
  const auto starts = starts_of<Model>(random);
  constexpr double step = 0.05;
  for (const tabulated& method : words) {
    const run_time_word& word = method.letters();
    if (!is_served<run_time_word, S, double>(word, system)) continue;
    ++compared;
    BOOST_TEST_CONTEXT(describe(system) << ", " << method.name()) {
      compare(system, method, step, [&](const auto& tested, const tabulated& table, double h) {
        return numbers_of_run<double>(tested, table, h, starts, noise);
      });
      if constexpr (detail::serves<S, lanes>) {
        compare(system, method, step, [&](const auto& tested, const tabulated& table, double h) {
          return numbers_of_run<lanes>(tested, table, h, starts, noise);
        });
      }
      if (!is_served<run_time_word, S, slopes>(word, system)) continue;
      compare(system, method, step, [&](const auto& tested, const tabulated& table, double h) {
        return numbers_of_step<double>(tested, table, h, starts, lifted);
      });
      if constexpr (detail::serves<S, lanes_with_slopes> && std::is_same_v<Lifted, no_noise>) {
        if (!is_served<run_time_word, S, lanes_with_slopes>(word, system)) continue;
        compare(system, method, step, [&](const auto& tested, const tabulated& table, double h) {
          return numbers_of_step<lanes>(tested, table, h, starts, lifted);
        });
      }
    }
  }
}

std::string refusal_of(auto&& action) {
  try {
    action();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_model_steps_with_the_bits_of_its_system) {
  int compared = 0;
  for_each<quiet_systems>(
      [&]<class Model>() { compare_all<Model>(quiet_words, no_noise(), no_noise(), compared); });
  BOOST_TEST(compared >= 50);  // twelve systems; not all serve all seven words
}

BOOST_AUTO_TEST_CASE(a_model_in_a_bath_feels_the_noise_of_its_system) {
  int compared = 0;
  for_each<noisy_systems>(
      [&]<class Model>() { compare_all<Model>(noisy_words, counter_noise(3), fresh_noise(3), compared); });
  BOOST_TEST(compared == 10);
  // Another seed is other noise.
  const auto system = a_warm_fpu::make();
  draws random;
  const auto starts = starts_of<a_warm_fpu>(random);
  const auto of_seed = [&](std::uint64_t seed) {
    return numbers_of_run<lanes>(model(system), tabulated(obabo()), 0.05, starts, counter_noise(seed));
  };
  BOOST_TEST((of_seed(3) == of_seed(3)));
  BOOST_TEST((of_seed(3) != of_seed(4)));
}

BOOST_AUTO_TEST_CASE(a_bath_that_does_not_act_is_none) {
  const in_bath idle(henon_heiles(), bath::of_sigma(0.0, 0.0));
  draws random;
  const auto starts = starts_of<a_galaxy>(random);
  for (const tabulated& method : noisy_words) {
    const auto expected = numbers_of_run<double>(idle, method, 0.05, starts, no_noise());
    BOOST_TEST((numbers_of_run<double>(model(idle), method, 0.05, starts, no_noise()) == expected));
    BOOST_TEST((numbers_of_run<double>(model(henon_heiles()), method, 0.05, starts, no_noise()) == expected));
  }
}

BOOST_AUTO_TEST_CASE(a_model_refuses_what_its_system_refuses_in_the_same_words) {
  int refused = 0;
  int served = 0;
  for_each<all_systems>([&]<class Model>() {
    using S = decltype(Model::make());
    const S system = Model::make();
    const model erased(system);
    for (const char* letters : {"ABA", "BAGAB", "AGA", "RSR", "SRHRS", "ROSOR", "HR", "OABAO"}) {
      const run_time_word word(letters);
      const auto compare_over = [&]<Scalar T>(T) {
        const auto expected = refusal_of([&] { require_served<S, T>(word, system); });
        BOOST_TEST(refusal_of([&] { require_served<model, T>(word, erased); }) == expected);
        (expected.empty() ? served : refused) += 1;
      };
      BOOST_TEST_CONTEXT(describe(system) << ", " << letters) {
        compare_over(0.0);
        compare_over(slopes(0.0));
        if constexpr (detail::serves<S, lanes>) compare_over(lanes(0.0));
        if constexpr (detail::serves<S, lanes_with_slopes>) compare_over(lanes_with_slopes(0.0));
      }
    }
  });
  BOOST_TEST(refused > 50);
  BOOST_TEST(served > 50);
}

BOOST_AUTO_TEST_CASE(the_stepper_of_a_model_refuses_in_the_same_words) {
  const auto warm = a_warm_fpu::make();
  const model erased(warm);
  const std::vector<double> half{0.5, 1.0, 0.5};
  const auto without_o = [&](const auto& system) {
    return refusal_of([&] { stepper(system, run_time_word("ABA"), half, 0.1); });
  };
  BOOST_TEST(without_o(warm) != "");
  BOOST_TEST(without_o(erased) == without_o(warm));
  const auto without_noise = [&](const auto& system) {
    return refusal_of([&] { stepper(system, run_time_word("BAOAB"), {0.5, 0.5, 1.0, 0.5, 0.5}, 0.1); });
  };
  BOOST_TEST(without_noise(warm) != "");
  BOOST_TEST(without_noise(erased) == without_noise(warm));
  const auto with_step = [&](const auto& system, double h) {
    return refusal_of([&] { stepper(system, run_time_word("ABA"), half, h); });
  };
  const henon_heiles galaxy;
  BOOST_TEST(with_step(galaxy, 0.0) != "");
  BOOST_TEST(with_step(model(galaxy), 0.0) == with_step(galaxy, 0.0));
  // States are of any size until they are stepped.
  const model same(galaxy);
  const stepper fixed(same, run_time_word("ABA"), half, 0.1);
  const Eigen::VectorXd three = Eigen::VectorXd::Zero(3);
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        fixed.open(phase_point<double, Eigen::Dynamic>{three, three});
      },
      {"3 positions", "2 degrees of freedom"}));
}

BOOST_AUTO_TEST_CASE(facts_are_those_of_the_concepts) {
  for_each<all_systems>([&]<class Model>() {
    using S = decltype(Model::make());
    const S system = Model::make();
    const model erased(system);
    BOOST_TEST_CONTEXT(describe(system)) {
      BOOST_TEST(size(erased) == size(system));
      BOOST_TEST(describe(erased) == describe(system));
      BOOST_TEST(has_potential(erased) == (HasPotential<S, double>));
      BOOST_TEST(has_energy(erased) == HasEnergy<S>);
      BOOST_TEST(has_quadratic_kinetic(erased) == NystromSystem<S>);
      BOOST_TEST(has_modes(erased) == HasModes<S>);
      BOOST_TEST(has_quadratic_part(erased) == HasQuadraticPart<S>);
      BOOST_TEST(has_frequency_bands(erased) == HasFrequencyBands<S>);
      BOOST_TEST(is_black_box(erased) == BlackBoxForce<S>);
      BOOST_TEST(erased.facts().derivative_calls == derivative_calls<S>);
      BOOST_TEST(erased.facts().derivative_source == std::string(derivative_source<S>()));
      BOOST_TEST(erased.facts().in_lanes == (lanes_of<S> > 1 && SystemOver<S, lanes>));
      BOOST_TEST(erased.has_unit_mass() == !HasInverseMass<S>);
      if constexpr (HasInverseMass<S>) {
        for (Eigen::Index i = 0; i < size(system); ++i) {
          BOOST_TEST(erased.inverse_mass(i) == system.inverse_mass(i));
          BOOST_TEST(erased.root_mass(i) == 1.0 / std::sqrt(system.inverse_mass(i)));
        }
      }
      if constexpr (HasModes<S>) {
        BOOST_TEST((erased.modes().frequencies == system.modes().frequencies));
        BOOST_TEST((erased.modes().basis == system.modes().basis));
      }
      if constexpr (HasFrequencyBands<S>) {
        const auto ours = erased.frequency_bands();
        const auto theirs = system.frequency_bands();
        BOOST_REQUIRE(ours.size() == theirs.size());
        for (std::size_t k = 0; k < ours.size(); ++k) {
          BOOST_TEST(ours[k].low == theirs[k].low);
          BOOST_TEST(ours[k].high == theirs[k].high);
        }
      } else {
        BOOST_TEST(erased.frequency_bands().empty());
      }
      if constexpr (HasBath<S>) {
        BOOST_TEST(erased.bath().description() == system.bath().description());
      } else {
        BOOST_TEST(!erased.bath().acts());
      }
    }
  });
}

BOOST_AUTO_TEST_CASE(forces_and_energies_have_the_bits_of_the_system) {
  for_each<all_systems>([&]<class Model>() {
    using S = decltype(Model::make());
    const S system = Model::make();
    const model erased(system);
    draws random;
    const auto starts = starts_of<Model>(random);
    const auto compare_over = [&]<Scalar T>(T) {
      const auto values = [&](const auto& tested) {
        constexpr int N = std::remove_cvref_t<decltype(tested)>::dimension;
        const auto x = gathered<T, N>(starts);
        auto f = x.q;
        auto v = x.q;
        force<T>(tested, x.q, f);
        velocity<T>(tested, x.p, v);
        std::vector<double> all;
        add_vector(all, f);
        add_vector(all, v);
        if constexpr (HasEnergy<S, T>) {
          add(all, energy<T>(tested, x));
          add(all, kinetic_energy<T>(tested, x.p));
        }
        return all;
      };
      BOOST_TEST((values(erased) == values(system)));
    };
    BOOST_TEST_CONTEXT(describe(system)) {
      compare_over(0.0);
      if constexpr (detail::serves<S, lanes>) compare_over(lanes(0.0));
    }
  });
}

// What a type is asked when it is compiled a model tells while running.
BOOST_AUTO_TEST_CASE(what_the_library_finds_out_of_a_system_it_finds_out_of_its_model) {
  for_each<all_systems>([&]<class Model>() {
    using S = decltype(Model::make());
    const S system = Model::make();
    const model erased(system);
    BOOST_TEST_CONTEXT(describe(system)) {
      BOOST_TEST(detail::frequency_to_fit(erased) == detail::frequency_to_fit(system));
      const vector<double, S::dimension> zero = Eigen::VectorXd::Zero(size(system));
      const normal_around<S::dimension> law({zero, zero}, 0.1, 0.2);
      const auto starts = typical_and_energetic_starts(system, law, 1, 5, 10);
      BOOST_TEST(starts.size() == plain_starts + (HasEnergy<S> ? 64U : 0U));
      for (std::size_t n = 0; n < plain_starts; ++n) {
        const auto expected = law(1, 5 + n);
        BOOST_TEST((starts[n].q == expected.q && starts[n].p == expected.p));
        const auto other = law(2, 5 + n);
        BOOST_TEST(!(starts[n].q == other.q && starts[n].p == other.p));
      }
      if constexpr (HasEnergy<S>) {  // the 64 most energetic of the 896 that come next
        std::vector<double> energies;
        for (std::uint64_t n = 0; n < 896; ++n) {
          energies.push_back(energy<double>(system, law(1, 5 + plain_starts + n)));
        }
        std::ranges::sort(energies, std::greater<>());
        for (std::size_t k = 0; k < 64; ++k) {
          BOOST_TEST(energy<double>(erased, starts[plain_starts + k]) == energies[k]);
        }
      }
    }
  });
}

BOOST_AUTO_TEST_CASE(starts_of_another_dimension_are_refused) {
  const normal_around<2> of_two({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] { typical_and_energetic_starts(pendulum(), of_two, 1, 0, 10); }, {"the dimension of pendulum"}));
  BOOST_TEST(!typical_and_energetic_starts(henon_heiles(), of_two, 1, 0, 10).empty());
}

BOOST_AUTO_TEST_CASE(packs_are_refused_by_a_system_of_one_lane) {
  const model erased(a_galaxy_one_by_one::make());
  BOOST_TEST(!erased.facts().in_lanes);
  vector<lanes, Eigen::Dynamic> q(2);
  q.fill(lanes(0.1));
  auto f = q;
  BOOST_TEST(refuses<std::logic_error>([&] { erased.force(q, f); }, {"does not serve"}));
  const auto lanes_taken_by = [](const model& system) {
    return detail::with_scalar_of(system, []<class T>(T) { return lanes_in<T>; });
  };
  BOOST_TEST(lanes_taken_by(erased) == 1);
  BOOST_TEST(lanes_taken_by(henon_heiles()) == default_lanes);
}

BOOST_AUTO_TEST_CASE(copies_share_a_system_and_a_separate_one_has_its_own) {
  const model first{black_box()};
  const model copy = first;
  const auto evaluate = [](const model& system) {
    Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 0.3);
    Eigen::VectorXd f(1);
    system.force(q, f);
    return f[0];
  };
  for (int n = 0; n < 3; ++n) evaluate(first);
  BOOST_TEST(first.calls() == 3);
  BOOST_TEST(copy.calls() == 3);
  const model own = first.separate();
  BOOST_TEST(own.calls() == 0);  // counted for itself
  BOOST_TEST(evaluate(own) == evaluate(first));
  BOOST_TEST(own.calls() == 1);
  BOOST_TEST(copy.calls() == 4);
  BOOST_TEST(describe(own) == describe(first));
}

namespace {
/// q'' = -k q, of which somebody changes k.
struct changing {
  static constexpr int dimension = 1;
  double k = 1.0;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * -k;
  }
};
}  // namespace

BOOST_AUTO_TEST_CASE(a_model_keeps_a_copy_of_its_system) {
  changing system;
  const model kept(system);
  system.k = 2.0;
  const Eigen::VectorXd q = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd f(1);
  kept.force(q, f);
  BOOST_TEST(f[0] == -1.0);
  model(system).force(q, f);
  BOOST_TEST(f[0] == -2.0);
}

BOOST_AUTO_TEST_CASE(alone_a_system_is_without_its_bath) {
  const auto warm = a_warm_fpu::make();
  const model coupled(warm);
  const model alone = coupled.base();
  BOOST_TEST(coupled.bath().acts());
  BOOST_TEST(!alone.bath().acts());
  BOOST_TEST(describe(alone) == describe(warm.base()));
  BOOST_TEST(describe(coupled) == describe(warm));
  draws random;
  const auto starts = starts_of<a_warm_fpu>(random);
  const tabulated method{verlet()};
  BOOST_TEST((numbers_of_run<lanes>(alone, method, 0.05, starts, no_noise()) ==
              numbers_of_run<lanes>(warm.base(), method, 0.05, starts, no_noise())));
}
