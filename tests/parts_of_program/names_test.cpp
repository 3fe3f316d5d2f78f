// SPDX-License-Identifier: BSL-1.0
// Names with one mistake are found again, and methods are known by what they do.
#include "../../src/comparison/catalogue.hpp"
#include "../../src/comparison/did_you_mean.hpp"
#include "../../src/comparison/known_word.hpp"
#include "nysalt/flows/exact_flow.hpp"

using namespace nysalt::program;
using namespace nysalt;

namespace {

std::vector<std::string> all_names() {
  auto names = method_names();
  for (const auto& name : family_names()) names.push_back("learned:" + name);
  return names;
}

std::vector<double> as_vector(const Eigen::VectorXd& theta) { return {theta.begin(), theta.end()}; }

method method_named(const std::string& name) {
  for (const auto& known : program::classical_methods()) {
    if (known.method.name() == name) return known.method;
  }
  throw std::invalid_argument(name);
}

method table_of(const std::string& letters, std::vector<double> coefficients) {
  return {"mine", word(letters), std::move(coefficients), {2, true, false}};
}

/// kA...k with three times in each k, as a table.
method of_three_parts(const std::string& letters, std::vector<double> coefficients) {
  constexpr word kicks = word_of<kick_of_parts<0, 1, 2>, drift>();
  return {"mine", kicks.with_letters(letters), std::move(coefficients), {2, true, false}};
}

std::string known(const method& method, const std::vector<nysalt::method>& among) {
  return known_as(method, among).value_or("nothing");
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_name_with_one_mistake_is_found) {
  const auto names = all_names();
  for (const auto& name : names) {
    if (name.size() < 5) continue;  // one mistake in four letters may be another name
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    BOOST_TEST(nearest_name(upper, names) == name);
    for (std::size_t i = 1; i + 1 < name.size(); ++i) {
      std::string exchanged = name;
      std::swap(exchanged[i], exchanged[i + 1]);
      for (const std::string& typed :
           {name.substr(0, i) + name.substr(i + 1), name.substr(0, i) + "y" + name.substr(i), exchanged}) {
        const auto found = nearest_name(typed, names);
        BOOST_TEST(!found.empty(), typed);
      }
    }
  }
  BOOST_TEST(nearest_name("pefrll", names) == "pefrl");
  BOOST_TEST(nearest_name("mclachaln5", names) == "mclachlan5");
}

BOOST_AUTO_TEST_CASE(a_beginning_is_found_and_nothing_is_made_up) {
  const std::vector<std::string> systems{"fpu", "lennard_jones", "henon_heiles"};
  BOOST_TEST(nearest_name("lennard", systems) == "lennard_jones");
  BOOST_TEST(nearest_name("Henon", systems) == "henon_heiles");
  BOOST_TEST(nearest_name("le", systems) == "");
  const auto names = all_names();
  for (const std::string& typed :
       {std::string(), std::string("x"), std::string("zzzz"), std::string("nosuch"),
        std::string("gibberish_of_some_length"), std::string(100'000, 'v')}) {
    BOOST_TEST(nearest_name(typed, names) == "", typed);
  }
  BOOST_TEST(did_you_mean("nosuch", {"end", "symmetric", "middle"}) == "it is one of end, symmetric, middle");
  BOOST_TEST(did_you_mean("nosuch", names) == "nysalt list shows all");
  BOOST_TEST(did_you_mean("verlett", names) == "did you mean verlet?");
}

BOOST_AUTO_TEST_CASE(what_families_have_written_down_is_known) {
  std::size_t stable_members = 0;
  for (const auto& family : families()) {
    BOOST_TEST_CONTEXT(family.name) {
      if (family.most_stable_member) {
        ++stable_members;
        BOOST_TEST(known_as(family.name, as_vector(*family.most_stable_member)).has_value());
      }
      for (const auto& [name, theta] : family.starts) {
        const auto found = known_as(family.name, as_vector(theta)).value_or("nothing");
        if (name == "start" || name == "further start") {
          BOOST_TEST((found == "nothing") == (name == "further start"));
        } else {
          BOOST_TEST(found.starts_with(name), found);  // of rotations: pefrl in r_aba4
        }
      }
    }
  }
  BOOST_TEST(stable_members >= 1U);
}

// A start moved by 1e-3 in one parameter is no longer the start, and by 1e-9 still is.
BOOST_AUTO_TEST_CASE(what_differs_is_not_known) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> away(0.5e-3, 1e-3);
  for (const auto& family : families()) {
    BOOST_TEST_CONTEXT(family.name) {
      const auto start = as_vector(family.starts.front().theta);
      for (std::size_t k = 0; k < start.size(); ++k) {
        auto theta = start;
        theta[k] += 1e-9;
        BOOST_TEST(known_as(family.name, theta).has_value());
      }
      auto theta = start;
      for (double& one : theta) one += away(draw);
      BOOST_TEST(!known_as(family.name, theta).has_value());
    }
  }
}

BOOST_AUTO_TEST_CASE(every_classical_method_is_known_by_its_name) {
  for (const auto& one : program::classical_methods()) {
    BOOST_TEST(known(one.method, {one.method}) == one.method.name());
    std::vector<method> others;
    for (const auto& other : program::classical_methods()) {
      if (other.method.name() != one.method.name()) others.push_back(other.method);
    }
    const bool repeats = one.method.name().ends_with("_2x");
    BOOST_TEST((known(one.method, others) != "nothing") == repeats, one.method.name());
  }
}

BOOST_AUTO_TEST_CASE(equal_steps_are_counted) {
  const std::vector<method> verlets{method_named("verlet"), method_named("verlet_aba")};
  BOOST_TEST(known(method_named("verlet_2x"), verlets) == "verlet, 2 steps in one");
  BOOST_TEST(known(table_of("ABABABA", {1 / 6., 1 / 3., 1 / 3., 1 / 3., 1 / 3., 1 / 3., 1 / 6.}), verlets) ==
             "verlet_aba, 3 steps in one");
  BOOST_TEST(known(table_of("ABABABA", {1 / 6., 0.3, 1 / 3., 0.4, 1 / 3., 0.3, 1 / 6.}), verlets) ==
             "nothing");
  BOOST_TEST(known(method_named("baoab_2x"), {method_named("baoab")}) == "baoab, 2 steps in one");
  // A gradient part goes with h^3: an eighth for half a step.
  const method ti = method_named("takahashi_imada");
  const double c = ti.coefficients()[2];
  const auto twice = [&](double part) { return table_of("AGAGA", {0.25, 0.5, part, 0.5, 0.5, part, 0.25}); };
  BOOST_TEST(known(twice(c / 8.0), {ti}) == "takahashi_imada, 2 steps in one");
  BOOST_TEST(known(twice(c / 2.0), {ti}) == "nothing");
}

// However it is written.
BOOST_AUTO_TEST_CASE(letters_that_do_nothing_and_letters_cut_in_two_change_nothing) {
  const std::vector<method> verlet{method_named("verlet")};
  BOOST_TEST(known(table_of("BAB", {0.5, 1.0, 0.5}), verlet) == "verlet");
  BOOST_TEST(known(table_of("ABAB", {0.0, 0.5, 1.0, 0.5}), verlet) == "verlet");
  BOOST_TEST(known(table_of("BAAB", {0.5, 0.25, 0.75, 0.5}), verlet) == "verlet");
  BOOST_TEST(known(table_of("BABAB", {0.25, 0.0, 0.25, 1.0, 0.5}), verlet) == "verlet");
  BOOST_TEST(known(table_of("GAB", {0.5, 0.0, 1.0, 0.5}), verlet) == "verlet");
  BOOST_TEST(known(table_of("GAB", {0.5, 0.01, 1.0, 0.5}), verlet) == "nothing");
  BOOST_TEST(known(table_of("ABA", {0.5, 1.0, 0.5}), verlet) == "nothing");
}

// All coefficients of a letter of one's own are times, and count.
BOOST_AUTO_TEST_CASE(each_time_of_a_letter_of_ones_own_counts) {
  const auto once = of_three_parts("kAk", {0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5});
  BOOST_TEST(known(once, {once}) == "mine");
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> other{0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5};
    other[k] += 0.1;
    other[k + 4] -= 0.1;
    BOOST_TEST(known(of_three_parts("kAk", other), {once}) == "nothing", "part " << k);
  }
  const auto twice = [](double x, double y, double z) {
    return of_three_parts("kAkAk", {x, y, z, 0.5, 1 - 2 * x, 1 - 2 * y, 1 - 2 * z, 0.5, x, y, z});
  };
  BOOST_TEST(known(twice(0.25, 0.25, 0.25), {once}) == "mine, 2 steps in one");
  BOOST_TEST(known(twice(0.25, 0.25, 0.3), {once}) == "nothing");
  BOOST_TEST(known(of_three_parts("kkAk", {0.2, 0.2, 0.2, 0.3, 0.3, 0.3, 1.0, 0.5, 0.5, 0.5}), {once}) ==
             "mine");
  BOOST_TEST(known(of_three_parts("kAkAk", {0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5}),
                   {once}) == "mine");
}
