// SPDX-License-Identifier: BSL-1.0
// Shared objects with the functions of nysalt/c_force.h are systems, and what a user may get wrong in them.
// In tier 1: tests/smoke/own_systems_test.cpp.
#include <boost/test/unit_test.hpp>

#include <fstream>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

/// Two oscillators with a cubic term, as tests/laws has Henon and Heiles' system.
constexpr const char* henon_heiles = R"(
int64_t nysalt_dimension(void) { return 2; }
void nysalt_force(int64_t n, const double* q, double* f, void* data) {
  (void)n, (void)data;
  f[0] = -q[0] - 2.0 * q[0] * q[1];
  f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
}
double nysalt_potential(int64_t n, const double* q, void* data) {
  (void)n, (void)data;
  return 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / 3.0;
}
void nysalt_start(int64_t n, const double* normals, double* q, double* p, void* data) {
  (void)data;
  for (int64_t i = 0; i < n; ++i) q[i] = 0.1 * normals[i], p[i] = 0.1 * normals[n + i];
}
)";

/// `./NAME.so` of the source; the text of the compiler where it fails.
std::string built(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / (name + ".c")) << "#include \"nysalt/c_force.h\"\n#include <stdlib.h>\n" << text;
  const std::string include = NYSALT_SOURCE_DIR "/include";
  return shell(folder, "gcc -O2 -Wall -Wextra -Werror -shared -fPIC -I '" + include + "' " + name + ".c -o " +
                           name + ".so")
      .err;
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const auto at = text.find(old);
  BOOST_REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), by);
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_learned_for_and_its_schemes_are_of_its_file) {
  const scratch folder("c_force_learn");
  BOOST_REQUIRE_EQUAL(built(folder, "mine", henon_heiles), "");
  const std::string learn =
      "learn --system ./mine.so --family bab2 --step 0.5 --trajectories 10 --effort quick --threads ";
  BOOST_TEST(run(folder, learn + "1 --output one.json").code == 0);
  BOOST_TEST(run(folder, learn + "2 --output two.json").code == 0);
  BOOST_TEST(shell(folder, "cmp one.json two.json").code == 0);
  const std::string go = "run --system ./mine.so --method one.json --step 0.5 --horizon 10 --output o.csv";
  BOOST_TEST(run(folder, go).code == 0);
  BOOST_REQUIRE_EQUAL(built(folder, "mine", replaced(henon_heiles, "0.1 * normals[i]", "0.2 * normals[i]")),
                      "");
  const auto other = run(folder, go);
  BOOST_TEST(other.code == 2);
  BOOST_TEST(other.err.find("must run on the source and the parameters") != std::string::npos, other.err);
}

BOOST_AUTO_TEST_CASE(each_thread_has_data_of_its_own) {
  const scratch folder("c_force_data");
  // Room of each data for one force at a time: another thread in it is seen.
  std::string text = replaced(henon_heiles, "(void)n, (void)data;\n  f[0]",
                              "(void)n;\n  int* in = data;\n  if (++*in != 1) abort();\n  f[0]");
  text = replaced(text, "+ q[1] * q[1];\n}", "+ q[1] * q[1];\n  --*in;\n}");
  text +=
      "void* nysalt_open(void) { return calloc(1, sizeof(int)); }\nvoid nysalt_close(void* data) { "
      "free(data); }\n";
  BOOST_REQUIRE_EQUAL(built(folder, "mine", text), "");
  const auto done =
      run(folder,
          "run --system ./mine.so --spread 0.3 --method verlet --step 0.05 --horizon 500 --trajectories 40 "
          "--threads 4 --observables energy --output o.csv");
  BOOST_TEST(done.code == 0, done.err);
}

BOOST_AUTO_TEST_CASE(masses_spread_and_a_bath) {
  const scratch folder("c_force_more");
  BOOST_REQUIRE_EQUAL(built(folder, "heavy",
                            std::string(henon_heiles) +
                                "double nysalt_inverse_mass(int64_t i) { return i == 0 ? 1.0 : 0.25; }\n"
                                "double nysalt_frequency(void) { return 2.0; }\n"
                                "const char* nysalt_description(void) { return \"heavy(4)\"; }\n"),
                      "");
  const auto report = json_of(run(folder,
                                  "compare --system ./heavy.so --spread 0.5 --methods verlet --steps 0.1 "
                                  "--trajectories 8 --metric energy --json"));
  BOOST_TEST(report.dump().find("heavy(4)") != std::string::npos);
  const auto bath =
      run(folder,
          "run --system ./heavy.so --friction 1 --temperature 0.01 --start law --method baoab --step 0.1 "
          "--horizon 10 --observables kinetic_temperature --output o.csv");
  BOOST_TEST(bath.code == 0, bath.err);
}

BOOST_AUTO_TEST_CASE(what_is_wrong_is_told) {
  const scratch folder("c_force_wrong");
  const auto must_be_told = [&](const std::string& text, const std::string& words) {
    BOOST_REQUIRE_EQUAL(built(folder, "bad", text), "");
    all_refused(folder, {{"run --system ./bad.so --method verlet --step 0.1 --horizon 1 --output o.csv",
                          {words, "bad"}}});
  };
  const std::string whole = henon_heiles;
  must_be_told(replaced(whole, "nysalt_potential", "my_potential"), "must define nysalt_potential");
  must_be_told(replaced(whole, "nysalt_start", "my_start"), "must define nysalt_start");
  must_be_told(replaced(whole, "nysalt_dimension", "my_dimension"), "must define nysalt_dimension");
  must_be_told(replaced(whole, "return 2;", "return 0;"), "nysalt_dimension must be 1 to");
  must_be_told(replaced(whole, "-q[0] - 2.0", "-q[0] + 2.0"), "force");
  must_be_told(replaced(whole, "0.1 * normals[i]", "0.0 / 0.0"), "must be finite");
  must_be_told(whole + "double nysalt_inverse_mass(int64_t i) { return i - 1.0; }\n",
               "nysalt_inverse_mass(0) must be");
  must_be_told(whole + "double nysalt_frequency(void) { return -1.0; }\n", "nysalt_frequency must be");
  must_be_told(whole + "void* nysalt_open(void) { return NULL; }\n",
               "nysalt_open must return a pointer, got null");
  must_be_told(whole + "const char* nysalt_description(void) { return NULL; }\n",
               "nysalt_description must return a text, got null");
  must_be_told(whole + "const char* nysalt_kind(void) { return NULL; }\n",
               "nysalt_kind must return a text, got null");
  must_be_told("int nothing;\n", "c_force.h");
}

// A library that ends the process by exit(), abort() or a fault leaves no unfinished file.
BOOST_AUTO_TEST_CASE(an_end_by_the_library_leaves_no_unfinished_file) {
  const scratch folder("c_force_end");
  for (const std::string end : {"exit(0)", "abort()", "*(volatile int*)0 = 0"}) {
    const std::string text =
        replaced(henon_heiles, "(void)n, (void)data;\n  f[0]",
                 "(void)n, (void)data;\n  static int calls;\n  if (++calls > 5000) " + end + ";\n  f[0]");
    BOOST_REQUIRE_EQUAL(built(folder, "bad", text), "");
    const auto done = run(folder,
                          "run --system ./bad.so --method verlet --step 0.1 --horizon 1e4 --sample-every 10 "
                          "--threads 1 --output o.csv");
    BOOST_TEST(done.err.find("was in use: check the plug-in first") != std::string::npos, end << done.err);
    BOOST_TEST(done.code != 0);
    BOOST_TEST(!folder.files().contains("o.csv.new.part"), end);
    BOOST_TEST(!folder.files().contains("o.csv"), end);
  }
}

// Schemes at another size, of a library that says what both are.
BOOST_AUTO_TEST_CASE(a_library_may_tell_its_kind) {
  const scratch folder("c_force_kind");
  const std::string at =
      " --step 0.3 --loss state:1 --family nystrom --trajectories 8 --horizon 6 --effort quick";
  const std::string wells = replaced(
      replaced(henon_heiles, "f[0] = -q[0] - 2.0 * q[0] * q[1];\n  f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];",
               "for (int64_t i = 0; i < n; ++i) f[i] = -q[i] - q[i] * q[i] * q[i];"),
      "return 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / 3.0;",
      "double v = 0.0;\n  for (int64_t i = 0; i < n; ++i) v += q[i] * q[i] * (0.5 + 0.25 * q[i] * q[i]);\n  "
      "return v;");
  const std::string kind = "const char* nysalt_kind(void) { return \"duffing()\"; }\n";
  for (const std::string size : {"1", "5"}) {
    const std::string text = replaced(wells, "return 2;", "return " + size + ";");
    BOOST_REQUIRE_EQUAL(built(folder, "silent" + size, text) + built(folder, "told" + size, text + kind), "");
  }
  for (const std::string name : {"told", "silent"})
    BOOST_REQUIRE(run(folder, "learn --system ./" + name + "1.so --output " + name + ".json" + at).code == 0);
  const auto many = document("run --method told.json --step 0.3 --horizon 3 --system ./told5.so", folder);
  BOOST_TEST(many["warnings"].dump().find("it was judged") != std::string::npos);
  all_refused(folder, {{"run --method silent.json --step 0.3 --horizon 3 --system ./silent5.so",
                        {"must run on silent1, for which it was learned, got silent5"}}});
}
