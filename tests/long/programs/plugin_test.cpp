// SPDX-License-Identifier: BSL-1.0
// Systems of users: sources that are compiled and loaded, at another size too, and what a user may get wrong;
// more in cases/own_systems.txt. In tier 1: tests/smoke/own_systems_test.cpp.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "../../support/program.hpp"
#include "../../support/sanitizers.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
}

/// The chain of the program, as a user would declare it.
constexpr const char* fpu_source = R"(#include <nysalt/plugin.hpp>
#include <nysalt/systems/fpu_chain.hpp>
#include <nysalt/ensembles/fpu_law.hpp>
struct fpu : nysalt::fpu_chain<3> {
  fpu() : nysalt::fpu_chain<3>(50.0) {}
};
NYSALT_SYSTEM(fpu, "stiff and soft springs in turn",
              starts([](const fpu& s, double spread) { return fpu_law<3>(s, spread); }),
              frequency([](const fpu& s) { return s.omega(); }));
)";

/// An oscillator with these members, and these pieces of its declaration.
std::string oscillator_source(const std::string& members, const std::string& pieces = "",
                              const std::string& kind = "") {
  return "#include <nysalt/plugin.hpp>\n#include <cmath>\n#include <cstdlib>\n#include <stdexcept>\n"
         "using one = nysalt::vector<double, 1>;\nstruct tried" +
         kind + " {\n  static constexpr int dimension = 1;\n  double k = 1.0;\n  " + members +
         "\n};\nNYSALT_SYSTEM(tried, \"p^2/2 + k q^2/2\", parameter(\"k\", &tried::k, \"stiffness\")" +
         pieces +
         ",\n  starts([](const tried&) { return normal_around<1>({one(1.0), one(0.0)}, 0.1, 0.1); }));\n";
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

std::string potential_that(const std::string& does) {
  return "template <class T> T potential(const nysalt::vector<T, 1>& q) const { " + does +
         " return 0.5 * k * q[0] * q[0]; }";
}

/// Where the last segment of a library ends: what follows, as names for debuggers, is not loaded.
std::uintmax_t end_of_segments(const scratch& folder, const std::string& library) {
  const auto listed =
      shell(folder, "readelf -lW " + library + " | awk '$2 ~ /^0x/ && $5 ~ /^0x/ { print $2, $5 }'");
  std::istringstream places(listed.out);
  std::uintmax_t end = 0;
  std::uintmax_t offset = 0;
  std::uintmax_t size = 0;
  while (places >> std::hex >> offset >> size) end = std::max(end, offset + size);
  return end;
}

}  // namespace

// The bundled chain and the same one as a plug-in, by every command.
BOOST_AUTO_TEST_CASE(a_plugin_has_the_numbers_of_the_bundled_system) {
  const scratch folder("plugin_fpu");
  write(folder, "own.hpp", fpu_source);
  for (const std::string command :
       {"learn --step 0.03 --trajectories 16 --threads 2",
        "learn --step 0.03 --trajectories 16 --family r_aba4",
        "learn --step 0.03 --trajectories 16 --family nystrom --friction 0.1 --temperature 1 --placement "
        "middle",
        "compare --steps 0.02,0.04 --methods verlet,learned:nystrom --metric state,exchange,path "
        "--trajectories 32 --learn-trajectories 8 --threads 3",
        "stability --method bcss3 --step 0.04"}) {
    const auto of = [&](const std::string& system) {
      json found = document(command + " --system " + system, folder);
      for (auto& [key, fits] : found.items()) {
        if (key != "fits") continue;
        for (auto& one : fits) {  // schemes name their system
          for (const char* name : {"system", "checksum"}) one["scheme"].erase(name);
        }
      }
      return without_times(found.dump(1));
    };
    BOOST_TEST(of("./own.hpp") == of("fpu"), command);
  }
  const std::string sampled =
      "run --method srkn6b --step 0.02 --horizon 20 --trajectories 33 "
      "--observables energy,q1,stiff_energy_2 ";
  BOOST_TEST(run(folder, sampled + "--system ./own.hpp").out == run(folder, sampled + "--system fpu").out);
  BOOST_TEST(run(folder, sampled + "--system ./own.hpp").out !=
             run(folder, sampled + "--system fpu --omega 49").out);
}

// What was begun or learned with one source is not gone on with by another of the same description.
BOOST_AUTO_TEST_CASE(another_source_is_another_system) {
  const unoptimised_plugins plugins;
  const scratch folder("plugin_sources");
  write(folder, "tried.hpp",
        oscillator_source("#include \"factor.hpp\"\n" + potential_that("return FACTOR * k * q[0] * q[0];")));
  write(folder, "factor.hpp", "#define FACTOR 0.5\n");
  run(folder,
      "learn --system ./tried.hpp --step 0.5 --family nystrom --trajectories 4 --force --output scheme.json");
  const std::string use = "run --system ./tried.hpp --step 0.5 --horizon 2 --method scheme.json --k ";
  const char* said = "must run on the source and the parameters";
  const auto same = run(folder, use + "1");
  BOOST_TEST(same.err.find(said) == std::string::npos, same.err);
  all_refused(folder, {{use + "2", {}}});
  write(folder, "factor.hpp", "#define FACTOR 5.0\n");
  all_refused(folder, {{use + "1", {said}}});
}

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
  BOOST_TEST(many["warnings"].dump().find("wells(number=12, power=0)") != std::string::npos);
  // k = 12^4, where wells of the energy 1/2 have frequencies up to sqrt(3 sqrt(2 k)) = 25, and z = 7.4; at
  // their bottoms, where the guard looks, there is none.
  all_refused(
      folder,
      {{"run --method stiffening.json --number 12 --power 4 " + horizon,
        {"stiffening.json must hold for wells(number=12, power=4), as it was learned at another "
         "size, for wells(number=1, power=4), got: ",
         "are lost", "--force"}},
       {"run --method alike.json --number 12 --power 1 " + horizon,
        {"must run on wells(number=1, power=0), for which it was learned, got wells(number=12, power=1)"}}});
  // The kind of another source is another.
  std::string text(wells_source);
  std::ofstream(folder / "wells.hpp") << text.replace(text.find("0.25 * k"), 8, "0.26 * k");
  BOOST_REQUIRE(run(folder, "build wells.hpp").code == 0);
  all_refused(folder, {{"run --method alike.json --number 12 " + horizon, {"for which it was learned"}}});
}

// As a full disk leaves a library behind: the source is compiled again. A damaged file that was named itself
// is not. Of a library that is cut off the loader maps also what is missing, and the first use of that is a
// signal.
BOOST_AUTO_TEST_CASE(a_damaged_library_in_the_cache_is_compiled_again) {
  const unoptimised_plugins plugins;
  const scratch folder("plugin_damaged");
  write(folder, "well.hpp", oscillator_source(potential_that("")));
  const std::string use =
      "XDG_CACHE_HOME=$PWD/cache $nysalt run --method verlet --step 0.1 --horizon 0.1 --system ";
  const auto first = shell(folder, use + "well.hpp");
  BOOST_REQUIRE_MESSAGE(first.code == 0, first.err);
  BOOST_TEST(shell(folder, "cp cache/nysalt/plugins/*.so whole.so").code == 0);
  const auto length = std::filesystem::file_size(folder / "whole.so");
  const auto cut = [&](const std::string& files, std::uintmax_t at) {
    return shell(folder, "for f in " + files + "; do head -c " + std::to_string(at) +
                             " whole.so >cut && mv cut $f; done")
        .code;
  };
  BOOST_TEST(cut("cache/nysalt/plugins/*.so", 100) == 0);
  // What a compiler left that was killed goes with the next one, unless it may be at work.
  BOOST_TEST(
      shell(folder, "cd cache/nysalt/plugins; touch -d '2 days ago' x.so.1.part; touch x.so.2.part").code ==
      0);
  const auto again = shell(folder, use + "well.hpp");
  BOOST_TEST(again.code == 0, again.err);
  BOOST_TEST(again.out == first.out);
  BOOST_TEST(!std::filesystem::exists(folder / "cache/nysalt/plugins/x.so.1.part"));
  BOOST_TEST(std::filesystem::exists(folder / "cache/nysalt/plugins/x.so.2.part"));
  BOOST_TEST(cut("cache/nysalt/plugins/*.so", length / 2) == 0);
  const auto built = shell(folder, "XDG_CACHE_HOME=$PWD/cache $nysalt build well.hpp");
  BOOST_TEST(built.code == 0, built.err);
  BOOST_TEST(shell(folder, use + "./well.so").code == 0);
  const std::uintmax_t loaded = end_of_segments(folder, "whole.so");
  BOOST_TEST_REQUIRE(loaded > 0U);
  BOOST_TEST_REQUIRE(loaded <= length);
  constexpr std::uintmax_t cuts = 50;
  for (std::uintmax_t k = 0; k < cuts; ++k) {
    const std::uintmax_t at = k * length / cuts;
    BOOST_TEST(cut("own.so", at) == 0);
    const auto done = shell(folder, use + "./own.so");
    if (at >= loaded) {
      BOOST_TEST(done.code == 0, "cut at " << at << ": " << done.err);
      BOOST_TEST(done.out == first.out);
    } else {
      BOOST_TEST(done.code == 2, "cut at " << at << ": " << done.err);
      BOOST_TEST(done.err.find("cannot load ./own.so as a library") != std::string::npos, done.err);
    }
  }
}

// Without them everything works, thirty times as slowly.
BOOST_AUTO_TEST_CASE(a_plugin_is_compiled_with_the_options_of_the_program) {
  const scratch folder("plugin_options");
  run(folder, "learn --system oscillator --step 0.01 --family nystrom --trajectories 2 --output scheme.json");
  auto flags = recorded(folder / "scheme.json").at("flags").get<std::string>();
  const std::string of_fuzzers = "fuzzer-no-link,";  // libFuzzer follows no plug-in
  if (const auto at = flags.find(of_fuzzers); at != std::string::npos) flags.erase(at, of_fuzzers.size());
  std::istringstream options(flags);
  std::ifstream file(std::filesystem::path(NYSALT_PROGRAM).parent_path() / "plugin.flags");
  const std::set<std::string> of_plugins{std::istream_iterator<std::string>(file), {}};
  int compared = 0;
  for (std::string option; options >> option; ++compared) BOOST_TEST(of_plugins.contains(option), option);
  BOOST_TEST(compared > 0);
}

BOOST_AUTO_TEST_CASE(mistakes_of_a_source_are_told_in_a_sentence) {
  const unoptimised_plugins plugins;
  const scratch folder("plugin_mistakes");
  const auto must_say = [&](const std::string& source, const std::string& options, const std::string& said) {
    write(folder, "tried.hpp", source);
    const auto done =
        run(folder, "learn --system ./tried.hpp --step 0.5 --family nystrom --trajectories 4 " + options);
    BOOST_TEST(done.code == 2, said);
    BOOST_TEST(done.err.find(said) != std::string::npos, said << ", but: " << done.err);
    BOOST_TEST(std::ranges::count(done.err, '\n') == 1, done.err);
    BOOST_TEST(done.out == "");
  };
  const std::string sound = potential_that("");
  must_say(oscillator_source(sound + " double x("), "", "cannot compile ./tried.hpp: ");
  must_say(oscillator_source("double nothing() const { return 0.0; }"), "", "a separable system offers");
  must_say(oscillator_source(sound, ", parameter(\"step\", &tried::k, \"\")"), "",
           "must not have the name of an option, got 'step'");
  must_say(oscillator_source(sound,
                             ", observable(\"energy\", [](const tried&, const auto& x) { return x.q[0]; })"),
           "", "observables must have different names, got 'energy' twice");
  // What it does is chosen while it runs, as each source takes seconds to compile.
  const std::string by_k = oscillator_source(
      potential_that(
          "if (k == 2.0) throw std::runtime_error(\"I will not\"); if (k == 3.0) throw 42; "
          "if (k == 4.0) return 0.5 * k * q[0] * q[0] * std::nan(\"\"); if (k == 5.0) std::abort(); "
          "if (k == 8.0) { volatile char room[1000]; room[0] = 1; const T deeper = potential(q); "
          "room[999] = room[0]; return deeper * q[0]; } if (k == 9.0) std::exit(0); "
          "if (k == 10.0) throw std::length_error(\"\");") +
          " template <class T> void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const { "
          "f[0] = (k == 6.0 ? k : -k) * q[0]; } int n = 1;",
      ", parameter(\"n\", &tried::n, \"not used\").at_least(1), "
      "frequency([](const tried& s) { return s.k == 7.0 ? -1.0 : 1.0; })");
  must_say(by_k, "--k 2", "tried: I will not");
  must_say(by_k, "--k 3", "no std::exception");
  must_say(by_k, "--k 4", "must be finite");
  must_say(by_k, "--k 6", "check its sign");
  must_say(by_k, "--k 7", "frequency(...) must be positive and finite, got -1");
  must_say(by_k, "--k 9",
           "exit() was called while the plug-in ./tried.hpp was in use: check the plug-in first");
  must_say(by_k, "--k 10", "an exception without a message");
  must_say(by_k, "--n 4294967297", "at most 2147483647, got 4294967297");  // which an int would take for 1
  must_say(by_k, "--n 0", "--n must be at least 1");
  const auto crashed =
      run(folder, "run --system ./tried.hpp --k 5 --method verlet --step 0.1 --horizon 1 --output out");
  BOOST_TEST(crashed.code != 0);
  BOOST_TEST(crashed.err.find("SIGABRT while the plug-in ./tried.hpp was in use") != std::string::npos,
             crashed.err);
  const auto overflown = run(folder, "run --system ./tried.hpp --k 8 --method verlet --step 0.1 --horizon 1");
  BOOST_TEST(overflown.code != 0);
  // Under ThreadSanitizer, which has a handler of its own before ours, only some of the overflows get here.
  BOOST_TEST((under_thread_sanitizer ||
              overflown.err.find("SIGSEGV while the plug-in ./tried.hpp was in use") != std::string::npos),
             overflown.err);
  BOOST_TEST(!folder.files().contains("out"));
  BOOST_TEST(
      run(folder, "run --system ./tried.hpp --method verlet --step 0.1 --horizon 1 --output out").code == 0);
  // What is no plug-in, or one of another version.
  must_say("int x;\n", "", "must declare a system; write NYSALT_SYSTEM(...)");
  must_say(
      "extern \"C\" __attribute__((visibility(\"default\"))) const char* nysalt_plugin_stamp() "
      "{ return \"nysalt 0.0.1\"; }\n",
      "", "got 'nysalt 0.0.1'");
  write(folder, "text.so", "no library\n");
  const auto no_library = run(folder, "run --system ./text.so --method verlet --step 0.1 --horizon 1");
  BOOST_TEST(no_library.code == 2);
  BOOST_TEST(no_library.err.find("cannot load ./text.so as a library") != std::string::npos, no_library.err);
}
