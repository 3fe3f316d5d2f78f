// SPDX-License-Identifier: BSL-1.0
// Schemes at another size than they were learned for, of plug-ins and libraries of C functions. Tier 1 has
// those of bundled systems in tests/programs/cases/other_size.txt.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <fstream>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The only warning that holds the words.
std::string warning_in(const json& document, const std::string& words) {
  std::string found;
  for (const std::string text : document["warnings"]) {
    if (says(text, words)) found = text;
  }
  return found;
}

/// One line of standard error that says all of these; nothing else was done.
void require_refused(const finished& done, std::initializer_list<const char*> words) {
  BOOST_TEST(done.code == 2, done.err);
  BOOST_TEST(std::ranges::count(done.err, '\n') == 1, done.err);
  for (const char* part : words) BOOST_TEST(says(done.err, part), part << " is missing in " << done.err);
}

/// Quartic wells whose stiffness grows with their number to a power, from their bottoms.
constexpr const char* wells_source = R"(#include <nysalt/plugin.hpp>
#include <cmath>
struct wells {
  static constexpr int dimension = Eigen::Dynamic;
  int number = 1;
  double power = 0.0;
  Eigen::Index size() const { return number; }
  template <class T> T potential(const nysalt::vector<T, dimension>& q) const {
    const double k = std::pow(number, power);
    T sum(0.0);
    for (Eigen::Index i = 0; i < q.size(); ++i) sum += q[i] * q[i] * q[i] * q[i] * (0.25 * k);
    return sum;
  }
};
NYSALT_SYSTEM(wells, "quartic wells", parameter("number", &wells::number, "of wells").at_least(1).size(),
              parameter("power", &wells::power, "by which wells stiffen with their number"),
              starts([](const wells& s) {
                const Eigen::VectorXd rest = Eigen::VectorXd::Zero(s.number);
                return normal_around<Eigen::Dynamic>({rest, rest}, 0.0, 1.0);
              }),
              frequency([](const wells&) { return 3.0; }));
)";

}  // namespace

BOOST_AUTO_TEST_CASE(a_plugin_marks_its_size_and_the_trial_refuses_what_diverges) {
  const scratch folder("other_size_plugin");
  std::ofstream(folder / "wells.hpp") << wells_source;
  BOOST_REQUIRE(run(folder, "build wells.hpp").code == 0);
  const std::string system = "--system ./wells.so ";
  const std::string learn =
      "learn --family nystrom --step 0.3 --trajectories 8 --horizon 6 --loss state:1 --effort quick " +
      system;
  BOOST_REQUIRE(run(folder, learn + "--output alike.json").code == 0);
  BOOST_REQUIRE(run(folder, learn + "--power 4 --output stiffening.json").code == 0);
  const std::string horizon = "--step 0.3 --horizon 3 " + system;
  const auto many = document("run --method alike.json --number 12 " + horizon, folder);
  BOOST_TEST(says(warning_in(many, "another size"), "wells(number=12, power=0)"));
  // k = 12^4, where wells of the energy 1/2 have frequencies up to sqrt(3 sqrt(2 k)) = 25, and z = 7.4; at
  // their bottoms, where the guard looks, there is none.
  require_refused(
      run(folder, "run --method stiffening.json --number 12 --power 4 " + horizon),
      {"stiffening.json must pass the trial for wells(number=12, power=4), as it was learned at another "
       "size, for wells(number=1, power=4): in a trial run of",
       "diverge", "--force"});
  require_refused(
      run(folder, "run --method alike.json --number 12 --power 1 " + horizon),
      {"must run on wells(number=1, power=0), for which it was learned, got wells(number=12, power=1)"});
  // The kind of another source is another.
  std::string text(wells_source);
  std::ofstream(folder / "wells.hpp") << text.replace(text.find("0.25 * k"), 8, "0.26 * k");
  BOOST_REQUIRE(run(folder, "build wells.hpp").code == 0);
  require_refused(run(folder, "run --method alike.json --number 12 " + horizon),
                  {"for which it was learned"});
}

BOOST_AUTO_TEST_CASE(a_library_of_c_functions_may_tell_its_kind) {
  const scratch folder("other_size_c");
  const std::string include = NYSALT_SOURCE_DIR "/include";
  for (const std::string size : {"1", "5"}) {
    for (const std::string kind : {"told", "silent"}) {
      std::ofstream source(folder / "c.c");
      source << "#include \"nysalt/c_force.h\"\nint64_t nysalt_dimension(void) { return " << size << "; }\n"
             << R"(
void nysalt_force(int64_t n, const double* q, double* f, void* data) {
  (void)data;
  for (int64_t i = 0; i < n; ++i) f[i] = -q[i] - q[i] * q[i] * q[i];
}
double nysalt_potential(int64_t n, const double* q, void* data) {
  (void)data;
  double v = 0.0;
  for (int64_t i = 0; i < n; ++i) v += q[i] * q[i] * (0.5 + 0.25 * q[i] * q[i]);
  return v;
}
void nysalt_start(int64_t n, const double* normals, double* q, double* p, void* data) {
  (void)data;
  for (int64_t i = 0; i < n; ++i) q[i] = 0.5 * normals[i], p[i] = normals[n + i];
}
)";
      if (kind == "told") source << "const char* nysalt_kind(void) { return \"duffing()\"; }\n";
      source.close();
      BOOST_REQUIRE(
          shell(folder, "gcc -O2 -shared -fPIC -I '" + include + "' c.c -o " + kind + size + ".so").code ==
          0);
    }
  }
  for (const std::string kind : {"told", "silent"}) {
    BOOST_REQUIRE(
        run(folder,
            "learn --family nystrom --step 0.3 --trajectories 8 --horizon 6 --loss state:1 --effort quick "
            "--system ./" +
                kind + "1.so --output " + kind + ".json")
            .code == 0);
  }
  const auto many = document("run --method told.json --step 0.3 --horizon 3 --system ./told5.so", folder);
  BOOST_TEST(!warning_in(many, "passed the trial run").empty());
  require_refused(run(folder, "run --method silent.json --step 0.3 --horizon 3 --system ./silent5.so"),
                  {"must run on silent1, for which it was learned, got silent5"});
}
