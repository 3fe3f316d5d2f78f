// SPDX-License-Identifier: BSL-1.0
// Letters of one's own by name: words of them that the program steps, learns, keeps in files and goes on with
// have the bits of the words as types, and resonances are found. What is refused: cases/letters.txt.
// In tier 1: tests/smoke/own_systems_test.cpp, and of their declaration
// tests/parts_of_program/own_letters_test.cpp.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "../../support/program.hpp"
#include "../../support/stopping.hpp"
#include "../../support/systems_with_letters.hpp"
#include "nysalt/run_time_family.hpp"
#include "nysalt/stepper.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
}

/// A plug-in with a system of systems_with_letters.hpp and these letters, at rest but for small deviations.
std::string source_of(const std::string& system, const std::string& letters, const std::string& more = "",
                      const std::string& starts = "{rest, rest}, 0.02 * spread, 0.1 * spread") {
  return "#include <nysalt/plugin.hpp>\n#include \"" NYSALT_SOURCE_DIR
         "/tests/support/systems_with_letters.hpp\"\nusing namespace lettered;\n"
         "NYSALT_SYSTEM(" +
         system + ", \"a system with letters\", letters<" + letters + ">(), " + more +
         "starts([](const auto& s, double spread) {\n  constexpr int N = "
         "std::decay_t<decltype(s)>::dimension;\n"
         "  [[maybe_unused]] const nysalt::vector<double, N> rest = Eigen::VectorXd::Zero(nysalt::size(s));\n"
         "  return normal_around<N>(" +
         starts + ");\n}));\n";
}

const std::string turning =
    source_of("turning", "turn, cubic_kick", "frequency([](const auto&) { return 1.8; }), ");
const std::string walls = source_of("walls", "wall_flow, spring_kick",
                                    "parameter(\"particles\", &walls::particles, \"how many\").size(), "
                                    "parameter(\"stiffness\", &walls::stiffness, \"of the springs\"), ");
const std::string charges =
    source_of("charges", "nysalt::kick_of_part<0>, nysalt::kick_of_part<1>, nysalt::kick_of_parts<0, 1>");

const std::string planets = source_of("planets", "nysalt::kepler_flow, nysalt::kick_of_part<1>",
                                      "frequency([](const auto&) { return 0.0015; }), ",
                                      "nysalt::outer_solar_system_start(), 0.01 * spread, 0.0");

using turns =
    nysalt::word<lettered::turn, lettered::cubic_kick, lettered::turn, lettered::cubic_kick, lettered::turn>;
using kicks = nysalt::word<lettered::spring_kick, lettered::wall_flow, lettered::spring_kick,
                           lettered::wall_flow, lettered::spring_kick>;
using kick_of_planets = nysalt::kick_of_part<1>;
using fast = nysalt::kick_of_part<0>;
using both = nysalt::kick_of_parts<0, 1>;
using nested = nysalt::word<both, nysalt::drift, fast, nysalt::drift, fast, nysalt::drift, both>;

/// A system and a word of its letters, as types and as the program knows them.
struct turning_case {
  using system = lettered::turning;
  using word = turns;
  static constexpr const char* times = "tctct";
  static constexpr const char* guard = "trial runs only: ";
  static constexpr double step = 0.7;
  static const std::string& source() { return turning; }
};
struct walls_case {
  using system = lettered::walls;
  using word = kicks;
  static constexpr const char* times = "8w8w8";
  static constexpr const char* guard = "trial runs only: ";
  static constexpr double step = 0.4;
  static const std::string& source() { return walls; }
};
struct charges_case {
  using system = lettered::charges;
  using word = nested;
  static constexpr const char* times = "01A0A0A01";
  static constexpr const char* guard = "linearised motion of k";
  static constexpr double step = 0.05;
  static const std::string& source() { return charges; }
};
struct planets_case {
  using system = lettered::planets;
  using word = nysalt::word<kick_of_planets, nysalt::kepler_flow, kick_of_planets, nysalt::kepler_flow,
                            kick_of_planets>;
  static constexpr const char* times = "1K1K1";
  static constexpr double step = 200.0;
  static const std::string& source() { return planets; }
};
using learned_cases = std::tuple<turning_case, walls_case, charges_case>;
using all_cases = std::tuple<turning_case, walls_case, charges_case, planets_case>;

template <class Case>
std::string letters() {
  return Case::word::letters();
}
template <class Case>
nysalt::run_time_family family() {
  const typename Case::system system;
  return symmetric_word("word", nysalt::run_time_word(typename Case::word{}, system), Case::times);
}
template <class Case>
std::string here() {
  return fmt::format(" --system ./mine.hpp --step {} ", Case::step);
}

/// Rows of numbers, behind those of the trajectory, the step and the time.
std::vector<std::vector<double>> numbers_in(const std::string& table) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    int column = 0;
    for (std::string cell; std::getline(cells, cell, ',');) {
      if (column++ >= 3) row.push_back(std::strtod(cell.c_str(), nullptr));
    }
  }
  return rows;
}

constexpr int steps = 9;
constexpr int every = 4;

/// States at steps 0, 4, 8 of two trajectories by the program: q and p in each row.
template <class Case>
std::vector<std::vector<double>> by_program(const scratch& folder, const std::string& method,
                                            const std::string& more = "") {
  const auto n = nysalt::size(typename Case::system());
  std::string all;
  for (const char* of : {"q", "p"}) {
    for (Eigen::Index i = 1; i <= n; ++i) all += fmt::format("{}{}{}", all.empty() ? "" : ",", of, i);
  }
  const auto done =
      run(folder, fmt::format("run{}--method {} --horizon {} --sample-every {} --trajectories 2 "
                              "--observables {} {}",
                              here<Case>(), method, steps * Case::step, every, all, more));
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  return numbers_in(done.out);
}

/// The same by the word as a type from the first row of each trajectory.
template <class Case>
std::vector<std::vector<double>> by_type(const std::vector<std::vector<double>>& seen,
                                         const std::vector<double>& c) {
  using S = typename Case::system;
  using W = typename Case::word;
  typename W::template coefficients<double> all;
  std::copy(c.begin(), c.end(), all.begin());
  const S system;
  const nysalt::stepper<S, W, double> stepper(system, all, Case::step);
  const Eigen::Index n = nysalt::size(system);
  std::vector<std::vector<double>> rows;
  constexpr std::size_t of_each = 1 + steps / every;
  for (std::size_t first = 0; first < seen.size(); first += of_each) {
    const Eigen::Map<const Eigen::VectorXd> start(seen[first].data(), 2 * n);
    const nysalt::phase_point<double, S::dimension> begin{start.head(n), start.tail(n)};
    auto run = stepper.open(begin);
    for (std::size_t k = 0; k < of_each; ++k) {
      if (k > 0) stepper.advance(run, every);
      const nysalt::phase_point<double, S::dimension> x = k > 0 ? stepper.synchronous(run) : begin;
      auto& row = rows.emplace_back(x.q.begin(), x.q.end());
      row.insert(row.end(), x.p.begin(), x.p.end());
    }
  }
  return rows;
}

std::string table(const std::string& letters, const std::vector<double>& coefficients) {
  return json{
      {"format", "nysalt table"}, {"version", 1}, {"letters", letters}, {"coefficients", coefficients}}
      .dump();
}

/// Slow half kicks about n steps of drift, fast kick, drift, on four masses with bonds of omega = 20, and
/// where they resonate.
struct resonant_word {
  int fast_kicks;
  double slow_stiffness =
      2.31;  // of the fastest mode of `charges` at rest: 1 of the trap, else of the charges

  std::string letters() const {
    std::string all = "1";
    for (int k = 0; k < fast_kicks; ++k) all += "A0";
    return all + "A1";
  }
  /// The step h at an offset from the middle of the resonance tongue of the fastest mode at h omega = pi, the
  /// offset in half widths of the tongue.
  double step(double half_widths) const {
    const double omega = 40.0 * std::sin(3.0 * std::numbers::pi / 8.0);
    // The fast steps turn it by 2 n asin(h omega/(2 n)); at half a turn only the slow kick moves it on.
    const double angle = std::numbers::pi / (2.0 * fast_kicks);
    const double upper_end = 2.0 * fast_kicks * std::sin(angle) / omega;
    // Of first order in h k/omega: slow kicks turn by 2 d more, d = h k cos(angle)/(2 omega), and are
    // unstable while pi - 2 d < fast turn < pi.
    const double width = slow_stiffness * std::pow(std::cos(angle) / omega, 2);
    return upper_end * (1.0 - 0.5 * width * (1.0 - half_widths));
  }
  /// Options of learn that leave the member of equal steps alone.
  std::string fixed() const {
    const double n = fast_kicks;
    std::string all;
    for (int k = 1; k <= (fast_kicks - 1) / 2; ++k)
      all += fmt::format("--fix 0{0}={1:.17g} --fix A{0}={2:.17g} ", k, 1.0 / n, (k == 1 ? 0.5 : 1.0) / n);
    return all + "--trajectories 16 --effort quick ";
  }
};

/// Masses on bonds, in traps that are quartic too: of any number, which is a size.
constexpr const char* row = R"(#include <nysalt/plugin.hpp>
#include <nysalt/flows/kick_of_parts.hpp>
struct bonds {
  static constexpr int dimension = Eigen::Dynamic;
  long masses = 3;
  Eigen::Index size() const { return masses; }
  template <class T> T potential(const nysalt::vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i + 1 < masses; ++i) sum += (q[i + 1] - q[i]) * (q[i + 1] - q[i]) * 200.0;
    return sum;
  }
};
struct traps {
  static constexpr int dimension = Eigen::Dynamic;
  long masses = 3;
  Eigen::Index size() const { return masses; }
  template <class T> T potential(const nysalt::vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i < masses; ++i) sum += q[i] * q[i] * (1.0 + q[i] * q[i] * 0.1);
    return sum;
  }
};
struct row {
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr std::size_t parts = 2;
  long masses = 3;
  Eigen::Index size() const { return masses; }
  template <std::size_t I> auto part() const {
    if constexpr (I == 0) return bonds{masses}; else return traps{masses};
  }
  template <class T> T potential(const nysalt::vector<T, dimension>& q) const {
    return part<0>().potential(q) + part<1>().potential(q);
  }
};
NYSALT_SYSTEM(row, "masses on bonds in traps", letters<nysalt::kick_of_part<0>, nysalt::kick_of_part<1>>(),
              parameter("masses", &row::masses, "in the row").at_least(2).size(),
              starts([](const row& s) {
                const Eigen::VectorXd rest = Eigen::VectorXd::Zero(s.masses);
                return normal_around<Eigen::Dynamic>({rest, rest}, 0.02, 0.1);
              }));
)";

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(a_word_by_name_has_the_bits_of_its_type, Case, all_cases) {
  const scratch folder("letters_bits");
  write(folder, "mine.hpp", Case::source());
  const auto like = family<Case>();
  const auto equal_steps = like.coefficients(like.starts.front().theta);
  const auto seen = by_program<Case>(folder, "word:" + letters<Case>());
  BOOST_TEST_REQUIRE(seen.size() == 6U);
  BOOST_TEST((seen == by_type<Case>(seen, equal_steps)));
  // Arbitrary coefficients from a file have the bits of the type, and another member of the family has
  // others.
  Eigen::VectorXd theta = like.starts.front().theta;
  for (Eigen::Index k = 0; k < theta.size(); ++k) theta[k] *= 1.0 + 0.01 / static_cast<double>(k + 1);
  const auto others = like.coefficients(theta);
  write(folder, "table.json", table(letters<Case>(), others));
  const auto seen_of_table = by_program<Case>(folder, "table.json");
  BOOST_TEST((seen_of_table == by_type<Case>(seen_of_table, others)));
  BOOST_TEST((seen_of_table != by_type<Case>(seen_of_table, equal_steps)));
}

BOOST_AUTO_TEST_CASE_TEMPLATE(what_is_learned_is_kept_by_name_to_the_bit, Case, learned_cases) {
  const scratch folder("letters_learned");
  write(folder, "mine.hpp", Case::source());
  const std::string name = "word:" + letters<Case>();
  const auto learned =
      run(folder, fmt::format("learn{}--family {} --horizon {} --trajectories 16 --effort quick "
                              "--output scheme.json --json --force",
                              here<Case>(), name, 8 * Case::step));
  BOOST_TEST_REQUIRE(learned.code != 2, learned.err);
  const json found = json_of(learned);
  BOOST_TEST(found["family"] == name);
  BOOST_TEST(found["guard"].get<std::string>().starts_with(Case::guard), found["guard"]);
  BOOST_TEST(found["loss"].get<double>() > 0.0);
  const json kept = json::parse(contents(folder / "scheme.json"));
  BOOST_TEST(kept["parameters"] == found["parameters"]);
  const std::string names = letters<Case>();
  for (const auto& one : kept["own_letters"]) {
    BOOST_TEST(names.find(one["letter"].get<std::string>()) != std::string::npos);
  }
  BOOST_TEST(!kept["own_letters"].empty());
  const auto like = family<Case>();
  Eigen::VectorXd theta(like.parameters());
  for (Eigen::Index k = 0; k < theta.size(); ++k)
    theta[k] = kept["parameters"][like.parameter_names[static_cast<std::size_t>(k)]];
  const auto seen = by_program<Case>(folder, "scheme.json", "--force");
  BOOST_TEST((seen == by_type<Case>(seen, like.coefficients(theta))));
  BOOST_TEST((seen != by_type<Case>(seen, like.coefficients(like.starts.front().theta))));
  // compare takes the file, the word and the family side by side.
  const auto compared = run(folder, fmt::format("compare --system ./mine.hpp --steps {} --methods "
                                                "{},scheme.json,verlet --metric state --trajectories 16 "
                                                "--horizon {} --json --force",
                                                Case::step, name, 20 * Case::step));
  BOOST_TEST_REQUIRE(compared.code == 0, compared.err);
  const json rows = json_of(compared)["rows"];
  BOOST_TEST_REQUIRE(rows.size() == 3U);
  BOOST_TEST(rows[0]["error"].get<double>() > 0.0);
  BOOST_TEST(rows[1]["error"] != rows[0]["error"]);
}

BOOST_AUTO_TEST_CASE(a_learned_nested_word_is_better_than_r_respa) {
  const scratch folder("letters_better");
  write(folder, "mine.hpp", charges);
  const auto compared = document(
      "compare --system ./mine.hpp --steps 0.06 --methods word:kA0A0A0Ak,learned:word:kA0A0A0Ak --metric "
      "state "
      "--trajectories 32 --horizon 2.4 --learn-horizon 2.4 --learn-trajectories 16",
      folder);
  const double respa = compared["rows"][0]["error"];
  const double learned = compared["rows"][1]["error"];
  BOOST_TEST(learned < 0.5 * respa);  // measured: 0.04; r-RESPA errs by the phase of the bonds
}

BOOST_AUTO_TEST_CASE(threads_and_a_stop_change_no_byte) {
  const scratch folder("letters_resume");
  write(folder, "mine.hpp", turning);
  for (const std::string bath : {"", " --friction 0.1 --temperature 0.005"}) {
    const std::string line =
        "run --system ./mine.hpp --method word:tctct --step 0.5 --horizon 400 --trajectories 37 "
        "--sample-every 70 "
        "--observables energy,q1" +
        bath + " ";
    BOOST_TEST_REQUIRE(run(folder, line + "--threads 2 --output whole.csv").code == 0);
    const std::string whole = contents(folder / "whole.csv");
    const std::string cut = line + "--output cut.csv --checkpoint cut.checkpoint --every 100 --threads 1 ";
    BOOST_TEST(is_killed_at(folder, "rename:4", cut));
    // Of another word the checkpoint is refused.
    auto other = cut;
    other.replace(other.find("tctct"), 5, "ctctc");
    all_refused(folder, {{other + "--resume", {"cut.checkpoint"}}});
    const auto done = run(folder, cut + "--resume");
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    BOOST_TEST((contents(folder / "cut.csv") == whole));
  }
}

// Half a turn of the fastest mode between slow kicks; far beside the tongue the linear criterion has no
// objection. Near to it energies err by much, which is another matter.
BOOST_AUTO_TEST_CASE(resonances_of_slow_kicks_are_found_by_each_command) {
  const scratch folder("letters_resonance");
  write(folder, "mine.hpp", charges);
  const auto arguments = [](const std::string& command, const resonant_word& word, double half_widths,
                            const std::string& option) {
    return fmt::format("{} --system ./mine.hpp {} word:{} --step {:.12g} ", command, option, word.letters(),
                       word.step(half_widths));
  };
  for (const int n : {2, 3, 5, 7}) {
    for (const double half_widths : {-60.0, 0.0, 60.0}) {
      const bool is_stable = half_widths != 0.0;
      const auto said = document(arguments("stability", {n}, half_widths, "--method"), folder)["judgement"];
      BOOST_TEST(said["linear_objection"].is_null() == is_stable, said.dump());
      BOOST_TEST((is_stable || said["verdict"] != "good"), said.dump());
    }
  }
  const resonant_word word{3};
  const auto ran = run(folder, arguments("run", word, 0.0, "--method") + "--horizon 1");
  BOOST_TEST(ran.code == 0);
  BOOST_TEST(ran.err.find(fmt::format("word:{} at step", word.letters())) != std::string::npos, ran.err);
  // Of the one member that learn may take it says whether that is usable.
  const auto learned = run(folder, arguments("learn", word, 0.0, "--family") + word.fixed() + "--json");
  BOOST_TEST(learned.code == 3, learned.err);
  BOOST_TEST(json_of(learned)["usable"] == false, learned.out);
  BOOST_TEST(learned.err.find("trajectories are lost") != std::string::npos, learned.err);
}

// What was learned beside the tongue, or for three masses, whose fastest mode is slower, is refused in it.
BOOST_AUTO_TEST_CASE(resonances_between_learned_steps_and_at_another_size_are_refused) {
  const scratch folder("letters_row");
  write(folder, "row.hpp", row);
  constexpr resonant_word word{7, 2.0};  // the stiffness of the traps
  const std::string family = "--family word:" + word.letters() + " " + word.fixed();
  const auto of = [](const std::string& command, int masses) {
    return fmt::format("{} --system ./row.hpp --masses {} ", command, masses);
  };
  const auto at = [&](double half_widths) { return fmt::format("--step {:.12g} ", word.step(half_widths)); };
  const auto learned = [&](int masses, const std::string& step, const std::string& file) {
    const auto done = run(folder, of("learn", masses) + family + step + "--output " + file);
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
  };

  const auto steps = fmt::format("--steps {:.12g},{:.12g},{:.12g},{:.12g} ", word.step(-120.0),
                                 word.step(-60.0), word.step(60.0), word.step(120.0));
  learned(4, steps, "curve.json");
  const std::string run_curve = of("run", 4) + "--method curve.json --horizon 1 ";
  for (const double half_widths : {-90.0, 60.0, 90.0}) {
    const auto ran = run(folder, run_curve + at(half_widths));
    BOOST_TEST(ran.code == 0, ran.err);
  }
  const std::string compare_curve =
      of("compare", 4) +
      fmt::format("--methods curve.json --metric state --horizon 2 --steps {:.12g}", word.step(0.0));
  const std::string reason = "trajectories are lost";
  for (const auto& line : {run_curve + at(0.0), compare_curve})
    all_refused(folder, {{line, {"curve.json must hold between the steps", reason}}});
  const auto forced = run(folder, run_curve + at(0.0) + "--force");
  BOOST_TEST(forced.code == 0, forced.err);
  BOOST_TEST(forced.err.find(reason) != std::string::npos, forced.err);

  for (const double half_widths : {0.0, 60.0}) {
    learned(3, at(half_widths), "small.json");
    const auto run_small = [&](int masses, const std::string& more = "") {
      return of("run", masses) + "--method small.json --horizon 1 " + at(half_widths) + more;
    };
    BOOST_TEST(run(folder, run_small(3)).code == 0);
    if (half_widths == 0.0) {
      all_refused(folder, {{run_small(4), {"small.json must hold", "learned at another size", reason}}});
      BOOST_TEST(run(folder, run_small(4, "--force")).err.find(reason) != std::string::npos);
    } else {
      const auto larger = run(folder, run_small(4));
      BOOST_TEST(larger.code == 0, larger.err);
      BOOST_TEST(larger.err.find("it was judged") != std::string::npos, larger.err);
      BOOST_TEST(larger.err.find(reason) == std::string::npos, larger.err);
    }
  }
}
