// SPDX-License-Identifier: BSL-1.0
// Letters of one's own go where letters of the library go: into words as types and as data, over packs and
// derivatives, and into learning; to the same bits.
#include "../laws/laws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/detail/named_letters.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/learn.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The drift, written again.
struct my_drift : exact_flow<'a'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.q[i] += x.p[i] * t;
  }
};
/// The kick, written again: it evaluates the force itself.
struct my_kick : exact_flow<'b'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    using T = typename State::scalar_type;
    force<T>(system, x.q, room.x);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += room.x[i] * t;
  }
};

template <class W>
struct method_of {
  using word = W;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return word::letters(); }
  static typename word::template coefficients<double> coefficients() { return {0.3, 0.5, 0.4, 0.5, 0.3}; }
};
using own_drifts_first = method_of<word<my_drift, my_kick, my_drift, my_kick, my_drift>>;
using own_kicks_first = method_of<word<my_kick, my_drift, my_kick, my_drift, my_kick>>;
using mixed = method_of<word<drift, my_kick, drift, my_kick, drift>>;
using library_drifts_first = method_of<word<drift, kick, drift, kick, drift>>;
using library_kicks_first = method_of<word<kick, drift, kick, drift, kick>>;

const phase_point<double, 2> start{{0.1, -0.2}, {0.3, 0.1}};

/// The states that a watched run of 7 steps shows, every second of them and the last.
template <class S, class M>
std::vector<double> seen(const S& system, const M& method, const phase_point<double, S::dimension>& from) {
  const auto steps = make_stepper(system, method, 0.2);
  std::vector<double> all;
  const auto note = [&](const auto& x) {
    all.insert(all.end(), x.q.begin(), x.q.end());
    all.insert(all.end(), x.p.begin(), x.p.end());
  };
  auto run = steps.open(from);
  steps.advance(run, 7, 2, [&](std::int64_t, const auto& x) { note(x); });
  note(steps.synchronous(run));
  auto x = from;
  steps.step(x);
  note(x);
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(as_data_it_has_the_bits_of_its_type) {
  const auto check = [](const auto& system, const auto& method, const auto& from) {
    const auto as_type = seen(system, method, from);
    const phase_point<double, Eigen::Dynamic> dynamic{from.q, from.p};
    BOOST_TEST(as_type == seen(system, tabulated(method, system), from));
    BOOST_TEST(as_type == seen(model(system), tabulated(method, system), dynamic));
  };
  check(henon_heiles(), own_drifts_first(), start);
  check(henon_heiles(), own_kicks_first(), start);
  check(henon_heiles(), mixed(), start);
  const phase_point<double, Eigen::Dynamic> from{Eigen::VectorXd::LinSpaced(5, -0.3, 0.4),
                                                 Eigen::VectorXd::LinSpaced(5, 0.2, -0.1)};
  check(phi4_chain<>(5), own_kicks_first(), from);
}

BOOST_AUTO_TEST_CASE(letters_written_again_have_the_bits_of_the_library) {
  const henon_heiles system;
  BOOST_TEST(seen(system, own_drifts_first(), start) == seen(system, library_drifts_first(), start));
  BOOST_TEST(seen(system, own_kicks_first(), start) == seen(system, library_kicks_first(), start));
  BOOST_TEST(seen(system, own_kicks_first(), start) != seen(system, library_drifts_first(), start));
}

BOOST_AUTO_TEST_CASE(lanes_change_no_bit) {
  draws random;
  const auto& one = specimen_of("henon_heiles");
  const tabulated method(own_kicks_first{}, henon_heiles{});
  BOOST_TEST((run_of{one.system, method, 0.2}.lanes_are_alone(one, random)));
}

BOOST_AUTO_TEST_CASE(evaluations_are_those_of_the_word) {
  using W = own_kicks_first::word;
  static_assert(W::merges && W::evaluations_per_step == 2 && W::evaluations_of_plain_step == 3 &&
                W::evaluations_to_open == 1 && W::evaluations_to_observe == 1);
  const run_time_word as_data(W{}, henon_heiles());
  BOOST_TEST(as_data.letters() == "babab");
  BOOST_TEST(as_data.merges);
  BOOST_TEST(as_data.has_own_letters());
  BOOST_TEST(as_data.evaluations_per_step == 2);
  BOOST_TEST(as_data.evaluations_of_plain_step == 3);
  BOOST_TEST((as_data.evaluations_to_open == 1 && as_data.evaluations_to_observe == 1));
}

BOOST_AUTO_TEST_CASE(letters_are_taken_from_a_list_by_their_names) {
  const henon_heiles system;
  const detail::own_letters known{
      std::make_shared<const detail::bound_letter<my_drift, henon_heiles>>(system),
      std::make_shared<const detail::bound_letter<my_kick, henon_heiles>>(system, "henon_heiles()")};
  const tabulated method("named", run_time_word("ababa", known), {0.3, 0.5, 0.4, 0.5, 0.3}, {2, true, false});
  BOOST_TEST(seen(system, method, start) == seen(system, own_drifts_first(), start));
  BOOST_TEST(seen(system, method, start) != seen(system, own_kicks_first(), start));
  BOOST_TEST(!run_time_word("BAB", known).has_own_letters());  // what a word does not hold it does not carry
  BOOST_TEST(run_time_word("BaB", known).own_letter('b') == nullptr);
  BOOST_TEST(refuses<std::invalid_argument>([&] { run_time_word("aca", known); }, {"aca with the letter c"}));
}

BOOST_AUTO_TEST_CASE(what_a_file_states_of_a_letter_is_read_and_not_stepped) {
  const henon_heiles system;
  const run_time_word bound(own_kicks_first::word{}, system);
  const detail::own_letters stated{
      std::make_shared<const detail::stated_letter>(detail::facts_of_letter<my_drift>(), "henon_heiles()"),
      std::make_shared<const detail::stated_letter>(detail::facts_of_letter<my_kick>(), "henon_heiles()")};
  const run_time_word word("babab", stated);
  BOOST_TEST(word.evaluations_per_step == bound.evaluations_per_step);
  BOOST_TEST(word.evaluations_to_observe == bound.evaluations_to_observe);
  BOOST_TEST(word.merges);
  const tabulated method("stated", word, std::vector<double>{0.3, 0.5, 0.4, 0.5, 0.3}, {2, true, false});
  BOOST_TEST(refuses<std::invalid_argument>([&] { make_stepper(system, method, 0.1); },
                                            {"of henon_heiles() must come with the system"}));
}

BOOST_AUTO_TEST_CASE(what_a_bound_word_cannot_do_is_refused) {
  using wrong = std::invalid_argument;
  const henon_heiles same;
  const pendulum other;
  const tabulated method(own_drifts_first{}, henon_heiles{});
  BOOST_CHECK_NO_THROW(make_stepper(same, method, 0.1));
  BOOST_TEST(refuses<wrong>([&] { make_stepper(other, method, 0.1); },
                            {"the word ababa must be made with the system pendulum(), got the letter a of "
                             "henon_heiles(); make the word with this system"}));
  struct other_drift : my_drift {};  // of the same name
  using twice = word<my_drift, my_kick, other_drift>;
  BOOST_TEST(refuses<wrong>([] { run_time_word(twice{}, henon_heiles()); },
                            {"the word aba: letters of one's own must have different names, "
                             "got a twice; name one of them otherwise"}));
  // Its action on an oscillator is not guessed.
  BOOST_CHECK_THROW(stability_windows(method.letters(), method.coefficients()), wrong);
}

namespace {

struct own_family : symmetric_composition<my_drift, my_kick, 7> {
  static constexpr std::string_view name = "own";
};
/// p -= sin(q) of another force.
struct off_kick : my_kick {
  static constexpr bool moves_q = false;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    x.p[0] -= x.q[1] * t;
    x.p[1] += x.q[0] * t;
  }
};
struct off_family : symmetric_composition<my_drift, off_kick, 7> {
  static constexpr std::string_view name = "off";
};

}  // namespace

// The losses have equal bits, so that a search from one start goes the same way.
BOOST_AUTO_TEST_CASE(what_is_learned_with_it_is_what_is_learned_with_the_library) {
  const henon_heiles system;
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.1);
  const auto data = [&](std::uint64_t seed) {
    return make_flow_map_data(system, starts, fine_steps<>(0.01),
                              {.step = 0.5, .horizon = 2.0, .trajectories = 16, .seed = seed});
  };
  const auto first = data(1);
  const auto second = data(2);
  const learn_options<own_family> options{.classical_starts = false, .random_starts = 0, .guarded = false};
  const learn_options<aba<3>> same{.classical_starts = false, .random_starts = 0, .guarded = false};
  const auto own = learn(own_family(), system, first, second, options);
  const auto known = learn(aba<3>(), system, first, second, same);
  BOOST_TEST(own.summary.loss == known.summary.loss);
  BOOST_TEST(own.method.parameters() == known.method.parameters());
  // Of drifts and kicks of one's own, but of the library's own letters the bands.
  BOOST_TEST(own.summary.guard.starts_with("linearised motion of abababa along "), own.summary.guard);
  BOOST_TEST(!known.summary.guard.starts_with("linearised"), known.summary.guard);
  BOOST_TEST(own.summary.loss < own.summary.held_out_start_loss);
  BOOST_TEST(refuses<std::invalid_argument>([&] { learn(off_family(), system, first, second); },
                                            {"the letter b is not symplectic: it is off by "}));
}
